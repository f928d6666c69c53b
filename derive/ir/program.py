"""The intermediate representation: straight-line, total programs over numbers and flags.

A program binds names (`Let`), sets a status (`Require`) and ends in outputs. Values are SymPy
expressions over a closed set of primitives, each of a type (`types`), so that a printer is all that a language needs.
Every `Let` is defined for any finite input: a `Require` protects nothing, it only decides the status.
It can therefore be printed as an early return (Structured Text, scalar Python) or as a mask (NumPy).

Angles are in radians inside a program; axis values, references and limits are in degrees and the
user's length unit. `DEGREE` (pi/180) is the one conversion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from math import isqrt

import sympy as sp
from sympy.logic.boolalg import Boolean

from derive.ir.reason import Reason
from derive.ir.symbols import PLACE, is_decided, names_in


class Status(Enum):
    """The outcome of a call, by its SoftMotion enumerator."""

    OK = "SMC_NO_ERROR"
    NOT_INITIALIZED = "SMC_TRAFO_NOT_INITIALIZED"
    BAD_INPUT = "SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"
    UNREACHABLE = "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"
    IMPOSSIBLE = "SMC_TRAFO_INVALID_CONSTELLATION"
    INVALID_COUPLING = "SMC_TRAFO_INVALID_COUPLING"


@dataclass(frozen=True)
class Let:
    """Bind `name` to `value`. `note` names the step of the derivation, for the reader."""

    name: sp.Symbol
    value: sp.Basic
    """The value of a number, or the condition of a flag."""
    note: str = ""
    turn_of: str = ""
    """The axis whose whole turns the value chooses; empty where it chooses none."""

    @property
    def comment(self) -> str:
        """The comment for the reader of the generated code."""
        turn = f"{self.turn_of}: whole turns added" if self.turn_of else ""
        return "; ".join(text for text in (self.note, turn) if text)


@dataclass(frozen=True)
class Require:
    """Set the status `otherwise` where `condition` does not hold. Conditions are positive: NaN fails them."""

    condition: Boolean
    otherwise: Status
    note: str = ""
    reason: Reason | None = None
    """The reason that a caller gets; None where it gets the status alone."""

    @property
    def comment(self) -> str:
        """The comment for the reader of the generated code: the note, or else the reason."""
        return self.note or (self.reason.words if self.reason is not None else "")


@dataclass(frozen=True)
class Solve:
    """Bind `names` to matrix^-1 right, by LU decomposition with partial pivoting.

    Total: determinant and solution are zeros where the matrix is singular, or a number is NaN or larger than
    `SOLVABLE`.

    All three are given by rows. The matrix is square; `names` and `right` have a column for each right-hand side, and
    none where only the determinant is wanted.
    """

    names: tuple[sp.Symbol, ...]
    matrix: tuple[sp.Expr, ...]
    right: tuple[sp.Expr, ...] = ()
    determinant: sp.Symbol | None = None
    note: str = ""

    @property
    def size(self) -> int:
        """The number of rows of the matrix."""
        return isqrt(len(self.matrix))

    @property
    def columns(self) -> int:
        """The number of right-hand sides."""
        return len(self.right) // self.size


@dataclass(frozen=True)
class Iterate:
    """Repeat `step` from `start` until `done` holds, at most `limit` times; else the status is `otherwise`, if there is
    one.

    Every pass evaluates the step at the state. Then the loop ends, or the state becomes `following`. So the names of
    the step are bound behind the loop, too, and belong to the final state.
    """

    state: tuple[sp.Symbol, ...]
    start: tuple[sp.Expr, ...]
    step: tuple[Let | Solve, ...]
    following: tuple[sp.Expr, ...]
    """Each may read its own state and the names of the step, but no other state: the order of assignment is free."""
    done: Boolean
    limit: int
    otherwise: Status | None
    note: str = ""
    reason: Reason | None = None
    """The reason given to a caller where `done` never holds; it has no amount."""


@dataclass(frozen=True)
class Call:
    """Run a program that several programs share, and bind names of its outputs; where it refuses, so does the caller.

    given: the values of the arguments. The other inputs of the shared program are constants of the machine, which are
    inputs of the caller, too. Where `wanted` does not hold the program is not run, and the names are bound to false
    and zeros.
    """

    program: Program
    given: tuple[tuple[sp.Symbol, sp.Expr], ...]
    names: tuple[sp.Symbol, ...]
    """The outputs that the caller reads; all others are dropped."""
    note: str = ""
    wanted: Boolean = sp.true
    refusal: tuple[Status, Reason] | None = None
    """The status and the reason of the caller where the shared program refuses; None: the status of that program."""

    @property
    def is_conditional(self) -> bool:
        """Whether the program is run under a condition."""
        return not is_decided(self.wanted)

    @property
    def is_rare(self) -> bool:
        """Whether few poses run the program: a call with a refusal of its own is a check that every pose passes."""
        return self.is_conditional and self.refusal is None

    @property
    def arguments(self) -> tuple[sp.Expr, ...]:
        """The values of the arguments, in the order of the shared program's inputs."""
        values = dict(self.given)
        return tuple(values[s] for s in self.program.inputs if s in values)

    @property
    def constants(self) -> tuple[sp.Symbol, ...]:
        """The inputs of the shared program besides its arguments."""
        arguments = {name for name, _ in self.given}
        return tuple(s for s in self.program.inputs if s not in arguments)


@dataclass(frozen=True)
class FindRoot:
    """Bind `names` to true and the outputs of `finish` at the root of `trial` that fits and is nearest to `start` on
    the circle.

    A trial is a function of `TRIED`, with the two-root step on the wanted side (`SIDE` = 1) or the other (-1), and the
    angle of the step with the number `FREED` set to `FREED_ANGLE` (-1: no step). Its outputs are the residual with its
    slope, the guard, which is negative where there is no solution, with its slope, then cosine and sine of every angle
    that may be free. `finish` has the same arguments; its first output tells whether the root is on the wanted
    branch. `roots` says how roots are found. Where there is none, or `wanted` is false, the names are bound to false
    and zeros.

    Where candidates for the roots are known in closed form, nothing is tried: `trial` lists them. Its outputs are, for
    each of `sides`, a joint value, and whether it is a candidate on this side.
    """

    trial: Program
    finish: Program
    start: sp.Expr
    wanted: Boolean
    names: tuple[sp.Symbol, ...]
    arguments: tuple[sp.Symbol, ...]
    """The arguments of both programs besides the place; their other inputs are constants of the machine."""
    note: str = ""
    sides: tuple[int, ...] = ()
    """The side of each listed candidate; empty where a trial is scanned."""

    @property
    def is_listed(self) -> bool:
        """Whether the trial lists candidates for its roots, and nothing is scanned."""
        return bool(self.sides)

    def given(self, program: Program) -> tuple[sp.Symbol, ...]:
        """The arguments of one of the programs, in the order of its inputs."""
        return tuple(s for s in program.inputs if s in self.arguments or s in PLACE)


Statement = Let | Require | Solve | Iterate | Call | FindRoot


@dataclass(frozen=True)
class Output:
    """A named result, which is written only on success."""

    name: str
    value: sp.Expr


@dataclass(frozen=True)
class Program:
    """A straight-line program: its inputs, its statements, its outputs."""

    name: str
    inputs: tuple[sp.Symbol, ...]
    body: tuple[Statement, ...]
    outputs: tuple[Output, ...]
    summary: str = ""
    """A sentence that explains a shared program, where its name does not suffice."""

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
        """Every free symbol that a statement, its reason or an output reads."""
        used: set[sp.Symbol] = set()
        for statement in self.body:
            used |= reads(statement).union(*map(names_in, reason_expressions(statement)))
        for output in self.outputs:
            used |= names_in(output.value)
        return frozenset(used) - set(self.bound())

    @property
    def refuses(self) -> bool:
        """Whether a statement may end the program."""
        loops = (s for s in self.body if isinstance(s, Iterate))
        return any(isinstance(s, Require | Call) for s in self.body) or any(s.otherwise is not None for s in loops)


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
    """The expressions of a statement, in the order of their evaluation, without those of its reason."""
    if isinstance(statement, Let):
        yield statement.value
    elif isinstance(statement, Require):
        yield statement.condition
    elif isinstance(statement, Solve):
        yield from (*statement.matrix, *statement.right)
    elif isinstance(statement, Call):
        yield from (statement.wanted, *(value for _, value in statement.given))
    elif isinstance(statement, FindRoot):
        yield from (statement.start, statement.wanted)
    else:
        yield from statement.start
        for inner in statement.step:
            yield from expressions(inner)
        yield from (statement.done, *statement.following)


def reason_expressions(statement: Statement) -> Iterator[sp.Expr]:
    """The expressions that are computed where a statement refuses, and nowhere else."""
    if isinstance(statement, Require) and statement.reason is not None:
        yield from statement.reason.expressions


def reads(statement: Statement) -> set[sp.Symbol]:
    """The symbols that a statement reads and does not bind itself, without those of its reason."""
    if isinstance(statement, Let):
        return set(names_in(statement.value))
    found = set[sp.Symbol]().union(*map(names_in, expressions(statement)))
    if isinstance(statement, Call):
        return found | set(statement.constants)
    if isinstance(statement, FindRoot):
        return found | {s for p in (statement.trial, statement.finish) for s in p.inputs}.difference(PLACE)
    return found - set(binds(statement)) if isinstance(statement, Iterate) else found


def shared(programs: Iterable[Program]) -> tuple[Program, ...]:
    """The shared programs that the given programs call, each once and before its callers."""
    found: dict[str, Program] = {}
    for statement in (s for program in programs for s in program.body):
        called = [statement.program] if isinstance(statement, Call) else []
        called += [statement.trial, statement.finish] if isinstance(statement, FindRoot) else []
        found |= {inner.name: inner for program in called for inner in (*shared([program]), program)}
    return tuple(found.values())


def rewritten(statement: Statement, change: Callable[[sp.Basic], sp.Basic]) -> Statement:
    """The statement with every expression changed, in its reason as well; the names that it binds stay."""
    if isinstance(statement, Let):
        value = change(statement.value)
        return statement if value is statement.value else replace(statement, value=value)
    if isinstance(statement, Require):
        reason = None if statement.reason is None else statement.reason.rewritten(change)
        condition = change(statement.condition)
        is_same = condition is statement.condition and reason is statement.reason
        return statement if is_same else replace(statement, condition=condition, reason=reason)
    if isinstance(statement, Solve):
        return replace(
            statement, matrix=tuple(map(change, statement.matrix)), right=tuple(map(change, statement.right))
        )
    if isinstance(statement, Call):
        given = tuple((name, change(value)) for name, value in statement.given)
        return replace(statement, given=given, wanted=change(statement.wanted))
    if isinstance(statement, FindRoot):
        return replace(statement, start=change(statement.start), wanted=change(statement.wanted))
    return replace(
        statement,
        start=tuple(map(change, statement.start)),
        step=tuple(s for s in (rewritten(s, change) for s in statement.step) if isinstance(s, Let | Solve)),
        following=tuple(map(change, statement.following)),
        done=change(statement.done),
    )
