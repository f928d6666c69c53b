"""Pictures with matplotlib, which is imported here and nowhere else: a machine as lines, and values along a path."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple

from softkin._calibrated import Calibrated
from softkin._chain import Placed, motion, placed
from softkin._coupled import Coupled
from softkin._frame import IDENTITY, ORIGIN
from softkin._mounted import Mounted
from softkin._radians import InRadians
from softkin._scalar import DEGREE, RADIAN
from softkin._types import KinematicsError, Reals, Status, Vector

if TYPE_CHECKING:
    from softkin._core import Mechanism
    from softkin._path import Path

_ARROW = 0.12
"""The length of the arrows of the tool, as a share of the picture."""


class Line(NamedTuple):
    """A straight line of the drawing."""

    start: Vector
    end: Vector
    name: str
    """The axes that drive it, at its start; empty if there is none."""


def figure(ax: Any, **projection: str) -> Any:
    """The axes of matplotlib to draw in. Raises ImportError with the remedy."""
    try:
        from matplotlib import pyplot
    except ImportError as problem:
        raise ImportError("plot needs matplotlib: pip install 'softkin[plot]'") from problem
    return pyplot.figure().add_subplot(**projection) if ax is None else ax


def machine(robot: Mechanism, axes: Reals, ax: Any = None) -> Any:
    """See `Mechanism.plot`."""
    (position, rotation), _ = robot.forward(axes)
    lines = lines_of(robot, axes)
    ax = figure(ax, projection="3d")
    points = [point for line in lines for point in line[:2]] + [position, ORIGIN]
    ends = [(min(column), max(column)) for column in zip(*points, strict=True)]
    size = max(high - low for low, high in ends) or 1.0
    ax.plot(*_columns([(line.start, line.end) for line in lines]), color="#8a95a3", linewidth=4, solid_capstyle="round")
    first: dict[str, Vector] = {}
    for line in lines:
        first.setdefault(line.name, line.start)
    first.pop("", None)
    for start in dict.fromkeys(first.values()):
        names = [name for name in first if first[name] == start]
        ax.text(*start, f" {' '.join(names)}", color="#1d5fa8")
    for column, colour in zip(zip(*rotation, strict=True), ("#c0392b", "#2e8b57", "#1d5fa8"), strict=True):
        end = tuple(p + _ARROW * size * c for p, c in zip(position, column, strict=True))
        ax.plot(*_columns([(position, end)]), color=colour)
    x, y, z = (((low + high - size) / 2.0, (low + high + size) / 2.0) for low, high in ends)
    ax.set(xlim=x, ylim=y, zlim=z, xlabel="x [u]", ylabel="y [u]", zlabel="z [u]", title=robot.NAME)
    ax.set_box_aspect((1.0, 1.0, 1.0))
    return ax


def curves(robot: Mechanism, over: Any, values: Any, ax: Any, xlabel: str, what: str, per: str = "") -> Any:
    """Draw a curve for each axis. values: a row of axis values for each place or time."""
    ax = figure(ax)
    for axis, column in zip(robot.AXES, zip(*values, strict=True), strict=True):
        ax.plot(over, column, label=f"{axis.name} [{axis.unit}{per}]")
    ax.set(xlabel=xlabel, ylabel=what, title=robot.NAME)
    ax.legend()
    return ax


def path(found: Path, ax: Any) -> Any:
    """See `Path.plot`."""
    ax = curves(found.robot, found.places, found.axes, ax, "line", "axis value")
    for stretch in found.singular:
        ax.axvspan(stretch.start, stretch.end, color="#e0a030", alpha=0.3)
    if found.stop is not None:
        ax.axvline(found.stop.place, color="#c0392b")
        ax.set_title(f"{found.robot.NAME}: {found.stop.refusal.in_words}")
    return ax


def lines_of(robot: Mechanism, axes: Reals) -> list[Line]:
    """The lines of a machine at axis values, in the coordinates of its frames."""
    if isinstance(robot, InRadians):
        units = zip(axes, robot.AXES, strict=True)
        return lines_of(robot.part, tuple(v * RADIAN if axis.unit == "rad" else v for v, axis in units))
    if isinstance(robot, Calibrated):
        return lines_of(robot.nominal, axes)
    if isinstance(robot, Mounted):
        flange = robot.bare.forward(axes)[0]
        own = [*lines_of(robot.bare, axes), Line(flange.position, flange @ robot.tool.position, "")]
        return _moved(own, robot.base)
    if isinstance(robot, Coupled):
        first, count = robot.position_part, len(robot.position_part.AXES)
        carried = _moved(lines_of(robot.orientation_part, axes[count:]), first.forward(axes[:count])[0])
        return lines_of(first, axes[:count]) + carried
    return _of_chain(robot, axes) if robot._chain() is not None else _of_loop(robot, axes)


def _of_chain(robot: Mechanism, axes: Reals) -> list[Line]:
    """Every shift of a chain, and every turn as a line without length."""
    motors = [
        (value - zero) * (1.0 if axis.unit == "u" else DEGREE)
        for value, zero, axis in zip(axes, robot._axis_zeros(), robot.AXES, strict=True)
    ]
    here, found = (ORIGIN, IDENTITY), list[Line]()
    for link in robot._chain() or ():
        amount = link.fixed + sum(share * motors[i] for i, share in link.motors)
        following: Placed = placed(here, motion(link.motion == "turn", link.axis, amount))
        name = " ".join(robot.AXES[i].name for i, _ in link.motors)
        if name or following[0] != here[0]:
            found.append(Line(here[0], following[0], name))
        here = following
    return found


def _of_loop(robot: Mechanism, axes: Reals) -> list[Line]:
    position, rotation = robot.forward(axes)[0]
    values = robot._points(axes, position, rotation)
    if isinstance(values, Status) or not robot.LINES:
        raise KinematicsError(Status.IMPOSSIBLE, f"{robot.NAME}.plot: there are no lines to draw")
    points = [(values[i], values[i + 1], values[i + 2]) for i in range(0, len(values), 3)] + [position]
    return [Line(points[start], points[end], name) for start, end, name in robot.LINES]


def _moved(lines: Sequence[Line], frame: Any) -> list[Line]:
    return [Line(frame @ line.start, frame @ line.end, line.name) for line in lines]


def _columns(lines: Sequence[tuple[Any, Any]]) -> list[list[float]]:
    """The coordinates of lines, with a gap behind each."""
    return [[v for start, end in lines for v in (start[k], end[k], nan)] for k in range(3)]
