"""How far a commanded rotation is changed, where a machine cannot take it."""

from __future__ import annotations

import numpy as np
import pytest
import softkin
from scipy.spatial.transform import Rotation
from softkin import Frame, Status

from tests.catalogue.calls.mountings import BASE, EVERY, machines


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_the_projection_is_the_angle_to_the_rotation_that_is_reached(name: str) -> None:
    """By SciPy, from the axes of the inverse and forward kinematics; in radians, too."""
    for bare, axes, _ in machines(name):
        robot = bare.with_base(BASE)
        frame, configuration = robot.forward(axes)
        assert robot.diagnose(frame, configuration, axes).projection < 1e-5
        turned = Frame(frame.position, (frame @ Frame.from_rpy(3.0, -4.0, 12.0)).rotation)
        found = robot.diagnose(turned, configuration, axes)
        if found.status is not Status.OK:
            assert found.projection == 0.0
            continue
        reached = robot.forward(robot.inverse(turned, configuration, axes))[0]
        pair = (Rotation.from_matrix(np.array(one.rotation)) for one in (turned, reached))
        wanted = np.degrees((next(pair).inv() * next(pair)).magnitude()) if robot.READS_ROTATION else 0.0
        assert found.projection == pytest.approx(wanted, abs=1e-6)
        radians = tuple(np.radians(v) if axis.unit == "deg" else v for v, axis in zip(axes, robot.AXES, strict=True))
        told = robot.in_radians().diagnose(turned, configuration, radians).projection
        assert told == pytest.approx(np.radians(wanted), abs=1e-8)


def test_a_five_axis_machine_says_how_far_the_tool_is_not_turned() -> None:
    """The turn about its tool is passive: by 25 degrees, the tool has its direction all the same."""
    machine = softkin.TableTableAC(pivot_y=40.0, pivot_z=-60.0, tool_length=120.0)
    frame, _ = machine.forward((10.0, 20.0, 30.0, 40.0, 50.0))
    assert machine.diagnose(frame @ Frame.from_euler(0.0, 0.0, 25.0)).projection == pytest.approx(25.0)
