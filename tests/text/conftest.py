"""A test that asks for `pairs` runs for machines of every kind; one that asks for `serial_pairs` runs for the machines
of serial mechanisms alone."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.pairs import POSITION_KINEMATICS, Pair, pairs_of
from tests.text.serial_pairs import MECHANISMS, SerialPair, serial_pairs_of


@pytest.fixture(params=POSITION_KINEMATICS, ids=lambda m: m.name)
def pairs(request: pytest.FixtureRequest) -> tuple[Pair, ...]:
    """The machines of a mechanism, each as a block and in Python."""
    return pairs_of(request.param)


@pytest.fixture(params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A serial mechanism."""
    return request.param


@pytest.fixture
def serial_pairs(mechanism: Mechanism) -> tuple[SerialPair, ...]:
    """Its machines, each as a block and in Python."""
    return serial_pairs_of(mechanism)
