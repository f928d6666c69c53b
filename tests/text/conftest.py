"""A test that asks for `pairs` runs for machines of every kind; one that asks for `serial_pairs` runs for those of
serial mechanisms alone, one that asks for `loops` for those with rods."""

import pytest

from derive.description.mechanism import Mechanism
from tests.text.pairs import LOOPS, MECHANISMS, POSITION_KINEMATICS, Pair, pairs_of


@pytest.fixture(params=POSITION_KINEMATICS, ids=lambda m: m.name)
def pairs(request: pytest.FixtureRequest) -> tuple[Pair, ...]:
    """The machines of a mechanism, each as a block and in Python."""
    return pairs_of(request.param)


@pytest.fixture(params=LOOPS, ids=lambda m: m.name)
def loops(request: pytest.FixtureRequest) -> tuple[Pair, ...]:
    """The machines of a mechanism with rods, each as a block and in Python."""
    return pairs_of(request.param)


@pytest.fixture(params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return request.param


@pytest.fixture
def serial_pairs(mechanism: Mechanism) -> tuple[Pair, ...]:
    return pairs_of(mechanism)
