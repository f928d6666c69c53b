"""Every test that asks for a mechanism or its machines runs for every closed loop."""

import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.loop_machines import LOOPS, LoopMachine, loop_machines_of


@pytest.fixture(params=LOOPS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return request.param


@pytest.fixture
def machines(mechanism: Mechanism) -> tuple[LoopMachine, ...]:
    """As it is drawn and with unequal dimensions, in both assembly modes."""
    return loop_machines_of(mechanism)
