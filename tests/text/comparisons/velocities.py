"""Velocities, and the poses where they have no bound: the Jacobian, singularities and their margins."""

from collections.abc import Callable
from math import isnan, pi, prod
from typing import Any

from softkin import Frame
from softkin._start import IterativeForward

from tests.text import values
from tests.text.controller import OK, asked, assert_same
from tests.text.pairs import Pair
from tests.text.samples import Sample


def jacobian(pair: Pair, sample: Sample, start: Frame | None = None) -> None:
    """Jacobian writes the matrix of Python, and zeros in all other places."""
    status, rows = asked(pair.robot.jacobian, sample.axes, *_start_in_python(pair, start))
    expected = None
    if status == OK:
        wide = [tuple(row) + (0.0,) * (6 - len(row)) for row in rows]
        expected = (*wide, *((0.0,) * 6,) * (6 - len(wide)))
    assert_same(pair.controller.jacobian(sample.axes, start), (status, expected), pair, sample)


def axis_velocities(pair: Pair, sample: Sample, start: Frame | None = None) -> None:
    """AxisVelocities gives what the Jacobian of Python turns into the twist; where that is singular, a status and
    zeros.
    """
    twist = [40.0, -30.0, 20.0, 10.0, -15.0, 25.0]
    found = [values.MEANINGLESS] * 6
    given = {"aVelocities": found, "aTwist": twist, "a": values.axes(pair.library, sample.axes)}
    status, _ = _called(pair, "AxisVelocities", given, start)
    own = _start_in_python(pair, start)
    wanted, rows = asked(pair.robot.jacobian, sample.axes, *own)
    if status != OK:
        assert found == [0.0] * 6
        margins = pair.robot.singularity(sample.axes, *own).margins.values()
        assert wanted == status or prod(map(abs, margins)) < 1e-9
        return
    assert wanted == OK
    speeds = [v * pi / 180 if j.in_degrees else v for v, j in zip(found, pair.mechanism.joints, strict=False)]
    # An entry of the Jacobian is rounded as the largest one of its column, whatever its own size.
    largest = [max(map(abs, column)) for column in zip(*rows, strict=True)]
    size = max(1.0, sum(entry * abs(v) for entry, v in zip(largest, speeds, strict=True)))
    for row, name, value in zip(rows, pair.robot.JACOBIAN_ROWS, twist, strict=False):
        expected = value if name in ("x", "y", "z") else value * pi / 180
        assert abs(sum(a * b for a, b in zip(row, speeds, strict=True)) - expected) < 1e-9 * size, f"{pair} {sample}"
    assert not any(found[len(speeds) :])


def axis_accelerations(pair: Pair, sample: Sample, start: Frame | None = None) -> None:
    """AxisAccelerations gives what Python turns into the twist's rate, or the status of AxisVelocities and zeros."""
    rate, speeds = [400.0, -300.0, 200.0, 100.0, -150.0, 250.0], [30.0, -20.0, 40.0, 25.0, -35.0, 45.0]
    found = [values.MEANINGLESS] * 6
    given = {"aAccelerations": found, "aVelocities": list(speeds), "aTwistRate": rate}
    given |= {"a": values.axes(pair.library, sample.axes)}
    status, _ = _called(pair, "AxisAccelerations", given, start)
    if status != OK:
        assert found == [0.0] * 6
        velocities = [values.MEANINGLESS] * 6
        given = {"aVelocities": velocities, "aTwist": rate, "a": values.axes(pair.library, sample.axes)}
        assert _called(pair, "AxisVelocities", given, start)[0] == status
        return
    angles = [pi / 180 if j.in_degrees else 1.0 for j in pair.mechanism.joints]
    moving, turning = ([v * unit for v, unit in zip(own, angles, strict=False)] for own in (speeds, found))
    own_start = {} if not _start_in_python(pair, start) else {"start": start}
    reached = pair.robot.twist_rate(sample.axes, moving, turning, **own_start)
    rows = pair.robot.jacobian(sample.axes, *_start_in_python(pair, start))
    largest = [max(map(abs, column)) for column in zip(*rows, strict=True)]
    size = max(1.0, sum(entry * (abs(a) + v * v) for entry, a, v in zip(largest, turning, moving, strict=True)))
    for name, value, back in zip(pair.robot.JACOBIAN_ROWS, rate, reached, strict=False):
        expected = value if name in ("x", "y", "z") else value * pi / 180
        assert abs(back - expected) < 1e-9 * size, f"{pair} {sample}"
    assert not any(found[len(angles) :])


def singularity(pair: Pair, sample: Sample) -> None:
    expected = pair.robot.singularity(sample.axes).is_singular
    assert pair.controller.is_singular(sample.axes) == expected, f"{pair} {sample}"


def margins(pair: Pair, sample: Sample, start: Frame | None = None) -> None:
    """Margins writes those of Python, and zeros in all other places."""
    found = [values.MEANINGLESS] * 8
    status, outputs = _called(pair, "Margins", {"aMargins": found, "a": values.axes(pair.library, sample.axes)}, start)
    expected = tuple(pair.robot.singularity(sample.axes, *_start_in_python(pair, start)).margins.values())
    if status == OK:
        assert outputs["iCount"] == len(expected)
        assert_same((status, tuple(found)), (OK, (*expected, *(0.0,) * (8 - len(expected)))), pair, sample)
    else:
        assert found == [values.MEANINGLESS] * 8 and all(map(isnan, expected))


def from_start(compare: Callable[[Pair, Sample, Frame], None]) -> Callable[[Pair, Sample], None]:
    """The comparison of the method that takes a start as well, with the frame of the axes; the origin where they have
    none.
    """

    def compare_from(pair: Pair, sample: Sample) -> None:
        status, found = asked(lambda axes: pair.robot.forward(axes)[0], sample.axes)
        compare(pair, sample, found if status == OK else Frame((0.0, 0.0, 0.0)))

    return compare_from


def _called(pair: Pair, method: str, given: dict[str, Any], start: Frame | None) -> tuple[str, dict[str, Any]]:
    """The status and the outputs of a method; of the one that takes a start, if there is one."""
    block = pair.controller.block
    if start is None:
        return block.call_with_outputs(method, **given)
    return block.call_with_outputs(f"{method}From", **given, f=values.frame(pair.library, *start))


def _start_in_python(pair: Pair, start: Frame | None) -> tuple[Frame, ...]:
    """The start as an argument in Python, where a machine with one frame at its axes takes none."""
    return () if start is None or not isinstance(pair.robot, IterativeForward) else (start,)
