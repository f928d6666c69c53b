"""The projection of the machine to the page: a planar machine along its third coordinate, else an axonometric view."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from derive.drawing.scene import Point
from derive.emit.picture.ink import Vector

_AZIMUTH, _ELEVATION = np.radians(-74.0), np.radians(26.0)
"""The direction of the viewer: X points right and a little down, Y points right and up, Z points up."""


@dataclass(frozen=True)
class Box:
    """A rectangular part of the page."""

    left: float
    bottom: float
    right: float
    top: float


@dataclass(frozen=True)
class View:
    """A parallel projection to a part of the page."""

    axes: Vector
    """Two rows: the direction that points right on the page, and the direction that points up."""
    scale: float
    """Pixels of one unit of the machine."""
    shift: Vector
    is_planar: bool
    """Whether it shows a plane of the machine, seen along the third coordinate."""

    def page(self, point: Iterable[float]) -> Vector:
        """The point of the page that shows a point of the machine."""
        return np.asarray(self.scale * (self.axes @ np.array(list(point))) + self.shift)

    def direction(self, vector: Iterable[float]) -> Vector:
        """A direction of the machine on the page, not normalised: a direction towards the viewer is short."""
        return np.asarray(self.axes @ np.array(list(vector)))

    @property
    def eye(self) -> Vector:
        """The direction to the viewer."""
        return np.cross(self.axes[0], self.axes[1])


def axes_of(plane: tuple[int, int] | None) -> Vector:
    """The rows of the projection: two coordinates of the machine, or an axonometric view."""
    if plane is not None:
        return np.eye(3)[list(plane)]
    right = [-np.sin(_AZIMUTH), np.cos(_AZIMUTH), 0.0]
    up = [-np.sin(_ELEVATION) * np.cos(_AZIMUTH), -np.sin(_ELEVATION) * np.sin(_AZIMUTH), np.cos(_ELEVATION)]
    return np.array([right, up])


def fitted(points: Sequence[Point], box: Box, *, plane: tuple[int, int] | None) -> View:
    """The view in which all points are inside the box, as large as possible, in its middle."""
    axes = axes_of(plane)
    seen = np.array([axes @ np.array(p) for p in points])
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = np.array([box.right - box.left, box.top - box.bottom])
    scale = float(np.min(room / np.maximum(high - low, 1e-9)))
    middle = np.array([box.left + box.right, box.bottom + box.top]) / 2
    return View(axes, scale, middle - scale * (low + high) / 2, plane is not None)
