"""The joints of a description: how they move, what their values mean, and their ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypedDict, Unpack

import sympy as sp

from derive.description.quantity import Quantity
from derive.geometry.frames import Chain
from derive.geometry.pose import pose_of
from derive.ir.constants import DEGREE
from derive.ir.symbols import COORDINATE_NAMES, count, real

Interval = tuple[float, float]


class Kind(Enum):
    """How a joint moves, and how its values are read."""

    LINEAR = "linear"
    ROTARY = "rotary"
    HELICAL = "helical"
    """Turns, and moves another axis along by its pitch: it is declared Linear, with values in degrees."""
    GEARED = "geared"
    """A whole turn of its motor is not a whole turn of its joints: declared Linear, with values in degrees."""
    DRIVING = "driving"
    """A turning motor that moves lengths alone, through a belt or a screw: declared Linear, with values in degrees."""


@dataclass(frozen=True)
class Loop:
    """One loop, in the frame in which the joint that it moves stands: |tip - start| = length."""

    moved: sp.Symbol
    """What it moves: a joint of the chain, or what the next loop is moved by."""
    by: sp.Symbol
    """What moves it: a motor, or what the loop before moves."""
    turns: tuple[bool, bool]
    """Whether `moved` and `by` are angles."""
    sides: tuple[sp.Expr, sp.Expr]
    """The signs of the derivatives of the equation by both, which tell the two solutions for each apart: one is the
    assembly mode, the other the side of the crank."""
    start: Chain
    tip: Chain
    length: sp.Expr
    name: str
    """The name of the joint that it moves."""

    @property
    def vector(self) -> sp.ImmutableMatrix:
        """From the start to the tip."""
        return sp.ImmutableMatrix(pose_of(self.tip).position - pose_of(self.start).position)

    @property
    def equation(self) -> sp.Expr:
        """The closure: the square of the distance, less that of the length."""
        return self.vector.dot(self.vector) - self.length**2


@dataclass(frozen=True)
class Joint(Quantity):
    """One axis: axis value = motor value + offset, joint value = ratio * motor value + coupling."""

    name: str
    kind: Kind
    meaning: str
    multi_turn: bool = False
    """Whether the joint has a period byte in the configuration."""
    offset_range: Interval | None = None
    limit_range: Interval | None = None
    """The vendor's ranges, where the vendor gives them."""
    limits: Interval | None = None
    """The limits of the axis when none are given (degrees or length), of a description of one machine."""
    coupling: sp.Expr = sp.Integer(0)
    """The gear coupling: what the motors of earlier axes add to this joint, linear in their `motor` symbols."""
    ratio: sp.Expr = sp.Integer(1)
    """The joint's turn per turn of its motor, or its travel per unit: a number, or made of parameters; never zero."""
    pitch: sp.Expr = sp.Integer(0)
    """If this is not zero, the joint is always limited (to `limit_range` where no limit is given)."""
    domain: Interval | None = None
    """The range that the closure allows (degrees or length), which is documented for the axis; None: any value."""
    nominal: float = 0.0
    loops: tuple[Loop, ...] = ()
    """The loops between the motor and the joint, that of the motor first: the joint value then follows from these."""
    free: bool = False
    """Whether no motor moves the joint, and any value of it is as good: it has no axis, and is zero at given axes."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "coupling", sp.sympify(self.coupling))
        object.__setattr__(self, "pitch", sp.sympify(self.pitch))
        object.__setattr__(self, "ratio", sp.sympify(self.ratio))
        if self.kind is Kind.ROTARY and not self.ratio.is_Integer:
            object.__setattr__(self, "kind", Kind.GEARED)

    @property
    def key(self) -> str:
        """The lower-case name, with which `offset_a1` and `lower_a1` end."""
        return self.name.lower()

    @property
    def moved_name(self) -> str:
        """The name of what the chain has: of a joint that loops move, not of its actuator."""
        return self.loops[-1].name if self.loops else self.name

    @property
    def shown(self) -> float:
        """The axis value at which the machine is shown: the nominal one, or the limit next to it if that is beyond."""
        lower, upper = self.limits or (self.nominal, self.nominal)
        return float(min(max(self.nominal, lower), upper))

    @property
    def motor(self) -> sp.Symbol:
        """The motor value: axis value less offset. Without gear coupling it is the joint value."""
        return real(f"motor_{self.key}")

    @property
    def is_angle(self) -> bool:
        """Whether the joint turns: its value is an angle, of which sines and cosines are taken."""
        return self.loops[-1].turns[0] if self.loops else self.kind not in (Kind.LINEAR, Kind.DRIVING)

    @property
    def axis_is_angle(self) -> bool:
        """Whether its axis turns: a cylinder may move an angle."""
        return self.in_degrees if self.loops else self.is_angle

    @property
    def in_degrees(self) -> bool:
        """Whether axis values are degrees."""
        return self.kind is not Kind.LINEAR

    @property
    def is_geared(self) -> bool:
        """Whether one unit of the motor moves the joint by more or less than one unit."""
        return bool(self.ratio != 1)

    @property
    def unit(self) -> sp.Expr:
        """One unit of the axis value in units of the motor value."""
        return DEGREE if self.in_degrees else sp.Integer(1)

    @property
    def turns(self) -> sp.Expr:
        """The turns of the joint per turn of its axis, as a positive number, or as a constant of the setup."""
        return sp.Abs(self.ratio) if self.ratio.is_number else real(f"turns_{self.key}")

    @property
    def sense(self) -> sp.Expr:
        """+1, or -1 where the joint turns against its axis: a number, or a constant of the setup."""
        return sp.sign(self.ratio) if self.ratio.is_number else real(f"sense_{self.key}")

    @property
    def axis(self) -> sp.Symbol:
        """The axis value as the controller has it (degrees or user's length unit)."""
        return real(f"axis_{self.key}")

    @property
    def reference(self) -> sp.Symbol:
        """The reference value of the axis."""
        return real(f"ref_{self.key}")

    @property
    def speed(self) -> sp.Symbol:
        """The speed of the axis, in radians or the user's length unit per time."""
        return real(f"speed_{self.key}")

    @property
    def turn(self) -> sp.Symbol:
        """The commanded period number; 0: none is commanded."""
        return count(f"turn_{self.key}")

    @property
    def offset(self) -> sp.Symbol:
        """The parameter `offset_…`: the axis value at joint value zero."""
        return real(f"offset_{self.key}")


class JointDetails(TypedDict, total=False):
    """What a description may add to a joint; see `Joint`."""

    offset_range: Interval
    limit_range: Interval
    limits: Interval
    coupling: sp.Expr
    ratio: sp.Expr
    pitch: sp.Expr
    domain: Interval
    nominal: float


def rotary(name: str, meaning: str, *, value: str | None = None, **details: Unpack[JointDetails]) -> Joint:
    """A rotary joint with a period byte: its type allows more than 360 degrees.

    `value` is what equations call the joint's value, where a length of the machine has the axis' name.
    """
    return Joint(_joint_symbol(value or name), name, Kind.ROTARY, meaning, multi_turn=True, **details)


def arc(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A rotary joint that never turns round: no period byte."""
    return Joint(_joint_symbol(name), name, Kind.ROTARY, meaning, multi_turn=False, **details)


def helical(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A joint that turns and moves another axis along by its pitch: declared Linear, values in degrees."""
    return Joint(_joint_symbol(name), name, Kind.HELICAL, meaning, multi_turn=True, **details)


def driving(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A turning motor that moves lengths alone: declared Linear, values in degrees."""
    return Joint(_joint_symbol(name), name, Kind.DRIVING, meaning, **details)


def linear(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A linear joint."""
    return Joint(_joint_symbol(name), name, Kind.LINEAR, meaning, **details)


def _joint_symbol(name: str) -> sp.Symbol:
    """The joint value's symbol; x, y and z are taken by the pose."""
    key = name.lower()
    return real(f"joint_{key}" if key in COORDINATE_NAMES else key)


def notes_of(held: Sequence[str], surplus: Sequence[str], passive: str) -> Iterator[str]:
    """The notes of every machine with joints that its inverse leaves where they are, with surplus rods (the names of
    their lengths), or with coordinates that nobody commands.
    """
    if held:
        them = "it" if len(held) == 1 else "them"
        yield (
            f"{' and '.join(held)} {'is' if len(held) == 1 else 'are'} held: inverse kinematics leaves {them} where "
            f"the reference has {them} (aRef in a block), and solves for the other axes. Margins tell how far these "
            "are from a singular pose; the Jacobian has a column for every axis."
        )
    if surplus:
        yield (
            f"Surplus: {', '.join(surplus)}. The other rods hold the pose: forward kinematics takes them, and refuses "
            "axes at which a surplus one misses by more than max_miss. Its miss is a row of the Jacobian: command zero "
            "for it."
        )
    for name in passive:
        yield (
            f"{name} is not commanded: the axes decide it. Inverse kinematics does not read it, and forward kinematics "
            "reports it."
        )
