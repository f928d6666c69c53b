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
from operator import is_
from typing import Self

import sympy as sp
from sympy.logic.boolalg import Boolean

from derive.ir.reason import Reason
from derive.ir.statement import Common
from derive.ir.symbols import is_decided, names_in


class Status(Enum):
    """The outcome of a call, by its SoftMotion enumerator."""

    OK = "SMC_NO_ERROR"
    NOT_INITIALIZED = "SMC_TRAFO_NOT_INITIALIZED"
    BAD_INPUT = "SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"
    UNREACHABLE = "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"
    IMPOSSIBLE = "SMC_TRAFO_INVALID_CONSTELLATION"
    INVALID_COUPLING = "SMC_TRAFO_INVALID_COUPLING"


@dataclass(frozen=True)
class Let(Common):
    """Bind `name` to `value`. `note` names the step of the derivation, for the reader."""

    expression_fields, name_fields = ("value",), ("name",)
    name: sp.Symbol
    value: sp.Basic
    """The value of a number, or the condition of a flag."""
    note: str = ""
    turn_of: str = ""
    """The axis whose whole turns the value chooses; empty if it chooses none."""

    @property
    def comment(self) -> str:
        """The comment for the reader of the generated code."""
        turn = f"{self.turn_of}: whole turns added" if self.turn_of else ""
        return "; ".join(text for text in (self.note, turn) if text)


@dataclass(frozen=True)
class Require(Common):
    """Set the status `otherwise` where `condition` does not hold. Conditions are positive: NaN fails them."""

    expression_fields, refuses = ("condition",), True
    condition: Boolean
    otherwise: Status
    note: str = ""
    reason: Reason | None = None
    """The reason that a caller gets; None if it gets the status alone."""

    @property
    def comment(self) -> str:
        """The comment for the reader of the generated code: the note, or else the reason."""
        return self.note or (self.reason.words if self.reason is not None else "")


@dataclass(frozen=True)
class Solve(Common):
    """Bind `names` to matrix^-1 right, by LU decomposition with partial pivoting.

    Total: determinant and solution are zeros if the matrix is singular, or a number is NaN or larger than
    `SOLVABLE`.

    All three are given by rows. The matrix is square; `names` and `right` have a column for each right-hand side, and
    none if only the determinant is wanted.
    """

    expression_fields, name_fields = ("matrix", "right"), ("names", "determinant")
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
class Iterate(Common):
    """Repeat `step` from `start` until `done` holds, at most `limit` times; else the status is `otherwise`, if there is
    one.

    Every pass evaluates the step at the state. Then the loop ends, or the state becomes `following`. So the names of
    the step are bound behind the loop, too, and belong to the final state. A program that the step calls may itself
    iterate; if it refuses in any pass, so does the caller.
    """

    expression_fields, name_fields, is_straight = ("start", "step", "done", "following"), ("state", "step"), False
    program_fields = ("step",)
    state: tuple[sp.Symbol, ...]
    start: tuple[sp.Expr, ...]
    step: tuple[Let | Solve | Call, ...]
    following: tuple[sp.Expr, ...]
    """Each may read its own state and the names of the step, but no other state: the order of assignment is free."""
    done: Boolean
    limit: int
    otherwise: Status | None
    note: str = ""
    reason: Reason | None = None
    """The reason given to a caller where `done` never holds; it has no amount."""

    @property
    def refuses(self) -> bool:
        """Whether it has a status for the case that `done` never holds, or a program that it calls may refuse."""
        return self.otherwise is not None or any(s.refuses for s in self.step)

    def calls(self) -> tuple[Call, ...]:
        """The calls of its step."""
        return tuple(s for s in self.step if isinstance(s, Call))

    def reads(self) -> set[sp.Symbol]:
        """The names that it reads and does not bind itself: the step reads what it binds."""
        return super().reads().union(*(call.reads() for call in self.calls())) - set(self.bound())


@dataclass(frozen=True)
class Call(Common):
    """Run a program that several programs share, and bind names of its outputs; if it refuses, so does the caller.

    given: the values of the arguments. The other inputs of the shared program are constants of the machine, which are
    inputs of the caller, too. Where `wanted` does not hold the program is not run, and the names are bound to false
    and zeros.
    """

    name_fields, program_fields, is_straight, refuses = ("names",), ("program",), False, True
    program: Program
    given: tuple[tuple[sp.Symbol, sp.Expr], ...]
    names: tuple[sp.Symbol, ...]
    """The outputs that the caller reads; all others are dropped."""
    note: str = ""
    wanted: Boolean = sp.true
    refusal: tuple[Status, Reason] | None = None
    """The status and the reason of the caller where the shared program refuses; None: the status of that program."""
    passes: int | None = None
    """In a loop: the most passes that all runs together make of a loop of the shared program, or of one that this
    calls; None: every run may make as many as there may be in one run."""
    is_usual: bool = False
    """Whether usual poses run it, too, if it is run under a condition."""

    @property
    def is_conditional(self) -> bool:
        """Whether the program is run under a condition."""
        return not is_decided(self.wanted)

    @property
    def is_rare(self) -> bool:
        """Whether few poses run the program: a call with a refusal of its own is a check that every pose passes."""
        return self.is_conditional and self.refusal is None and not self.is_usual

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

    def children(self) -> tuple[sp.Basic, ...]:
        """The condition, and the values of the arguments."""
        return (self.wanted, *(value for _, value in self.given))

    def with_children(self, values: Iterable[sp.Basic]) -> Self:
        """The same call with another condition and other arguments."""
        rest = iter(values)
        return replace(self, wanted=next(rest), given=tuple((name, next(rest)) for name, _ in self.given))

    def reads(self) -> set[sp.Symbol]:
        """The names that it reads, those of constants among them."""
        return super().reads() | set(self.constants)


Statement = Let | Require | Solve | Iterate | Call


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

    def calls(self) -> tuple[Call, ...]:
        """The calls, those in loops as well, in order."""
        steps = (s.step if isinstance(s, Iterate) else (s,) for s in self.body)
        return tuple(s for step in steps for s in step if isinstance(s, Call))

    @property
    def is_search(self) -> bool:
        """Whether a loop calls programs."""
        return any(isinstance(part, Call) for s in self.body if isinstance(s, Iterate) for part in s.step)

    def bound(self) -> tuple[sp.Symbol, ...]:
        """Every name that a statement binds, in order."""
        return tuple(name for s in self.body for name in s.bound())

    def reads(self) -> frozenset[sp.Symbol]:
        """Every free symbol that a statement, its reason or an output reads."""
        used: set[sp.Symbol] = set()
        for statement in self.body:
            used |= statement.reads().union(*map(names_in, reason_expressions(statement)))
        for output in self.outputs:
            used |= names_in(output.value)
        return frozenset(used) - set(self.bound())

    @property
    def refuses(self) -> bool:
        """Whether a statement may end the program."""
        return any(s.refuses for s in self.body)


def reason_expressions(statement: Statement) -> Iterator[sp.Expr]:
    """The expressions that are computed where a statement refuses, and nowhere else."""
    if isinstance(statement, Require) and statement.reason is not None:
        yield from statement.reason.expressions


def shared(programs: Iterable[Program]) -> tuple[Program, ...]:
    """The shared programs that the given programs call, each once and before its callers."""
    found: dict[str, Program] = {}
    for called in (p for program in programs for statement in program.body for p in statement.programs()):
        found |= {inner.name: inner for inner in (*shared([called]), called)}
    return tuple(found.values())


def rewritten(statement: Statement, change: Callable[[sp.Basic], sp.Basic]) -> Statement:
    """The statement with every expression changed, in its reason as well; the names that it binds stay."""
    before = statement.children()
    after = [change(value) for value in before]
    found = statement if all(map(is_, before, after)) else statement.with_children(after)
    if not isinstance(found, Require) or found.reason is None:
        return found
    reason = found.reason.rewritten(change)
    return found if reason is found.reason else replace(found, reason=reason)
