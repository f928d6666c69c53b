"""The work of a derivation and of its measurement: a search that leads nowhere ends with the same verdict everywhere.

Whoever expands, reduces or factors an expression states before it how many terms it writes; whoever executes a program,
how many steps it takes. A count, not a clock: the same machine has the same count on every computer, and also where
results are kept (`counted`). The terms bound the memory, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from math import inf
from typing import ParamSpec, TypeVar

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


_ROWS = 300
"""So many rows take about twice as long as one."""


class TooMuchWork(Exception):
    """The work that is allowed is done, and the derivation is not finished."""

    stage = "the derivation"
    """What it was needed for."""

    def __init__(self, most: float, further: int, unit: str) -> None:
        """most: the terms or steps that were allowed; further: those of what would be done next."""
        super().__init__(most, further, unit)
        self.most, self.further, self.unit = most, further, unit

    def __str__(self) -> str:
        ahead = f", before an expression of {self.further:,} terms" if self.unit == TERMS.name else ""
        return f"{self.stage} was given up after {self.most:,.0f} {self.unit}{ahead}"


@dataclass
class Work:
    """The terms that have been written or the steps that have been taken, and the most that may be."""

    most: float = inf
    done: int = 0


TERMS: ContextVar[Work] = ContextVar("terms", default=Work())  # noqa: B039 (it bounds nothing, and only counts)
"""The terms of expressions."""
STEPS: ContextVar[Work] = ContextVar("steps", default=Work())  # noqa: B039
"""The statements of programs that are executed, for some hundred rows at a time."""


@contextmanager
def at_most(most: float, inner: Work | None = None, unit: ContextVar[Work] = TERMS) -> Iterator[Work]:
    """Bound the work inside: `TooMuchWork` is raised where it would exceed this number of terms or steps, or what is
    left of a bound outside. inner: what counts it, where the caller reads it after an error.
    """
    outer = unit.get()
    inner = Work() if inner is None else inner
    inner.most = min(most, outer.most - outer.done)
    token = unit.set(inner)
    try:
        yield inner
    finally:
        unit.reset(token)
        outer.done += inner.done  # also of what was given up


def spend(further: int, unit: ContextVar[Work] = TERMS) -> None:
    """Count terms before they are written, or steps before they are taken. Raises `TooMuchWork` where they exceed the
    bound.
    """
    work = unit.get()
    if work.done + further > work.most:
        raise TooMuchWork(work.most, further, unit.name)
    work.done += further


def spend_steps(statements: int, rows: int) -> None:
    """Count the steps of statements that are executed for so many rows."""
    spend(statements * (1 + rows // _ROWS), STEPS)


def stage(name: str) -> Callable[[Callable[_Given, _Result]], Callable[_Given, _Result]]:
    """Name a stage of a derivation or of its measurement, for the message where there is too much work for it."""

    def named(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
        @wraps(function)
        def of(*arguments: _Given.args, **named_arguments: _Given.kwargs) -> _Result:
            try:
                return function(*arguments, **named_arguments)
            except TooMuchWork as problem:
                problem.stage = name
                raise

        return of

    return named


def counted(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
    """Keep the results of a function, as `cache` does, with their work: it counts wherever a result is used."""
    kept: dict[tuple[object, ...], tuple[_Result, int]] = {}

    @wraps(function)
    def of(*arguments: _Given.args, **_: _Given.kwargs) -> _Result:
        if arguments in kept:
            result, terms = kept[arguments]
            spend(terms)
            return result
        before = TERMS.get().done
        result = function(*arguments)  # type: ignore[call-arg]
        kept[arguments] = (result, TERMS.get().done - before)
        return result

    return of
