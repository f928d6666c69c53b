"""Softkin_CheckLine, executed on blocks of every kind, against the same walk made in Python with NumPy."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.corpus.dimensions import DIMENSIONS
from tests.machines.other_poses import platform
from tests.mechanisms import named
from tests.orthonormal import about
from tests.text import values
from tests.text.checked_lines import LINES, POINTS, Axes, Robot, between, checked, checker, compare, ends, robot, walk
from tests.text.controller import BAD_INPUT, NOT_INITIALIZED, OK, UNREACHABLE, Controller
from tests.text.units import compiled


@pytest.mark.parametrize("name", LINES)
def test_a_line(name: str) -> None:
    """Steps, speeds and margins at every point of a line that the machine can follow."""
    one, (first, last, axes) = robot(name), ends(name)
    made = compare(one, first, last, axes, one.configuration(axes), float(np.linalg.norm(last[0] - first[0])))
    assert not made.xRefused and (made.eStatus, made.sReason, made.iChecked) == (OK, "", POINTS)
    assert not made.xPerDegree


TURNS = {
    "a little": about(2, 3.0) @ about(0, 2.0),
    "much": about(0, 80.0) @ about(1, 70.0),
    "beyond a quarter": about(0, 110.0) @ about(2, -30.0),
    "nearly half, about x": about(1, 3.0) @ about(0, 179.9999),
    "nearly half, about y": about(2, 30.0) @ about(1, -179.9),
    "nearly half, about z": about(0, 10.0) @ about(2, 179.0),
}


@pytest.mark.parametrize("turn", TURNS)
def test_a_turn_alone(turn: str) -> None:
    """A wrist turns by any angle about any axis, and speeds are those per degree."""
    one, axes = robot("Kin_Wrist3"), (20.0, 50.0, 30.0)
    place, rotation = one.frame(axes)
    angle = np.degrees(Rotation.from_matrix(TURNS[turn]).magnitude())
    made = compare(one, (place, rotation), (place, rotation @ TURNS[turn]), axes, (0, 0, 0, 0), float(angle))
    assert made.xPerDegree and made.iChecked == POINTS


def test_nothing_moves() -> None:
    """All points are one pose: the axes stand still, and no axis is the fastest."""
    one, axes = robot("Kin_Scara3_Z"), LINES["Kin_Scara3_Z"][0]
    made = checked(one, one.frame(axes), one.frame(axes), axes, one.configuration(axes))
    assert (made.iChecked, made.xPerDegree, made.dLargestSpeed, made.iFastestAxis) == (POINTS, False, 0.0, -1)
    assert made.dLargestStep < 1e-9 and made.dLeastMargin == pytest.approx(abs(np.sin(np.radians(axes[1]))))


def test_half_a_turn() -> None:
    """Exactly: about its axis in one of both directions, evenly, and with no jump at the end."""
    one, axes = robot("Kin_Scara3_Z", arm_length_3=1e-6), (20.0, 60.0, -80.0, 5.0)
    place, rotation = one.frame(axes)[0], np.eye(3)
    made = checked(one, (place, rotation), (place, np.diag((-1.0, -1.0, 1.0))), axes, one.configuration(axes))
    assert made.xPerDegree and made.aSpeeds[2] == pytest.approx(1.0)
    assert made.dLargestStep == pytest.approx(180.0 / (POINTS - 1)) and made.iSteppingAxis == 2


def test_a_platform_is_asked_with_its_frame() -> None:
    """Where forward kinematics from home finds another pose with these axes, the margin is still that of this one."""
    one = platform("Kin_Hexapod")
    controller = Controller(compiled(named("Kin_Hexapod")), named("Kin_Hexapod"))
    assert controller.initialise(dict(one.robot.parameters) | {"check_forward": False}) == OK
    for lost in one.poses[0][:3]:
        frame = (np.array(lost.frame.position), np.array(lost.frame.rotation))
        made = checked(Robot(controller, one.open_robot), frame, frame, lost.axes, ())
        axes, at = values.axes(controller.library, lost.axes), values.frame(controller.library, *frame)
        found: list[list[float]] = [[0.0] * 8, [0.0] * 8]
        controller.block.call("MarginsFrom", aMargins=found[0], a=axes, f=at)
        controller.block.call("Margins", aMargins=found[1], a=axes)
        assert made.dLeastMargin == pytest.approx(abs(found[0][made.iLeastMargin]))
        assert made.dLeastMargin != pytest.approx(abs(found[1][made.iLeastMargin]), rel=1e-3)


REFUSED: dict[str, tuple[dict[str, float], Axes, tuple[float, float, float]]] = {
    "Kin_Scara3_Z": ({}, (20.0, 60.0, -10.0, 5.0), (900.0, 0.0, 0.0)),
    "Kin_Delta_P3C_Type3": ({}, (20.0, 10.0, 15.0), (600.0, 20.0, -300.0)),
    "Kin_ArticulatedRobot_6DOF": ({"upper_a1": 15.0}, (10.0, 80.0, -30.0, 20.0, 50.0, 10.0), (-100.0, 300.0, 500.0)),
    "Kin_5Axes": ({"lower_x": -50.0, "upper_x": 20.0}, (10.0, 20.0, 30.0, 20.0, 40.0), (300.0, 20.0, 50.0)),
    "Kin_Hexapod": ({"max_angle_base_joint": 20.0}, (), (400.0, 0.0, 620.0)),
}
"""Further parameters, the axis values at the start, and where a line ends that no machine can follow to its end."""


@pytest.mark.parametrize("name", REFUSED)
def test_a_line_that_is_refused(name: str) -> None:
    """Beyond reach, at a limit, beyond the cone of a joint: the first refused point, its status, and Python's words."""
    further, axes, place = REFUSED[name]
    one = robot(name, **further)
    first = (np.array((0.0, 0.0, 600.0)), np.eye(3)) if name == "Kin_Hexapod" else one.frame(axes)
    axes = axes or one.twin.inverse(first)
    last, configuration = (np.array(place), first[1]), one.configuration(axes)
    made = checked(one, first, last, axes, configuration)
    accepted = list(walk(one, first, last, axes, configuration))
    assert 0 < len(accepted) < POINTS and made.iChecked == len(accepted)
    assert made.xRefused and made.dRefusedAt == pytest.approx(len(accepted) / (POINTS - 1))
    told = one.twin.diagnose(between(first, last, made.dRefusedAt), configuration, accepted[-1][1])
    assert (made.eStatus, made.sReason) == (told.status.softmotion, told.reason) and told.reason
    assert made.dMissing == pytest.approx(told.missing, rel=1e-6) and made.iTurn == told.turn
    steps = np.abs(np.diff([axes, *(row for _, row in accepted)], axis=0))
    assert made.dLargestStep == pytest.approx(steps.max(), rel=1e-6)


def test_a_line_into_a_singular_pose() -> None:
    """It ends where the arm is stretched: the margin is 0 there, and the axes would be as fast as one likes."""
    one, axes = robot("Kin_Scara2_Z"), (0.0, 90.0, 0.0)
    reach = DIMENSIONS["Kin_Scara2_Z"]["arm_length_1"] + DIMENSIONS["Kin_Scara2_Z"]["arm_length_2"]
    made = checked(one, one.frame(axes), (np.array((reach, 0.0, 0.0)), np.eye(3)), axes, (1, 0, 0))
    assert not made.xRefused and made.iChecked == POINTS
    assert made.dLeastMargin < 1e-7 and made.dLeastMarginAt == made.dFastestAt == 1.0
    assert made.dLargestSpeed > 50.0


def test_a_flip_is_a_step() -> None:
    """Past the first axis of a SCARA with equal arms, A1 turns by half a turn from one point to the next; and axes that
    are not in the configuration are a step at the first point.
    """
    one, axes = robot("Kin_Scara2_Z", arm_length_1=300.0, arm_length_2=300.0), (10.0, 120.0, 0.0)
    first = (np.array((300.0, 0.01, 0.0)), np.eye(3))
    axes = one.twin.inverse(first, (1, 0, 0), axes)
    made = checked(one, first, (np.array((-300.0, 0.01, 0.0)), np.eye(3)), axes, (1, 0, 0))
    assert made.dLargestStep > 80.0 and made.iSteppingAxis == 0 and 0.4 < made.dStepAt < 0.6
    made = checked(one, first, (np.array((310.0, 0.01, 0.0)), np.eye(3)), axes, (2, 0, 0))
    assert made.dLargestStep > 100.0 and made.dStepAt == 0.0


def test_a_block_that_does_not_read_the_rotation() -> None:
    """It needs none in the frames, and follows the same line."""
    one, (first, last, axes) = robot("Kin_Scara2_Z"), ends("Kin_Scara2_Z")
    found = [checked(one, (first[0], m), (last[0], m), axes, (1, 0, 0)) for m in (np.eye(3), np.zeros((3, 3)))]
    for name in ("iChecked", "dLargestSpeed", "dLargestStep", "dLeastMargin", "iLeastMargin"):
        assert getattr(found[0], name) == getattr(found[1], name)
    assert found[1].iChecked == POINTS and found[1].iLeastMargin >= 0


def test_frames_without_a_rotation() -> None:
    """A block that reads the rotation refuses the first point, or the last one, with its reason."""
    one, (first, last, axes) = robot("Kin_Scara3_Z"), ends("Kin_Scara3_Z")
    for wrong in (np.zeros((3, 3)), np.full((3, 3), np.nan), np.eye(3) * 1.1, np.diag((1.0, 1.0, -1.0))):
        for frames, at in (((first, (last[0], wrong)), 1.0), (((first[0], wrong), last), 0.0)):
            made = checked(one, *frames, axes, one.configuration(axes))
            assert made.xRefused and (made.eStatus, made.dRefusedAt) == (BAD_INPUT, at)
            assert made.sReason.startswith(("columns not", "not given"))


def test_garbage() -> None:
    """Every input ends the check with a status and a reason, in the first call, and no point is asked."""
    one, (first, last, axes) = robot("Kin_Scara3_Z"), ends("Kin_Scara3_Z")
    cases: list[tuple[str, Any, str, str]] = [
        ("itfKin", None, NOT_INITIALIZED, "itfKin, itfSoftkin"),
        ("itfSoftkin", None, NOT_INITIALIZED, "itfKin, itfSoftkin"),
        *(("iPoints", count, BAD_INPUT, "iPoints is not allowed") for count in (0, 1, -5)),
        *(("iPerCall", count, BAD_INPUT, "iPerCall is not allowed") for count in (0, -1)),
    ]
    for key, value, status, why in cases:
        made = checker(one, first, last, axes, one.configuration(axes))
        setattr(made, key, value)
        made()
        assert made.xDone and made.xRefused and not made.xBusy and made.iChecked == 0
        assert made.eStatus == status and made.sReason.startswith(why)
    for wrong in (float("nan"), float("inf"), -float("inf"), 1e300):
        for frames in ((((wrong, 0.0, 0.0), first[1]), last), (first, ((0.0, 0.0, wrong), last[1]))):
            made = checked(one, *frames, axes, one.configuration(axes))
            assert (made.eStatus, made.iChecked) == (BAD_INPUT, 0) and made.sReason.startswith("fStart, fEnd")
        made = checked(one, first, last, (wrong,) * 4, one.configuration(axes))
        assert (made.xRefused and made.eStatus == BAD_INPUT) or made.iChecked == POINTS
    made = checked(one, first, last, axes, (9, 0, 0, 0))
    assert (made.eStatus, made.dRefusedAt) == (BAD_INPUT, 0.0) and made.sReason


def test_a_block_that_is_not_initialised() -> None:
    """Its own status, and its own words."""
    one, (first, last, axes) = robot("Kin_Scara3_Z"), ends("Kin_Scara3_Z")
    fresh = Robot(Controller(one.controller.library, named("Kin_Scara3_Z")), one.twin)
    made = checked(fresh, first, last, axes, one.configuration(axes))
    assert (made.eStatus, made.sReason, made.iChecked) == (NOT_INITIALIZED, "not initialized", 0)


def test_it_writes_nothing_into_the_block() -> None:
    """The group may move meanwhile."""
    one, (first, last, axes) = robot("Kin_Scara3_Z"), ends("Kin_Scara3_Z")
    before = {name: values.plain(value) for name, value in one.controller.state().items()}
    checked(one, first, last, axes, one.configuration(axes))
    assert {name: values.plain(value) for name, value in one.controller.state().items()} == before


def test_it_stops_and_begins_again() -> None:
    """Without xExecute a check ends; a rising edge begins another one, with what is then given, from nothing. What is
    given while it is busy changes nothing.
    """
    one, (first, last, axes) = robot("Kin_Scara3_Z"), ends("Kin_Scara3_Z")
    whole = checked(one, first, last, axes, one.configuration(axes))
    made = checker(one, first, last, axes, one.configuration(axes))
    made()
    made.fEnd.vT.dX, made.iPoints, made.itfKin = 5000.0, 3, None
    while not made.xDone:
        made()
    for name in ("iChecked", "dLargestSpeed", "dLargestStep", "dLeastMargin", "xRefused"):
        assert getattr(made, name) == getattr(whole, name)
    made.itfKin = one.controller.block
    made()
    assert made.xDone and made.iChecked == POINTS, "nothing begins without an edge"
    made.xExecute = False
    made()
    assert not made.xDone and made.iChecked == POINTS, "the answers stay"
    made.xExecute = True
    made()
    assert made.xRefused and made.eStatus == UNREACHABLE and made.dRefusedAt == 0.5 and made.iChecked == 1
    made.fEnd.vT.dX, made.iPoints = last[0][0], POINTS
    for given in (False, True):
        made.xExecute = given
        made()
    assert made.xBusy and not made.xRefused and made.sReason == "" and made.iChecked == 4
    made.xExecute = False
    made()
    assert not made.xBusy and not made.xDone and made.iChecked == 4
    made.iPoints, made.xExecute = 0, True
    made()
    assert made.xDone and (made.iChecked, made.iFastestAxis, made.iSteppingAxis, made.iLeastMargin) == (0, -1, -1, -1)
    assert not any(made.aSpeeds) and (made.dLargestSpeed, made.dLargestStep, made.dLeastMargin) == (0.0, 0.0, 1e9)


OF_STATEMENTS = ("Kin_Scara2_Z", "Kin_Scara3_Z", "Kin_Wrist3")


def every_statement() -> None:
    """What reaches every statement of the block, on these machines."""
    for turn in TURNS:
        test_a_turn_alone(turn)
    test_a_line("Kin_Scara3_Z")
    test_nothing_moves()
    test_a_block_that_does_not_read_the_rotation()
    test_garbage()
    test_frames_without_a_rotation()
    test_it_stops_and_begins_again()
