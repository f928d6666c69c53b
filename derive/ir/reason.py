"""Why a program refuses, as data: what is at fault, what is wrong with it, how much is missing, and in which unit.

    Require(distance <= 1e-6 machine_scale, UNREACHABLE, reason=Reason(z, OUT_OF_PLANE, distance - 1e-6 machine_scale,
    LENGTH)) →  "z: a planar machine has none [u]", with the amount

An amount is computed where the program refuses, and nowhere else: a value that only the amount needs is written out in
it (see `passes`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum, unique

import sympy as sp


class Unit(Enum):
    """The unit of an amount, as a message has it."""

    NONE = ""
    LENGTH = "u"
    ANGLE = "deg"


class Kind(Enum):
    """What a subject is."""

    JOINT = "joint"
    """Its name is that of the joint value; the code that writes the message knows the axis."""
    QUANTITY = "quantity"
    LEG = "leg"
    INPUT = "input"
    PARAMETERS = "parameters"
    """Its name states the condition that the parameters must satisfy."""
    MACHINE = "machine"


@dataclass(frozen=True)
class Subject:
    """What is at fault."""

    kind: Kind
    name: str = ""


@unique
class Why(Enum):
    """What is wrong with a subject: a sentence with a place for its name."""

    NOT_GIVEN = "not given: {}"
    REQUIRED = "{}"
    COLUMNS_UNEVEN = "columns not of length one; was the frame converted from REAL?"
    COLUMNS_ASKEW = "columns not at right angles; was the frame converted from REAL?"
    OPPOSITE = "the tool points exactly the opposite way"
    ACROSS = "the tool points across the plane in which the arm can turn it"
    OUT_OF_PLANE = "{}: a planar machine has none"
    NOT_MOVED = "{}: no axis moves it, and it is not where the machine has it"
    OUT_OF_REACH = "{}: out of reach"
    CANNOT_REACH = "{} cannot reach"
    TOO_SHORT = "{}: its effective length is too short"
    SLIDE_ACROSS = "{}: its slide points across the way that it has to go"
    WITHOUT_LENGTH = "{}: without length it has no direction"
    BEYOND_BASE_CONE = "{}: its joint on the base bends beyond its cone"
    BEYOND_PLATE_CONE = "{}: its joint on the plate bends beyond its cone"
    BEYOND_LARGEST_ANGLE = "{}: beyond its largest angle"
    TOO_LARGE = "{}: too large"
    NEAR_TYPE_2 = "{}: in the other assembly mode, or too close to a type 2 singularity"
    FIRST_CROSSING_ONLY = "without an offset, only the first branch of the crossing has a solution"
    NO_ROOT = "{}: the search along it finds no root of this branch"
    BELOW = "{}: below its lower limit"
    ABOVE = "{}: above its upper limit"
    OTHER_ASSEMBLY = "the other assembly mode"
    OTHER_MIRROR = "the mirror that the machine does not have"
    NO_POSE = "{} where the machine has no pose"
    LOOP_OPEN = "{}: its loop does not close"
    RODS_APART = "the rods do not meet"
    CENTRES_ON_A_LINE = "the centres coincide or lie on a line: nothing holds the plate"
    PUSHES = "{}: it would have to push, by this share of the load"
    NONE_PULLS = "one of the cables would have to push, by this share of the load"
    MISSES = "{}: it misses the pose that the other axes give"
    UNCONTROLLED = "nothing controls the plate"
    NOT_FOUND_AGAIN = "forward kinematics from the home pose does not find this pose again"
    TRUE_MACHINE = "the machine as measured does not reach it on this branch"
    NOT_CONVERGED = "Newton's method does not find the pose"
    DRIVE_LIMITS_CROSSED = "the lower limit of the drive is above the upper one, or one of them is no number"
    NO_AXIS_VALUE = "no axis value is inside both limits"
    TURNS_WITH_THE_FLANGE = "a part of the end point turns with the flange"

    def of(self, subject: str) -> str:
        """The sentence about a subject."""
        return self.value.format(subject)

    @property
    def is_about_a_subject(self) -> bool:
        """Whether the sentence starts with its subject, so that it reads the same for another subject."""
        return self.value.startswith("{}: ")


@dataclass(frozen=True)
class OtherTurn:
    """An axis that is not between the largest of `lowest` and the smallest of `highest`, and may be on another turn."""

    name: str
    axis: sp.Expr
    lowest: tuple[sp.Expr, ...]
    highest: tuple[sp.Expr, ...]

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        """The values that the search for another turn needs."""
        return (self.axis, *self.lowest, *self.highest)

    def rewritten(self, change: Callable[[sp.Basic], sp.Expr]) -> OtherTurn:
        """A copy in which every expression is changed."""
        ends = (tuple(map(change, end)) for end in (self.lowest, self.highest))
        return OtherTurn(self.name, change(self.axis), *ends)


@dataclass(frozen=True)
class Reason:
    """Why a condition refuses."""

    subject: Subject
    why: Why
    amount: sp.Expr | None = None
    """How much is missing where the condition does not hold; None if that is no quantity."""
    unit: Unit = Unit.NONE
    turns: tuple[OtherTurn, ...] = ()
    """The axes that may be inside on another turn, where a limit refuses: the first that is gives the reason."""

    @property
    def expressions(self) -> Iterator[sp.Expr]:
        """What is computed where the program refuses."""
        if self.amount is not None:
            yield self.amount
        for turn in self.turns:
            yield from turn.expressions

    @property
    def words(self) -> str:
        """The sentence, with the subject by its own name."""
        return self.why.of(self.subject.name)

    def rewritten(self, change: Callable[[sp.Basic], sp.Expr]) -> Reason:
        """A copy in which every expression is changed."""
        amount = None if self.amount is None else change(self.amount)
        if amount is self.amount and not self.turns:
            return self
        return replace(self, amount=amount, turns=tuple(turn.rewritten(change) for turn in self.turns))


def about_joint(joint: sp.Symbol, why: Why, amount: sp.Expr | None = None, unit: Unit = Unit.NONE) -> Reason:
    """A reason about a joint, by its value."""
    return Reason(Subject(Kind.JOINT, joint.name), why, amount, unit)


def about(quantity: str, why: Why, amount: sp.Expr | None = None, unit: Unit = Unit.NONE) -> Reason:
    """A reason about a quantity, by what it is called."""
    return Reason(Subject(Kind.QUANTITY, quantity), why, amount, unit)


def about_leg(rod: str, why: Why, amount: sp.Expr | None = None, unit: Unit = Unit.NONE) -> Reason:
    """A reason about a leg, by the name of its rod."""
    return Reason(Subject(Kind.LEG, f"leg {rod}"), why, amount, unit)


def about_machine(why: Why) -> Reason:
    """A reason about the machine as a whole."""
    return Reason(Subject(Kind.MACHINE), why)


def about_input(why: Why, given: str = "", amount: sp.Expr | None = None) -> Reason:
    """A reason about what a caller gives, by what it should be."""
    return Reason(Subject(Kind.INPUT, given), why, amount)


def about_parameters(needed: str) -> Reason:
    """What the parameters must be."""
    return Reason(Subject(Kind.PARAMETERS, needed), Why.REQUIRED)
