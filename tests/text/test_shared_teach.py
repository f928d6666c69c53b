"""Softkin_Teach, executed on blocks of every kind: machines whose offsets are others than those of the block, measured
in Python.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import softkin
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from tests.corpus.dimensions import DIMENSIONS
from tests.mechanisms import named
from tests.orthonormal import about
from tests.text import values
from tests.text.checked_lines import Axes, Robot, robot
from tests.text.controller import BAD_INPUT, IMPOSSIBLE, NOT_INITIALIZED, OK, Controller

Row = tuple[Axes, Sequence[float], Any]
"""Axis values, and position and rotation that were measured there."""

MARKS: dict[str, tuple[Axes, ...]] = {
    "Kin_Scara3_Z": ((20.0, 60.0, -10.0, 5.0), (-40.0, 95.0, 70.0, 30.0), (70.0, -50.0, 20.0, -10.0)),
    "Kin_Delta_P3C_Type3": ((20.0, 10.0, 15.0), (5.0, 30.0, 22.0), (12.0, 14.0, 40.0)),
    "Kin_ArticulatedRobot_6DOF": (
        (10.0, 80.0, -30.0, 20.0, 50.0, 10.0), (-70.0, 60.0, -10.0, 40.0, 30.0, 60.0),
        (40.0, 100.0, -50.0, -60.0, 70.0, -80.0),
    ),
    "Kin_5Axes": ((10.0, 20.0, 30.0, 20.0, 40.0), (60.0, -20.0, 10.0, 50.0, 25.0)),
    "Kin_Hexapod": ((650.0,) * 6, (640.0, 655.0, 662.0, 648.0, 640.0, 651.0)),
}  # fmt: skip


def mended(name: str, corrections: Sequence[float]) -> softkin.Mechanism:
    """The machine with offsets that are larger by so much."""
    given = DIMENSIONS[name]
    keys = [joint.offset.name for joint in named(name).joints]
    offsets = {key: given.get(key, 0.0) + value for key, value in zip(keys, corrections, strict=True)}
    return softkin.catalogue()[name](**given | offsets)


def measured(machine: softkin.Mechanism, marks: Sequence[Axes]) -> list[Row]:
    """Rows of a machine, without an error."""
    return [(axes, frame.position, np.array(frame.rotation)) for axes in marks for frame in (machine.forward(axes)[0],)]


def teacher(one: Robot, rows: Sequence[Row], position_only: bool = False) -> Any:
    """The block, with rows."""
    library = one.controller.library
    made = library.new("Softkin_Teach")
    made.itfKin, made.xPositionOnly = one.controller.block, position_only
    for axes, place, turn in rows:
        made.a, made.f = values.axes(library, axes), values.frame(library, place, turn)
        for made.xAdd in (True, False):
            made()
    return made


def taught(made: Any) -> Any:
    """The block when its search has ended: a row of a pass in a call."""
    made.xSolve = True
    for calls in range(1, 1000):
        made()
        assert made.xBusy is not made.xDone
        if made.xDone:
            assert made.xRefused or calls == made.iRows * made.iPasses
            return made
    raise AssertionError("it does not end")


@pytest.mark.parametrize("name", MARKS)
def test_offsets_are_found(name: str) -> None:
    """The rows of a machine with other offsets: these offsets, and no error is left."""
    count = len(MARKS[name][0])
    true = [1.5, -2.0, 0.7, 1.1, -0.4, 2.5][:count]
    made = taught(teacher(robot(name), measured(mended(name, true), MARKS[name])))
    assert (made.eStatus, made.sReason, made.xRefused) == (OK, "", False)
    assert made.aDetermined == [k < count for k in range(6)]
    assert made.aCorrections[:count] == pytest.approx(true, abs=1e-6) and not any(made.aCorrections[count:])
    assert made.dPositionAfter < 1e-6 < 0.1 < made.dPositionBefore and made.dRotationAfter < 1e-6


@pytest.mark.parametrize("name", ["Kin_Scara3_Z", "Kin_ArticulatedRobot_6DOF", "Kin_5Axes", "Kin_Delta_P3C_Type3"])
def test_offsets_far_away(name: str) -> None:
    """Offsets that are off by up to 45 degrees or lengths are found in a few passes."""
    for true in np.random.default_rng(3).uniform(-45.0, 45.0, (5, len(MARKS[name][0]))):
        made = taught(teacher(robot(name), measured(mended(name, true), MARKS[name])))
        assert made.aCorrections[: len(true)] == pytest.approx(true.tolist(), abs=1e-5) and made.iPasses <= 10


@pytest.mark.parametrize("name", MARKS)
def test_the_best_offsets_of_rows_with_errors(name: str) -> None:
    """Least squares in SciPy, on the same rows with errors, find the same offsets and leave the same errors."""
    rng, true = np.random.default_rng(5), [0.3, -0.5, 0.2, 0.4, -0.1, 0.6][: len(MARKS[name][0])]
    exact = measured(mended(name, true), MARKS[name])
    rows = [(a, np.add(p, rng.normal(0.0, 0.2, 3)), about(0, rng.normal(0.0, 0.1)) @ r) for a, p, r in exact]

    def missed(corrections: Any) -> Any:
        """In the order and weight of the block: a degree counts as a unit of length."""
        found = measured(mended(name, corrections), MARKS[name])
        turns = [np.degrees(Rotation.from_matrix(c[2].T @ r[2]).as_rotvec()) for c, r in zip(found, rows, strict=True)]
        return np.concatenate([np.subtract(r[1], c[1]) for c, r in zip(found, rows, strict=True)] + turns)

    best = least_squares(missed, np.zeros(len(true)), jac="3-point", xtol=1e-14, ftol=1e-14, gtol=1e-14)
    made = taught(teacher(robot(name), rows))
    assert made.aCorrections[: len(true)] == pytest.approx(best.x.tolist(), abs=1e-5)
    half = 3 * len(rows)
    for corrections, position, rotation in (
        (np.zeros(len(true)), made.dPositionBefore, made.dRotationBefore),
        (best.x, made.dPositionAfter, made.dRotationAfter),
    ):
        left = missed(corrections)
        assert position == pytest.approx(np.sqrt(left[:half] @ left[:half] / len(rows)), rel=1e-6)
        assert rotation == pytest.approx(np.sqrt(left[half:] @ left[half:] / len(rows)), rel=1e-6)


def test_as_the_calibration_in_python() -> None:
    """`softkin` finds the same offsets of the same rows with errors, where both weigh them alike: of positions
    alone. Its deviation is that of the joint, which is smaller where the offset of the axis is larger.
    """
    name, rng = "Kin_Scara3_Z", np.random.default_rng(8)
    marks = [
        tuple(row) for row in (rng.uniform(-1.0, 1.0, (12, 4)) * (90.0, 60.0, 150.0, 40.0) + (0, 90, 0, 0)).tolist()
    ]
    exact = measured(mended(name, [1.5, -2.0, 0.7, 1.1]), marks)
    rows = [(axes, np.add(place, rng.normal(0.0, 0.05, 3)), turn) for axes, place, turn in exact]
    samples = {"axes": np.array(marks), "positions": np.array([place for _, place, _ in rows])}
    found = softkin.calibrate(robot(name).twin, samples, parameters=["offset"]).deviations
    made = taught(teacher(robot(name), rows, position_only=True))
    assert len(found) == 4 and made.aDetermined[:4] == [True] * 4
    assert [-value for value in found.values()] == pytest.approx(made.aCorrections[:4], abs=1e-5)


def test_positions_alone() -> None:
    """What no position tells is said, and stays: the last axis of a wrist turns about the point that is measured."""
    name, true = "Kin_ArticulatedRobot_6DOF", [1.0, -0.8, 0.5, 0.9, -0.7, 0.0]
    made = taught(teacher(robot(name), measured(mended(name, true), MARKS[name]), position_only=True))
    assert made.aDetermined == [True] * 5 + [False]
    assert made.aCorrections == pytest.approx(true, abs=1e-5)
    assert made.dPositionAfter < 1e-6 and made.dRotationBefore == made.dRotationAfter == 0.0


def test_rows_of_both_kinds() -> None:
    """The error of rotations is that of the rows that have one; and a row is kept once, however long xAdd is set."""
    one = robot("Kin_Scara3_Z")
    ((axes, place, turn),) = measured(one.twin, MARKS["Kin_Scara3_Z"][:1])
    made = teacher(one, [(axes, place, about(0, 3.0) @ turn)])
    made.xPositionOnly = True
    for made.xAdd in (True, True, False):
        made()
    assert made.iRows == 2
    assert taught(made).dRotationBefore == pytest.approx(3.0)


def test_axes_that_do_the_same_are_not_determined() -> None:
    """At one mark with a straight wrist A4 and A6 turn about one line: neither is determined, and the others are."""
    name, mark = "Kin_ArticulatedRobot_6DOF", (10.0, 80.0, -30.0, 20.0, 0.0, 10.0)
    true = [1.0, -0.8, 0.5, 0.0, 0.0, 0.0]
    made = taught(teacher(robot(name), measured(mended(name, true), [mark])))
    assert made.aDetermined == [True, True, True, False, True, False]
    assert made.aCorrections == pytest.approx(true, abs=1e-5) and made.aCorrections[3] == made.aCorrections[5] == 0.0


def test_nothing_is_determined() -> None:
    """A tool has no axes: the search ends, and moves nothing."""
    one = robot("Kin_Tool", tool_x=10.0)
    ((axes, place, turn),) = measured(one.twin, [()])
    made = taught(teacher(one, [(axes, (place[0] + 2.0, *place[1:]), turn)]))
    assert not made.xRefused and not any(made.aDetermined) and made.aCorrections == [0.0] * 6
    assert made.dPositionAfter == made.dPositionBefore == pytest.approx(2.0)


def test_rows_that_are_none() -> None:
    """They are not kept, and say why; the search ends with a reason where it cannot begin."""
    one = robot("Kin_Scara3_Z")
    row = measured(one.twin, MARKS["Kin_Scara3_Z"])[0]
    for place in ((float("nan"), 0.0, 0.0), (0.0, float("inf"), 0.0), (0.0, 0.0, 1e300)):
        made = teacher(one, [(row[0], place, row[2])])
        assert (made.iRows, made.xRefused, made.eStatus) == (0, True, BAD_INPUT) and "position" in made.sReason
    for turn in (np.zeros((3, 3)), np.full((3, 3), np.nan)):
        made = teacher(one, [(row[0], row[1], turn)])
        assert (made.iRows, made.eStatus) == (0, BAD_INPUT) and "rotation" in made.sReason
        assert teacher(one, [(row[0], row[1], turn)], position_only=True).iRows == 1
    made = teacher(one, [row] * 21)
    assert made.iRows == 20 and made.xRefused and "20 rows" in made.sReason
    made.xClear = True
    made()
    assert made.iRows == 0
    made.xClear, made.xSolve = False, True
    made()
    assert made.xDone and made.xRefused and (made.eStatus, made.sReason) == (BAD_INPUT, "there are no rows")
    for key, value, status in (("itfKin", None, NOT_INITIALIZED), *(("dPerDegree", v, BAD_INPUT) for v in NO_LENGTHS)):
        made = teacher(one, [row])
        setattr(made, key, value)
        made.xSolve = True
        made()
        assert made.xDone and made.xRefused and made.eStatus == status and key in made.sReason


NO_LENGTHS = (0.0, -1.0, float("nan"), float("inf"))


def test_axis_values_without_a_pose() -> None:
    """The search ends at the row that has none, and corrects nothing."""
    one = robot("Kin_Delta_P3C_Type3")
    good = measured(one.twin, MARKS["Kin_Delta_P3C_Type3"])[:1]
    for axes, status in (((-170.0, 0.0, 0.0), IMPOSSIBLE), ((float("nan"), 0.0, 0.0), BAD_INPUT)):
        made = taught(teacher(one, [*good, (axes, good[0][1], good[0][2])]))
        assert made.xRefused and (made.eStatus, made.iRefusedRow) == (status, 1) and "no pose" in made.sReason
        assert made.aCorrections == [0.0] * 6
    fresh = Robot(Controller(one.controller.library, named("Kin_Delta_P3C_Type3")), one.twin)
    made = taught(teacher(fresh, good))
    assert (made.eStatus, made.iRefusedRow) == (NOT_INITIALIZED, 0)


def test_a_search_that_does_not_settle() -> None:
    """Rows that no offsets explain, far from every pose, end it with a status."""
    one = robot("Kin_Scara3_Z")
    rows = [((20.0, 60.0, -10.0, 5.0), (-9000.0, 100.0, 0.0), np.eye(3)),
            ((50.0, -60.0, -10.0, 5.0), (9000.0, 300.0, 10.0), about(2, 120.0))]  # fmt: skip
    made = taught(teacher(one, rows))
    assert made.iPasses <= 30 and (made.xRefused or made.dPositionAfter <= made.dPositionBefore)
    if made.xRefused:
        assert made.eStatus in (IMPOSSIBLE, BAD_INPUT) and made.sReason and made.aCorrections == [0.0] * 6


def test_it_stops_and_begins_again() -> None:
    """Without xSolve a search ends; a rising edge begins another one, with all rows; none is kept while it is busy."""
    name, true = "Kin_Scara3_Z", [1.5, -2.0, 0.7, 1.1]
    one, rows = robot(name), measured(mended(name, true), MARKS[name])
    made = teacher(one, rows[:2])
    made.xSolve = made.xAdd = True
    made()
    assert made.xBusy and made.iRows == 3, "a row is kept in the call that begins"
    for given in (False, True):
        made.xAdd = given
        made()
    assert made.xBusy and made.iRows == 3
    made.xSolve = False
    made()
    assert not made.xBusy and not made.xDone
    assert taught(made).aCorrections[:4] == pytest.approx(true, abs=1e-6)


def test_it_writes_nothing_into_the_block() -> None:
    """The group may move meanwhile."""
    name = "Kin_Scara3_Z"
    one, rows = robot(name), measured(mended(name, [1.0, 1.0, 1.0, 1.0]), MARKS[name])
    before = {key: values.plain(value) for key, value in one.controller.state().items()}
    taught(teacher(one, rows))
    assert {key: values.plain(value) for key, value in one.controller.state().items()} == before


OF_STATEMENTS = ("Kin_Tool", "Kin_Delta_P3C_Type3", "Kin_Scara3_Z")


def every_statement() -> None:
    """What reaches every statement of the block, on these machines."""
    test_offsets_are_found("Kin_Scara3_Z")
    test_nothing_is_determined()
    test_rows_that_are_none()
    test_axis_values_without_a_pose()
    test_a_search_that_does_not_settle()
    test_it_stops_and_begins_again()
