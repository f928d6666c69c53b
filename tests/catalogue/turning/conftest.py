"""Every test that asks for a mechanism or its machines runs for every loop that turns its platform."""

import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.turning_machines import TURNING, TurningMachine, turning_machines_of


@pytest.fixture(params=TURNING, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return request.param


@pytest.fixture
def machines(mechanism: Mechanism) -> tuple[TurningMachine, ...]:
    """As it is drawn, and with unequal dimensions, at home in several branches."""
    return turning_machines_of(mechanism)
