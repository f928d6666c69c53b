"""Every test that asks for pairs runs for machines of every kind; one that asks for twins, for those of serial
mechanisms."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.pairs import POSITION_KINEMATICS, Pair, pairs_of
from tests.text.twins import MECHANISMS, Twins, twins_of


@pytest.fixture(params=POSITION_KINEMATICS, ids=lambda m: m.name)
def pairs(request: pytest.FixtureRequest) -> tuple[Pair, ...]:
    """The machines of a mechanism, each as a block and in Python."""
    return pairs_of(request.param)


@pytest.fixture(params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A serial mechanism."""
    return request.param


@pytest.fixture
def twins(mechanism: Mechanism) -> tuple[Twins, ...]:
    """Its machines, each as a block and in Python."""
    return twins_of(mechanism)
