"""Every test that asks for a mechanism or its machines runs for the whole catalogue.

Tests marked `serial` know a shape of serial arms (an elbow's sine, a hole in the middle): closed loops go through
tests of the same thing in `loops`. What the hexapod alone can be asked is in `hexapod`.
"""

from pathlib import Path

import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.driven_machines import DRIVEN, driven_machines_of
from tests.catalogue.loop_machines import LOOPS, loop_machines_of
from tests.catalogue.machines import MECHANISMS, Machine, machines_of
from tests.catalogue.turning_machines import TURNING, turning_machines_of


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Give `mechanism` its values."""
    if "mechanism" in metafunc.fixturenames and metafunc.definition.path.parent == Path(__file__).parent:
        is_serial = metafunc.definition.get_closest_marker("serial") is not None
        every = (*MECHANISMS, *DRIVEN, *LOOPS, *TURNING)
        metafunc.parametrize("mechanism", MECHANISMS if is_serial else every, ids=lambda m: m.name)


@pytest.fixture
def machines(mechanism: Mechanism) -> tuple[Machine, ...]:
    if mechanism.is_platform:
        return turning_machines_of(mechanism)
    if mechanism.drives:
        return driven_machines_of(mechanism)
    return loop_machines_of(mechanism) if mechanism.rods else machines_of(mechanism)
