"""Chains of elementary frames: the geometry of a serial mechanism, written as a product.

`Rz(A1) * Tx(link) * Rz(A2)` is a rotation about z, a shift along x, and a rotation about the new z.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import sympy as sp


class Motion(Enum):
    """The kind of motion of an elementary frame."""

    TURN = "turn"
    SHIFT = "shift"
    FLIP = "flip"
    """Half a turn where a flag (0 or 1) is set."""


@dataclass(frozen=True)
class Factor:
    """One elementary frame: a motion about or along one axis (0, 1, 2 = x, y, z) by an amount (radians or length)."""

    motion: Motion
    axis: int
    amount: sp.Expr

    def matrix(self) -> sp.ImmutableMatrix:
        """The homogeneous 4 x 4 matrix."""
        rotation, position = sp.eye(3), sp.zeros(3, 1)
        if self.motion is Motion.SHIFT:
            position[self.axis] = self.amount
        else:
            rotation = self._rotation()
        return sp.ImmutableMatrix(sp.Matrix.vstack(rotation.row_join(position), sp.Matrix([[0, 0, 0, 1]])))

    def inverse(self) -> Factor:
        """The inverse frame; half a turn is its own inverse."""
        return self if self.motion is Motion.FLIP else Factor(self.motion, self.axis, -self.amount)

    def _rotation(self) -> sp.Matrix:
        if self.motion is Motion.FLIP:
            cosine, sine = 1 - 2 * self.amount, sp.Integer(0)
        else:
            cosine, sine = sp.cos(self.amount), sp.sin(self.amount)
        rotation = sp.eye(3)
        first, second = (self.axis + 1) % 3, (self.axis + 2) % 3
        rotation[first, first] = rotation[second, second] = cosine
        rotation[first, second], rotation[second, first] = -sine, sine
        return rotation


@dataclass(frozen=True)
class Chain:
    """A product of elementary frames, base first."""

    factors: tuple[Factor, ...]

    def __mul__(self, other: Chain) -> Chain:
        if not isinstance(other, Chain):
            raise TypeError(_no_frame(other))
        return Chain(self.factors + other.factors)

    def __rmul__(self, other: object) -> Chain:
        raise TypeError(_no_frame(other))

    def _sympy_(self) -> sp.Expr:
        raise TypeError("a chain is a product of frames, not a number: as in Rz(A1) * Tx(L1)")

    def matrix(self) -> sp.ImmutableMatrix:
        """The homogeneous 4 x 4 matrix of the product."""
        product = sp.ImmutableMatrix(sp.eye(4))
        for factor in self.factors:
            product = product * factor.matrix()
        return sp.ImmutableMatrix(product)


def _no_frame(value: object) -> str:
    """The sentence about a factor of a chain that is no frame."""
    name = getattr(value, "name", value)
    return f"{name} is a number, not a frame: as in Rz({name}) or Tz({name})"


LETTERS = {Motion.TURN: "R", Motion.SHIFT: "T", Motion.FLIP: "flip_"}
"""How descriptions spell a motion, in front of its axis."""


def _one(motion: Motion, axis: int, amount: object) -> Chain:
    if amount is None or isinstance(amount, str | bool | list | tuple):
        place = f"{LETTERS[motion]}{'xyz'[axis]}({amount!r})"
        raise TypeError(f"{place} needs a joint, a parameter, a number or an expression of these")
    return Chain((Factor(motion, axis, sp.sympify(amount)),))


def Rx(angle: object) -> Chain:
    """A rotation about x by an angle (a joint, or an expression in radians)."""
    return _one(Motion.TURN, 0, angle)


def Ry(angle: object) -> Chain:
    """A rotation about y."""
    return _one(Motion.TURN, 1, angle)


def Rz(angle: object) -> Chain:
    """A rotation about z."""
    return _one(Motion.TURN, 2, angle)


def Tx(distance: object) -> Chain:
    """A shift along x."""
    return _one(Motion.SHIFT, 0, distance)


def Ty(distance: object) -> Chain:
    """A shift along y."""
    return _one(Motion.SHIFT, 1, distance)


def Tz(distance: object) -> Chain:
    """A shift along z."""
    return _one(Motion.SHIFT, 2, distance)


def Txyz(x: object, y: object, z: object) -> Chain:
    """A shift along x, y and z."""
    return Tx(x) * Ty(y) * Tz(z)


def flip_x(flag: object) -> Chain:
    """Half a turn about x where the flag parameter is set (a flange that looks down)."""
    return _one(Motion.FLIP, 0, flag)


def denavit_hartenberg(*rows: tuple[object, object, object, object]) -> Chain:
    """A chain from its table, one row for each joint: angle about z, distance along z, length along x, twist about x
    (angles in radians).
    """
    factors = (f for angle, d, a, twist in rows for f in (Rz(angle) * Tz(d) * Tx(a) * Rx(twist)).factors)
    return Chain(tuple(f for f in factors if f.amount != 0))
