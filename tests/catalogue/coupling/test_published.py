"""What CODESYS documents of its orientation kinematics and of the machines made with them (GEOMETRY 7, CONTRACT 5)."""

import math

import numpy as np
import pytest
import softkin

from tests.text.samples import tilted

ROOT = math.sqrt(0.5)


def frame_of(robot: softkin.Mechanism, *axes: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of the flange at axis values."""
    frame, _ = robot.forward(axes)
    return np.array(frame.position), np.array(frame.rotation)


@pytest.mark.parametrize(("side", "height"), [(1, 90.0), (-1, -90.0)])
def test_the_inclination_moves_the_tool_to_x(side: int, height: float) -> None:
    """Library 4.16 and later: the tool points along +Z; 4.12: along -Z. Both say that a positive
    angle moves it to +X.
    """
    for robot, zeros in (
        (softkin.Kin5Axes(tool_length=90.0, tool_side=side), (0.0, 0.0, 0.0)),
        (softkin.Coupled(softkin.Gantry3(), softkin.Wrist2(tool_length=90.0, tool_side=side)), (0.0, 0.0, 0.0)),
        (softkin.Wrist2(tool_length=90.0, tool_side=side), ()),
    ):
        position, rotation = frame_of(robot, *zeros, 0.0, 0.0)
        assert position == pytest.approx((0.0, 0.0, height), abs=1e-12)
        assert rotation == pytest.approx(np.eye(3), abs=1e-12)
        assert frame_of(robot, *zeros, 0.0, 90.0)[0] == pytest.approx((90.0, 0.0, 0.0), abs=1e-12)
        assert frame_of(robot, *zeros, 90.0, 90.0)[0] == pytest.approx((0.0, 90.0, 0.0), abs=1e-12)
        assert frame_of(robot, *zeros, 0.0, 45.0)[0] == pytest.approx((90.0 * ROOT, 0.0, height * ROOT), abs=1e-12)


def test_the_roll_axis_offset_is_seen_behind_the_yaw() -> None:
    robot = softkin.Wrist2(tool_length=90.0, roll_axis_offset_x=12.0, roll_axis_offset_y=-7.0, roll_axis_offset_z=-40.0)
    assert frame_of(robot, 90.0, 0.0)[0] == pytest.approx((7.0, 12.0, 50.0), abs=1e-12)


def test_a_wrist_with_three_axes() -> None:
    """Its middle axis turns about the negative Y: hand down is a positive angle, and the angles
    follow in closed form.
    """
    robot = softkin.Wrist3(tool_offset_z=75.0)
    assert frame_of(robot, 0.0, 90.0, 0.0)[0] == pytest.approx((-75.0, 0.0, 0.0), abs=1e-12)
    assert frame_of(robot, 0.0, 0.0, 0.0)[0] == pytest.approx((0.0, 0.0, 75.0), abs=1e-12)
    rng = np.random.default_rng(53)
    for _ in range(20):
        r = np.array(tilted(rng))
        for byte, s in ((1, 1.0), (2, -1.0)):
            expected = (
                math.atan2(-s * r[1, 2], -s * r[0, 2]),
                math.atan2(s * math.hypot(r[0, 2], r[1, 2]), r[2, 2]),
                math.atan2(-s * r[2, 1], s * r[2, 0]),
            )
            found = robot.inverse(((0.0, 0.0, 0.0), r.tolist()), (byte, 0, 0, 0))
            assert found == pytest.approx([math.degrees(v) for v in expected], abs=1e-9)


def test_a_c_axis_reaches_all_but_the_half_turns() -> None:
    """ "All orientations except those rotated about X or Y by 180 degrees", by phi = atan2(r21 - r12, r11 + r22)."""
    robot, rng = softkin.CAxis(), np.random.default_rng(59)
    for _ in range(20):
        r = np.array(tilted(rng))
        expected = math.degrees(math.atan2(r[1, 0] - r[0, 1], r[0, 0] + r[1, 1]))
        assert robot.inverse(((0.0, 0.0, 0.0), r.tolist())) == pytest.approx((expected,), abs=1e-9)
    for half_turn in (np.diag((1.0, -1.0, -1.0)), np.diag((-1.0, 1.0, -1.0))):
        with pytest.raises(softkin.KinematicsError):
            robot.inverse(((0.0, 0.0, 0.0), half_turn.tolist()))


def test_a_tool_on_a_c_axis_is_parallel_to_the_flange_at_zero() -> None:
    """The shifts of a tool turn with the C axis, and stay fixed on a flange without an axis."""
    robot = softkin.CAxisTool(tool_x=15.0, tool_y=-8.0, tool_z=-60.0)
    assert frame_of(robot, 0.0)[0] == pytest.approx((15.0, -8.0, -60.0), abs=1e-12)
    assert frame_of(robot, 90.0)[0] == pytest.approx((8.0, 15.0, -60.0), abs=1e-12)
    still = softkin.Tool(tool_x=15.0, tool_y=-8.0, tool_z=-60.0)
    assert frame_of(still)[0] == pytest.approx((15.0, -8.0, -60.0)) and frame_of(still)[1] == pytest.approx(np.eye(3))
