"""Velocities, and the poses where they have no bound: the Jacobian, singularities and their margins."""

from __future__ import annotations

from collections.abc import Callable
from math import isnan, pi, prod

from softkin import Frame

from tests.text import values
from tests.text.closeness import asked, assert_same
from tests.text.controller import OK
from tests.text.samples import Sample
from tests.text.serial_pairs import SerialPair


def jacobian(pair: SerialPair, sample: Sample) -> None:
    """Jacobian writes the matrix of Python, and zeros in all other places."""
    status, rows = asked(pair.robot.jacobian, sample.axes)
    expected = None
    if status == OK:
        wide = [tuple(row) + (0.0,) * (6 - len(row)) for row in rows]
        expected = (*wide, *((0.0,) * 6,) * (6 - len(wide)))
    assert_same(pair.controller.jacobian(sample.axes), (status, expected), pair, sample)


def axis_velocities(pair: SerialPair, sample: Sample) -> None:
    """AxisVelocities gives what the Jacobian of Python turns into the twist; where that is singular, a status and
    zeros.
    """
    twist = [40.0, -30.0, 20.0, 10.0, -15.0, 25.0]
    found = [values.MEANINGLESS] * 6
    given = {"aVelocities": found, "aTwist": twist, "a": values.axes(pair.library, sample.axes)}
    status = pair.controller.block.call("AxisVelocities", **given)
    wanted, rows = asked(pair.robot.jacobian, sample.axes)
    if status != OK:
        assert found == [0.0] * 6
        margins = pair.robot.singularity(sample.axes).margins.values()
        assert wanted == status or prod(map(abs, margins)) < 1e-9
        return
    assert wanted == OK
    speeds = [v * pi / 180 if j.in_degrees else v for v, j in zip(found, pair.mechanism.joints, strict=False)]
    # An entry of the Jacobian is rounded as the largest one of its column, whatever its own size.
    largest = [max(map(abs, column)) for column in zip(*rows, strict=True)]
    size = max(1.0, sum(entry * abs(v) for entry, v in zip(largest, speeds, strict=True)))
    for row, name, value in zip(rows, pair.robot.JACOBIAN_ROWS, twist, strict=False):
        expected = value * pi / 180 if name.startswith("turn") else value
        assert abs(sum(a * b for a, b in zip(row, speeds, strict=True)) - expected) < 1e-9 * size, f"{pair} {sample}"
    assert not any(found[len(speeds) :])


def singularity(pair: SerialPair, sample: Sample) -> None:
    """IsSingularity answers as Python."""
    expected = pair.robot.singularity(sample.axes).is_singular
    assert pair.controller.is_singular(sample.axes) == expected, f"{pair} {sample}"


def margins(pair: SerialPair, sample: Sample) -> None:
    """Margins writes those of Python, and zeros in all other places."""
    found = [values.MEANINGLESS] * 8
    block = pair.controller.block
    given = {"aMargins": found, "a": values.axes(pair.library, sample.axes)}
    status, outputs = block.call_with_outputs("Margins", **given)
    expected = tuple(pair.robot.singularity(sample.axes).margins.values())
    if status == OK:
        assert outputs["iCount"] == len(expected)
        assert_same((status, tuple(found)), (OK, (*expected, *(0.0,) * (8 - len(expected)))), pair, sample)
    else:
        assert found == [values.MEANINGLESS] * 8 and all(map(isnan, expected))


def at_the_frame(method: str) -> Callable[[SerialPair, Sample], None]:
    """The method that takes the frame of the axes as well: a serial mechanism has one, and answers as without it."""
    name, size = {"Jacobian": ("J", 36), "Margins": ("aMargins", 8), "AxisVelocities": ("aVelocities", 6)}[method]

    def compare(pair: SerialPair, sample: Sample) -> None:
        status, found = asked(lambda axes: pair.robot.forward(axes)[0], sample.axes)
        frame = found if status == OK else Frame((0.0, 0.0, 0.0))
        start = {"f": values.frame(pair.library, frame.position, frame.rotation)}
        answers = []
        for more in ({}, start):
            written = [values.MEANINGLESS] * size
            given = {name: written, "a": values.axes(pair.library, sample.axes)}
            given |= {"aTwist": [4.0, -3.0, 2.0, 1.0, -1.5, 2.5]} if method == "AxisVelocities" else {}
            called = method + ("From" if more else "")
            answers.append((pair.controller.block.call_with_outputs(called, **given, **more), written))
        assert repr(answers[0]) == repr(answers[1]), f"{pair} {sample}"

    return compare
