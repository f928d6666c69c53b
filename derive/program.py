"""The intermediate representation: straight-line, total programs over real numbers.

A program binds names (`Let`), sets a status (`Require`) and ends in outputs. Values are SymPy
expressions over a closed set of primitives, so that every language needs one printer and nothing else.
Every `Let` is defined for any finite input: a `Require` protects nothing, it only decides the status.
It can therefore be printed as an early return (Structured Text, scalar Python) or as a mask (NumPy).

Angles are in radians inside a program; axis values, references and limits are in degrees and the
user's length unit. `DEGREE` (pi/180) is the one conversion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from math import isqrt

import sympy as sp
from sympy.logic.boolalg import Boolean

DEGREE = sp.Symbol("DEGREE", positive=True)
"""One degree in radians: a named constant of every language."""

# The numerical constants of the product. Each stands here once and nowhere else.
FREE_ANGLE = sp.Float("1e-11")
"""A scaled measure at or below this leaves its angle free, and a branch byte reads 3."""
KNOWN_ANGLE = sp.Float("0.1")
"""A scaled measure above this gives its angle to 1e-15, so that hardly anything can be made of moving it."""
OUT_OF_REACH = sp.Float("1e-9")
"""What is beyond its bound by more than this share is not reached by moving an angle that is known."""
BOUNDARY = sp.Float("1e-12")
"""A normalised radicand negative by at most this is zero: the boundary belongs to the workspace."""
FOLD = sp.Float("1e-6")
"""A radicand below this share of the machine's squared length is near enough to zero for its root to multiply rounding."""
ROUNDING = sp.Float("1e-12")
"""A motion of the pose smaller than this share of the machine is rounding."""
INSIDE = sp.Float("1e-7")
"""An angle that is moved to where a later step reaches is moved inside of its boundary by this share, where that is free."""
LARGEST = sp.Integer(10) ** 9
"""Inputs larger in size than this are refused."""
ROTATION = sp.Float("1e-4")
"""How far the product of a rotation with its transpose may be from the identity: frames come from single precision, too."""
EXACT_ROTATION = sp.Float("1e-12")
"""A rotation nearer to one than this is used as it is; one that is further away is repaired."""
PLANE = sp.Float("1e-6")
"""How far a planar machine's commanded z may be from its plane, per unit of reach."""
LIMIT = sp.Float("1e-9")
"""Relative tolerance of an axis limit."""
SHORTEST_LINK = sp.Float("1e-9")
"""An effective link shorter than this fraction of the machine's scale cannot be aimed."""
HELD = sp.Float("1e-9")
"""A shift up to this share of all shifts may turn with a flange unnoticed; and axes this far apart are one."""
SINGULAR = sp.Float("1e-3")
"""A pose is singular where a margin is smaller than this in size."""
PIVOT = sp.Float("1e-14")
"""A matrix is singular where no pivot is larger than this share of its largest entry."""
SOLVABLE = sp.Float("1e30")
"""Linear equations are solved where all their numbers are at most this size, and the largest at least its reciprocal."""
CONVERGED = sp.Float("1e-11")
"""An iteration has converged where what is left of a length is at most this share of the machine's scale."""
NEARLY = sp.Float("1e-6")
"""A root of a search lies on a branch whose scaled margin it does not miss by more than this, the root of `BOUNDARY`."""
TRIALS = 550
"""Trials of a search for a root, at most."""
FINISHED = 12
"""Roots of a search that are looked at, at most."""
MET = sp.Float("1e-10")
"""A root of a search meets the pose: what is left is at most this share of the machine, and so many radians."""
IMPROVEMENTS = 3
"""Steps of Newton's method that improve a root of a search, at most."""
TIE = sp.Float("1e-6")
"""An automatic choice takes a later branch only where its squared distance (degrees) is smaller by more than this."""
TIE_SHARE = sp.Float("1e-6")
"""Of linear axes, only where it is smaller by more than the square of this share of the machine's scale."""
ONE_TURN = sp.Integer(350)
"""An axis has one value inside its limits where they are at most this far apart (degrees): no step of a path crosses the gap."""
EDGE = sp.Float("1e-9")
"""How far (degrees) the intervals of the periods are shifted down: see `NearestPeriod`."""
UNLIMITED = sp.Integer(10) ** 12
"""Stands for "no limit": beyond anything an input can be."""


TURN_NOTE = ": its turn"
"""How the note ends of a statement that chooses the turn of an axis."""


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
    is_nonnegative = True


class Atan2(sp.Function):
    """atan2(y, x) in radians, in (-pi, pi]; atan2(0, 0) = 0."""

    nargs = 2


class Select(sp.Function):
    """select(condition, a, b): a where the condition holds, else b; both are evaluated."""

    nargs = 3
    is_real = True

    @classmethod
    def eval(cls, condition: Boolean, first: sp.Expr, second: sp.Expr) -> sp.Expr | None:
        """A choice between equals is none, nor one that is decided."""
        if condition in (sp.true, sp.false):
            return first if condition == sp.true else second
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


@dataclass(frozen=True)
class Solve:
    """Bind `names` to matrix^-1 right, by LU decomposition with partial pivoting.

    Total: the determinant and the solution are zeros where the matrix is singular, or a number is none or beyond `SOLVABLE`.

    All three by rows: the matrix is square, `names` and `right` have as many columns as there are right-hand sides,
    which may be none where the determinant alone is wanted.
    """

    names: tuple[sp.Symbol, ...]
    matrix: tuple[sp.Expr, ...]
    right: tuple[sp.Expr, ...] = ()
    determinant: sp.Symbol | None = None
    note: str = ""

    @property
    def size(self) -> int:
        """How many rows the matrix has."""
        return isqrt(len(self.matrix))

    @property
    def columns(self) -> int:
        """How many right-hand sides there are."""
        return len(self.right) // self.size


@dataclass(frozen=True)
class Iterate:
    """Repeat `step` from `start` until `done` holds, at most `limit` times; status `otherwise` where it never does.

    Every pass evaluates the step at the state; then it is done, or the state becomes `following`. So the names of the
    step are bound behind the loop, too: where it was done, they belong to the final state.
    """

    state: tuple[sp.Symbol, ...]
    start: tuple[sp.Expr, ...]
    step: tuple[Let | Solve, ...]
    following: tuple[sp.Expr, ...]
    """Each may read its own state and the names of the step, but no other state: the order of assignment is free."""
    done: Boolean
    limit: int
    otherwise: Status
    note: str = ""


@dataclass(frozen=True)
class Call:
    """Run a program that several programs share, and bind names of its outputs; where it refuses, so does the caller.

    `given` are the values of its arguments. What else it reads is a constant of the machine: an input of the caller, too.
    """

    program: Program
    given: tuple[tuple[sp.Symbol, sp.Expr], ...]
    names: tuple[sp.Symbol, ...]
    """The outputs that the caller reads: the values of the others are dropped."""
    note: str = ""

    @property
    def arguments(self) -> tuple[sp.Expr, ...]:
        """The values of the arguments, in the order of the shared program's inputs."""
        values = dict(self.given)
        return tuple(values[s] for s in self.program.inputs if s in values)

    @property
    def constants(self) -> tuple[sp.Symbol, ...]:
        """What the shared program reads besides its arguments."""
        arguments = {name for name, _ in self.given}
        return tuple(s for s in self.program.inputs if s not in arguments)


@dataclass(frozen=True)
class FindRoot:
    """Bind `names` to 1 and the outputs of `finish` at the root of `trial` that fits and is nearest to `start` on the circle.

    A trial is a function of `TRIED`, on the wanted side of a two-root step (`SIDE` +1) or the other (-1), with the partial step
    of the number `FREED` given by `FREED_ANGLE` instead (-1: none). Its outputs are the value that must vanish, its slope, a
    guard that is negative where there is no solution, its slope, then cosine and sine of the angle of every partial step.
    `finish` has the same arguments; its first output is 1 where the root is wanted, else 0. See `roots` for how roots are
    found. Where there is none, or `wanted` does not hold so that none is looked for, the names are bound to zeros.
    """

    trial: Program
    finish: Program
    start: sp.Expr
    wanted: Boolean
    names: tuple[sp.Symbol, ...]
    arguments: tuple[sp.Symbol, ...]
    """What both programs are given besides the place; all else that they read is a constant of the machine."""
    note: str = ""

    def given(self, program: Program) -> tuple[sp.Symbol, ...]:
        """The arguments of one of the programs, in the order of its inputs."""
        return tuple(s for s in program.inputs if s in self.arguments or s in PLACE)


Statement = Let | Require | Solve | Iterate | Call | FindRoot
TRIED, SIDE, FREED, FREED_ANGLE = (sp.Symbol(n, real=True) for n in ("tried", "side", "freed", "freed_angle"))
PLACE = (TRIED, SIDE, FREED, FREED_ANGLE)
"""Where a trial is made: see `FindRoot`."""


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
    summary: str = ""
    """What it does, where its name does not say it: of a shared program."""

    def lets(self) -> tuple[Let, ...]:
        """The bindings, in order."""
        return tuple(s for s in self.body if isinstance(s, Let))

    def requires(self) -> tuple[Require, ...]:
        """The conditions, in order."""
        return tuple(s for s in self.body if isinstance(s, Require))

    def bound(self) -> tuple[sp.Symbol, ...]:
        """Every name that a statement binds, in order."""
        return tuple(name for s in self.body for name in binds(s))

    def reads(self) -> frozenset[sp.Symbol]:
        """Every free symbol that a statement or an output reads."""
        used: set[sp.Symbol] = set()
        for statement in self.body:
            used |= reads(statement)
        for output in self.outputs:
            used |= symbols_of(output.value)
        return frozenset(used) - set(self.bound())


def real(name: str) -> sp.Symbol:
    """The real symbol of that name: the one way to make a name that a program reads or binds."""
    return sp.Symbol(name, real=True)


def symbols_of(expression: sp.Basic) -> set[sp.Symbol]:
    """The free symbols of an expression, without the named constant."""
    return set(names_in(expression))


@cache
def names_in(expression: sp.Basic) -> frozenset[sp.Symbol]:
    """The same as a set that stays: asked again and again of the same expressions."""
    return frozenset(s for s in expression.free_symbols if isinstance(s, sp.Symbol)) - {DEGREE}


def binds(statement: Statement) -> tuple[sp.Symbol, ...]:
    """The names a statement binds, in order."""
    if isinstance(statement, Let):
        return (statement.name,)
    if isinstance(statement, Solve):
        return statement.names + (() if statement.determinant is None else (statement.determinant,))
    if isinstance(statement, Iterate):
        return (*statement.state, *(name for s in statement.step for name in binds(s)))
    return statement.names if isinstance(statement, Call | FindRoot) else ()


def expressions(statement: Statement) -> Iterator[sp.Basic]:
    """The expressions of a statement, in the order of their evaluation."""
    if isinstance(statement, Let):
        yield statement.value
    elif isinstance(statement, Require):
        yield statement.condition
    elif isinstance(statement, Solve):
        yield from (*statement.matrix, *statement.right)
    elif isinstance(statement, Call):
        yield from (value for _, value in statement.given)
    elif isinstance(statement, FindRoot):
        yield from (statement.start, statement.wanted)
    else:
        yield from statement.start
        for inner in statement.step:
            yield from expressions(inner)
        yield from (statement.done, *statement.following)


def reads(statement: Statement) -> set[sp.Symbol]:
    """The symbols a statement reads and does not bind itself."""
    found = {s for e in expressions(statement) for s in symbols_of(e)}
    if isinstance(statement, Call):
        return found | set(statement.constants)
    if isinstance(statement, FindRoot):
        return found | {s for p in (statement.trial, statement.finish) for s in p.inputs if s not in PLACE}
    return found - set(binds(statement)) if isinstance(statement, Iterate) else found


def shared(programs: Iterable[Program]) -> tuple[Program, ...]:
    """The programs that these call, each once, and before those that call it."""
    found: dict[str, Program] = {}
    for statement in (s for program in programs for s in program.body):
        called = [statement.program] if isinstance(statement, Call) else []
        called += [statement.trial, statement.finish] if isinstance(statement, FindRoot) else []
        found |= {inner.name: inner for program in called for inner in (*shared([program]), program)}
    return tuple(found.values())


def rewritten(statement: Statement, change: Callable[[sp.Basic], sp.Basic]) -> Statement:
    """The statement with every expression changed; the names it binds stay."""
    if isinstance(statement, Let):
        return replace(statement, value=change(statement.value))
    if isinstance(statement, Require):
        return replace(statement, condition=change(statement.condition))
    if isinstance(statement, Solve):
        return replace(statement, matrix=tuple(map(change, statement.matrix)), right=tuple(map(change, statement.right)))
    if isinstance(statement, Call):
        return replace(statement, given=tuple((name, change(value)) for name, value in statement.given))
    if isinstance(statement, FindRoot):
        return replace(statement, start=change(statement.start), wanted=change(statement.wanted))
    return replace(
        statement,
        start=tuple(map(change, statement.start)),
        step=tuple(s for s in (rewritten(s, change) for s in statement.step) if isinstance(s, Let | Solve)),
        following=tuple(map(change, statement.following)),
        done=change(statement.done),
    )
