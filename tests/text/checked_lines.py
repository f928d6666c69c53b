"""Lines that Softkin_CheckLine checks, and the same walk along them made in Python with NumPy."""

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
from tests.text.controller import OK, Controller
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
