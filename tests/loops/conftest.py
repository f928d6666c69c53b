"""Every test that asks for a machine runs for every closed loop."""

import pytest

from tests.loops.machines import LOOPS, Machine, machines_of


@pytest.fixture(params=[(m, k) for m in LOOPS for k in range(3)], ids=lambda p: f"{p[0].name}-{p[1]}")
def machine(request: pytest.FixtureRequest) -> Machine:
    """A machine of a closed loop."""
    mechanism, number = request.param
    return machines_of(mechanism)[number]
