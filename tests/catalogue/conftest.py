"""Every test that asks for a mechanism or its machines runs for the whole catalogue; in `loops` for every closed loop,
in `turning` for those that turn their platform.

Tests marked `serial` know a shape of serial arms (an elbow's sine, a hole in the middle): closed loops go through
tests of the same thing in `loops`. What the hexapod alone can be asked is in `hexapod`.
"""

import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.driven_machines import DRIVEN, driven_machines_of
from tests.catalogue.loop_machines import LOOPS, loop_machines_of
from tests.catalogue.machines import MECHANISMS, Machine, machines_of
from tests.catalogue.turning_machines import TURNING, turning_machines_of

ASKED = {"catalogue": (*MECHANISMS, *DRIVEN, *LOOPS, *TURNING), "loops": LOOPS, "turning": TURNING}
"""The mechanisms that the tests of a folder are asked about."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Give `mechanism` its values."""
    every = ASKED.get(metafunc.definition.path.parent.name)
    if "mechanism" in metafunc.fixturenames and every is not None:
        is_serial = metafunc.definition.get_closest_marker("serial") is not None
        metafunc.parametrize("mechanism", MECHANISMS if is_serial else every, ids=lambda m: m.name)


@pytest.fixture
def machines(mechanism: Mechanism) -> tuple[Machine, ...]:
    if mechanism.is_platform:
        return turning_machines_of(mechanism)
    if mechanism.drives:
        return driven_machines_of(mechanism)
    return loop_machines_of(mechanism) if mechanism.rods else machines_of(mechanism)
