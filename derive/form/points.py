"""The point of every turn on its own line, which the shifts lead to.

Two lines that are not parallel have a common perpendicular: the way leads along the first line, behind its turn, to
the foot there, and from it to the foot on the second one. This is the convention of Denavit and Hartenberg; if the
lines meet, both feet are the point in which they do. On a line parallel to the one before the point is nearest to the
point before. The way along the first line stands in front of its turn: the commanded point is then known from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from derive.form.lines import Array, Line

_PARALLEL = 0.05
"""Lines at a smaller angle (radians) count as parallel here: the feet are far away."""


def points(lines: Sequence[Line], origin: Array) -> list[Array]:
    """The points of turns, one after the other. origin: that of the base, for lines that are all parallel."""
    found: list[Array] = []
    feet = [_foot(second, first) for first, second in pairwise(lines)]
    before = next((foot for pair in pairwise(lines) if (foot := _foot(*pair)) is not None), origin)
    for line, foot in zip(lines, [None, *feet], strict=False):
        before = _nearest(line, before) if foot is None else foot
        found.append(before)
    return found


def _foot(line: Line, other: Line) -> Array | None:
    """The point of a line nearest to another; None if they are (nearly) parallel."""
    cosine = float(line.direction @ other.direction)
    determinant = 1.0 - cosine**2
    if determinant < _PARALLEL**2:
        return None
    along = (line.direction - cosine * other.direction) @ (other.point - line.point) / determinant
    return np.asarray(line.point + np.outer(line.direction, along))


def _nearest(line: Line, point: Array) -> Array:
    """The point of a line that is nearest to a point."""
    return np.asarray(line.point + np.outer(line.direction, line.direction @ (point - line.point)))
