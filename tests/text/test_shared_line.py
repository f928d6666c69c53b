"""Softkin_CheckLine, executed on blocks of every kind, against the same walk made in Python with NumPy."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin
from scipy.spatial.transform import Rotation, Slerp
from softkin import KinematicsError

from tests.corpus.dimensions import DIMENSIONS
from tests.mechanisms import named
from tests.orthonormal import about
from tests.text import values
from tests.text.controller import BAD_INPUT, NOT_INITIALIZED, OK, UNREACHABLE, Controller
from tests.text.units import compiled

Array = Any
Axes = tuple[float, ...]
POINTS = 21
SPEED = 1e-3
"""What a second pose beside a point knows of a speed, relatively."""


@dataclass(frozen=True)
class Robot:
    """A machine as a block that is initialised, and in Python."""

    controller: Controller
    twin: softkin.Mechanism

    def frame(self, axes: Axes) -> tuple[Array, Array]:
        """Position and rotation of the flange."""
        frame, _ = self.twin.forward(axes)
        return np.array(frame.position), np.array(frame.rotation)

    def configuration(self, axes: Axes) -> tuple[int, ...]:
        """The branches at these axes; the turns are automatic."""
        _, found = self.twin.forward(axes)
        kinds = [byte.kind for byte in self.twin.CONFIGURATION]
        return tuple(byte if kind == "branch" else 0 for byte, kind in zip(found, kinds, strict=True))


@cache
def robot(name: str, **more: float) -> Robot:
    """A machine with the dimensions of the corpus, and further parameters."""
    given = DIMENSIONS[name] | more
    controller = Controller(compiled(named(name)), named(name))
    assert controller.initialise(given) == OK
    return Robot(controller, softkin.catalogue()[name](**given))


LINES: dict[str, tuple[Axes, Axes]] = {
    "Kin_Scara2_Z": ((20.0, 60.0, 10.0), (-30.0, 85.0, 40.0)),
    "Kin_Scara3_Z": ((20.0, 60.0, -10.0, 5.0), (-10.0, 85.0, 60.0, 30.0)),
    "Kin_Delta_P3C_Type3": ((20.0, 10.0, 15.0), (5.0, 30.0, 22.0)),
    "Kin_ArticulatedRobot_6DOF": ((10.0, 80.0, -30.0, 20.0, 50.0, 10.0), (-20.0, 70.0, -10.0, 40.0, 30.0, 60.0)),
    "Kin_5Axes": ((10.0, 20.0, 30.0, 20.0, 40.0), (60.0, -20.0, 10.0, 50.0, 25.0)),
    "Softkin_HeadTable_AC": ((10.0, 20.0, 30.0, 20.0, 40.0), (60.0, -20.0, 10.0, 35.0, 70.0)),
    "Kin_Hexapod": ((), ()),
}
"""Axis values at both ends of a line; those of the hexapod follow from its frames."""


def ends(name: str) -> tuple[tuple[Array, Array], tuple[Array, Array], Axes]:
    """Both frames of a line, and the axis values at the first one."""
    if name == "Kin_Hexapod":
        frames = ((20.0, -30.0, 590.0), about(0, 8.0)), ((-40.0, 25.0, 630.0), about(2, 12.0) @ about(1, -6.0))
        first, last = ((np.array(place), turn) for place, turn in frames)
        return first, last, robot(name).twin.inverse(first)
    one = robot(name)
    return one.frame(LINES[name][0]), one.frame(LINES[name][1]), LINES[name][0]


def between(first: tuple[Array, Array], last: tuple[Array, Array], fraction: float) -> tuple[Array, Array]:
    """The frame at a fraction of a line; without rotations the first matrix, and at the end the last one."""
    position = (1.0 - fraction) * first[0] + fraction * last[0]
    if not first[1].any() or not last[1].any():
        return position, first[1] if fraction < 1.0 else last[1]
    turned = Slerp([0.0, 1.0], Rotation.from_matrix([first[1], last[1]]))(fraction)
    return position, turned.as_matrix()


def checker(one: Robot, first: Any, last: Any, axes: Axes, configuration: tuple[int, ...]) -> Any:
    """The block before it begins, with everything that it is given."""
    library = one.controller.library
    made = library.new("Softkin_CheckLine")
    made.itfKin = made.itfSoftkin = one.controller.block
    made.fStart, made.fEnd = (values.frame(library, place, turn) for place, turn in (first, last))
    made.aStart, made.cd = values.axes(library, axes), values.configuration(library, configuration)
    made.iPoints, made.iPerCall, made.xExecute = POINTS, 4, True
    return made


def checked(one: Robot, first: Any, last: Any, axes: Axes, configuration: tuple[int, ...]) -> Any:
    """The block when it is done."""
    made = checker(one, first, last, axes, configuration)
    for call in range(1, POINTS):
        made()
        assert made.xBusy is not made.xDone
        assert made.iChecked == min(4 * call, POINTS) or made.xRefused
        if made.xDone:
            return made
    raise AssertionError("it is not done")


def walk(one: Robot, first: Any, last: Any, axes: Axes, configuration: tuple[int, ...]) -> Iterator[tuple[float, Axes]]:
    """The axis values at every point, up to the first one that is refused."""
    for fraction in np.linspace(0.0, 1.0, POINTS):
        try:
            axes = one.twin.inverse(between(first, last, fraction), configuration, axes)
        except KinematicsError:
            return
        yield float(fraction), axes


def speeds(one: Robot, first: Any, last: Any, fraction: float, axes: Axes, configuration: tuple[int, ...]) -> Array:
    """How fast the axes move at a point, by differences to both sides, for the whole line in a unit of time."""
    low, high = max(0.0, fraction - 1e-4), min(1.0, fraction + 1e-4)
    found = [np.array(one.twin.inverse(between(first, last, s), configuration, axes)) for s in (low, high)]
    return np.abs(found[1] - found[0]) / (high - low)


def compare(one: Robot, first: Any, last: Any, axes: Axes, configuration: tuple[int, ...], way: float) -> Any:
    """The answers of the block are those of the walk in Python, at every point that is not refused."""
    made = checked(one, first, last, axes, configuration)
    points = list(walk(one, first, last, axes, configuration))
    assert made.iChecked == len(points)
    at = [fraction for fraction, _ in points]
    rows = np.array([row for _, row in points])
    count = rows.shape[1]
    steps = np.abs(np.diff(np.vstack([axes, rows]), axis=0))
    assert made.dLargestStep == pytest.approx(steps.max(), rel=1e-7)
    assert steps[at.index(pytest.approx(made.dStepAt)), made.iSteppingAxis] == pytest.approx(steps.max(), rel=1e-7)
    margins = [list(map(abs, one.twin.singularity(row).margins.values())) for row in rows.tolist()]
    if margins[0]:
        least = np.array(margins)
        assert made.dLeastMargin == pytest.approx(least.min(), rel=1e-7)
        found = least[at.index(pytest.approx(made.dLeastMarginAt)), made.iLeastMargin]
        assert found == pytest.approx(least.min(), rel=1e-7)
    else:
        assert (made.dLeastMargin, made.iLeastMargin) == (1e9, -1)
    rates = np.array([speeds(one, first, last, s, row, configuration) / way for s, row in points])
    assert np.array(made.aSpeeds[:count]) == pytest.approx(rates.max(axis=0), rel=SPEED, abs=1e-6)
    assert made.dLargestSpeed == max(made.aSpeeds) == made.aSpeeds[made.iFastestAxis]
    fastest = rates[at.index(pytest.approx(made.dFastestAt)), made.iFastestAxis]
    assert fastest == pytest.approx(made.dLargestSpeed, rel=SPEED)
    return made


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
