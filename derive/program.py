"""The intermediate representation: straight-line, total programs over real numbers.

A program binds names (`Let`), sets a status (`Require`) and ends in outputs. Values are SymPy
expressions over a closed set of primitives, so that every language needs one printer and nothing else.
Every `Let` is defined for any finite input: a `Require` protects nothing, it only decides the status.
It can therefore be printed as an early return (Structured Text, scalar Python) or as a mask (NumPy).

Angles are in radians inside a program; axis values, references and limits are in degrees and the
user's length unit. `DEGREE` (pi/180) is the one conversion.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import sympy as sp
from sympy.logic.boolalg import Boolean

DEGREE = sp.Symbol("DEGREE", positive=True)
"""One degree in radians: a named constant of every language."""

# The numerical constants of the product. Each stands here once and nowhere else.
FREE_ANGLE = sp.Float("1e-11")
"""A scaled measure at or below this leaves its angle free, and a branch byte reads 3."""
BOUNDARY = sp.Float("1e-12")
"""A normalised radicand negative by at most this is zero: the boundary belongs to the workspace."""
LARGEST = sp.Integer(10) ** 9
"""Inputs larger in size than this are refused."""
ROTATION = sp.Float("1e-6")
"""How far the product of a rotation with its transpose may be from the identity."""
PLANE = sp.Float("1e-6")
"""How far a planar machine's commanded z may be from its plane, per unit of reach."""
LIMIT = sp.Float("1e-9")
"""Relative tolerance of an axis limit."""
SHORTEST_LINK = sp.Float("1e-9")
"""An effective link shorter than this fraction of the machine's scale cannot be aimed."""
SINGULAR = sp.Float("1e-3")
"""A pose is singular where a margin is smaller than this in size."""
TIE = sp.Float("1e-6")
"""An automatic choice takes a later branch only where its squared distance is smaller by more than this."""
EDGE = sp.Float("1e-9")
"""How far (degrees) the intervals of the periods are shifted down: see `NearestPeriod`."""
UNLIMITED = sp.Integer(10) ** 12
"""Stands for "no limit": beyond anything an input can be."""


class Status(Enum):
    """The outcome of a call, by its SoftMotion enumerator."""

    OK = "SMC_NO_ERROR"
    NOT_INITIALIZED = "SMC_TRAFO_NOT_INITIALIZED"
    BAD_INPUT = "SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"
    UNREACHABLE = "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"
    IMPOSSIBLE = "SMC_TRAFO_INVALID_CONSTELLATION"
    INVALID_COUPLING = "SMC_TRAFO_INVALID_COUPLING"


class Root(sp.Function):
    """root(x) = sqrt(max(0, x)): total."""

    nargs = 1


class Atan2(sp.Function):
    """atan2(y, x) in radians, in (-pi, pi]; atan2(0, 0) = 0."""

    nargs = 2


class Select(sp.Function):
    """select(condition, a, b): a where the condition holds, else b; both are evaluated."""

    nargs = 3

    @classmethod
    def eval(cls, condition: Boolean, first: sp.Expr, second: sp.Expr) -> sp.Expr | None:
        """A choice between equals is none."""
        return first if first == second else None


class NearestPeriod(sp.Function):
    """nearest_period(value, centre): value + 360 k in [centre - 180, centre + 180), in degrees.

    The interval is shifted down by 1e-9 degrees, so that a value on an edge stays on its side in
    spite of rounding: forward kinematics numbers the turns with the same shift.
    """

    nargs = 2


class NearestOnArc(sp.Function):
    """nearest_on_arc(angle, centre, half): the angle of the arc centre ± half nearest to angle (radians)."""

    nargs = 3


PRIMITIVES: tuple[type[sp.Function], ...] = (
    sp.sin,
    sp.cos,
    sp.Abs,
    Root,
    Atan2,
    Select,
    NearestPeriod,
    NearestOnArc,
)


@dataclass(frozen=True)
class Let:
    """Bind `name` to `value`. `note` names the step of the derivation, for the reader."""

    name: sp.Symbol
    value: sp.Expr
    note: str = ""


@dataclass(frozen=True)
class Require:
    """Set the status `otherwise` where `condition` does not hold. Conditions are positive: NaN fails them."""

    condition: Boolean
    otherwise: Status
    note: str = ""


Statement = Let | Require


@dataclass(frozen=True)
class Output:
    """A named result, written only on success."""

    name: str
    value: sp.Expr


@dataclass(frozen=True)
class Program:
    """A straight-line program: the free names it may read, its statements, its outputs."""

    name: str
    inputs: tuple[sp.Symbol, ...]
    body: tuple[Statement, ...]
    outputs: tuple[Output, ...]

    def lets(self) -> tuple[Let, ...]:
        """The bindings, in order."""
        return tuple(s for s in self.body if isinstance(s, Let))

    def requires(self) -> tuple[Require, ...]:
        """The conditions, in order."""
        return tuple(s for s in self.body if isinstance(s, Require))

    def reads(self) -> frozenset[sp.Symbol]:
        """Every free symbol that a statement or an output reads."""
        used: set[sp.Symbol] = set()
        for statement in self.body:
            used |= reads(statement)
        for output in self.outputs:
            used |= symbols_of(output.value)
        return frozenset(used) - {let.name for let in self.lets()}


def real(name: str) -> sp.Symbol:
    """The real symbol of that name: the one way to make a name that a program reads or binds."""
    return sp.Symbol(name, real=True)


def symbols_of(expression: sp.Basic) -> set[sp.Symbol]:
    """The free symbols of an expression, without the named constant."""
    return {s for s in expression.free_symbols if isinstance(s, sp.Symbol)} - {DEGREE}


def reads(statement: Statement) -> set[sp.Symbol]:
    """The symbols a statement reads."""
    return symbols_of(statement.value if isinstance(statement, Let) else statement.condition)

