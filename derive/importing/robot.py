"""The content of a robot file between its base and its tip, as data that are independent of the file format.

Lengths are in the unit of the description that is written, angles in radians.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from derive.description.errors import DescriptionError
from derive.description.joints import Kind

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


class UnreadableRobot(DescriptionError):
    """A robot file cannot be imported; one sentence names the place and the remedy."""


@dataclass(frozen=True)
class Turned:
    """A fixed turn about x, y or z (0, 1, 2) by an angle."""

    axis: int
    angle: float
    rounding: float = 0.0
    """The largest distance of the angle from the exact one that the file has rounded (radians), by its decimals."""

    def matrix(self) -> Array:
        """The homogeneous 4 x 4 matrix."""
        matrix = np.eye(4)
        matrix[:3, :3] = about(np.eye(3)[self.axis], self.angle)
        return matrix


@dataclass(frozen=True)
class Shifted:
    """A fixed shift."""

    by: Triple

    def matrix(self) -> Array:
        """The homogeneous 4 x 4 matrix."""
        matrix = np.eye(4)
        matrix[:3, 3] = self.by
        return matrix


@dataclass(frozen=True)
class Oriented:
    """A fixed rotation that the file gives as a whole (a quaternion, two axes)."""

    rows: tuple[Triple, Triple, Triple]
    rounding: float = 0.0
    """The rounding of its angle: see `Turned`."""

    def matrix(self) -> Array:
        """The homogeneous 4 x 4 matrix."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rows
        return matrix


Place = Turned | Shifted | Oriented


@dataclass(frozen=True)
class Moving:
    """A movement about or along a direction: the sum of the multiples of the axes that drive it, plus an offset."""

    kind: Kind
    direction: Triple
    drives: tuple[tuple[str, float], ...]
    offset: float = 0.0
    rounding: float = 0.0
    """The rounding of the offset: see `Turned`."""
    aslant: float = 0.0
    """The rounding of its direction: see `Turned`."""

    @property
    def turns(self) -> bool:
        """Whether the movement is about a direction, so that its offset is an angle."""
        return self.kind is Kind.ROTARY


@dataclass(frozen=True)
class Step:
    """A joint of the file: its place on the link before it, and its movement (None: it is fixed)."""

    name: str
    places: tuple[Place, ...]
    moving: Moving | None = None


@dataclass(frozen=True)
class Axis:
    """A joint that is commanded, with its limits where the file gives any (radians or lengths)."""

    name: str
    kind: Kind
    limits: tuple[float, float] | None = None


@dataclass(frozen=True)
class RodArm:
    """An arm with one axis, from the base to where a rod hangs on it; that rod, and its length."""

    steps: tuple[Step, ...]
    rod: str
    length: float


@dataclass(frozen=True)
class Rods:
    """Rods that meet in the tip, one for each axis."""

    arms: tuple[RodArm, ...]
    plane: int | None
    """The axis x, y or z (0, 1, 2) of the base about which all joints turn; None in space."""
    drawn: Triple | None
    """Where the file draws the tip; None if it draws the rods apart."""


@dataclass(frozen=True)
class Robot:
    """A chain from the base to the tip, and the axes that move it in the order of the chain."""

    name: str
    source: str
    base: str
    tip: str
    steps: tuple[Step, ...]
    axes: tuple[Axis, ...]
    notes: tuple[str, ...] = ()
    """Omissions and assumptions: sentences for the report."""
    rods: Rods | None = None
    """What moves the tip where no chain of steps does."""


def reversed_step(step: Step, is_reversed: bool = True) -> tuple[Step, ...]:
    """The step, or its inverse: the opposite movement, then the inverse of its place."""
    if not is_reversed:
        return (step,)
    back = Step(step.name, tuple(_opposite(p) for p in reversed(step.places)))
    if step.moving is None:
        return (back,)
    x, y, z = step.moving.direction
    return Step(step.name, (), replace(step.moving, direction=(-x, -y, -z))), back


def _opposite(place: Place) -> Place:
    if isinstance(place, Turned):
        return Turned(place.axis, -place.angle, place.rounding)
    if isinstance(place, Shifted):
        x, y, z = place.by
        return Shifted((-x, -y, -z))
    first, second, third = zip(*place.rows, strict=True)
    return Oriented((first, second, third), place.rounding)


def about(direction: Array, angle: float) -> Array:
    """The rotation matrix about a unit vector by an angle; exact at multiples of a right angle about x, y and z."""
    quarters = angle / (np.pi / 2)
    if abs(quarters - round(quarters)) < 1e-15 * max(1.0, abs(quarters)):
        cosine, sine = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarters) % 4]
    else:
        cosine, sine = float(np.cos(angle)), float(np.sin(angle))
    x, y, z = direction
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(cosine * np.eye(3) + sine * cross + (1.0 - cosine) * np.outer(direction, direction))
