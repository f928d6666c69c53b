"""The work of a derivation, counted in terms: a search that leads nowhere ends with the same verdict everywhere.

Whoever expands, reduces or factors an expression states before it how many terms it writes. A count, not a clock: the
same machine has the same count on every computer, and also where results are kept (`counted`). The terms bound the
memory, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from math import comb, inf
from typing import ParamSpec, TypeVar

import sympy as sp

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


class TooMuchWork(Exception):
    """The work that is allowed is done, and the derivation is not finished."""

    stage = "the derivation"
    """What it was needed for."""

    def __init__(self, most: float, terms: int) -> None:
        """most: the terms that were allowed; terms: those of what would be written next."""
        super().__init__(most, terms)
        self.most, self.terms = most, terms

    def __str__(self) -> str:
        return f"{self.stage} was given up after {self.most:,.0f} terms, before an expression of {self.terms:,} terms"


@dataclass
class Work:
    """The terms that have been written, and the most that may be."""

    most: float = inf
    done: int = 0


_WORK: ContextVar[Work] = ContextVar("_WORK", default=Work())  # noqa: B039 (it bounds nothing, and only counts)


@contextmanager
def at_most(terms: float, inner: Work | None = None) -> Iterator[Work]:
    """Bound the work inside: `TooMuchWork` is raised where it would exceed this number of terms, or what is left of a
    bound outside. inner: what counts it, where the caller reads it after an error.
    """
    outer = _WORK.get()
    inner = Work() if inner is None else inner
    inner.most = min(terms, outer.most - outer.done)
    token = _WORK.set(inner)
    try:
        yield inner
    finally:
        _WORK.reset(token)
        outer.done += inner.done  # also of what was given up


def spend(terms: int) -> None:
    """Count terms before they are written. Raises `TooMuchWork` if they exceed the bound."""
    work = _WORK.get()
    if work.done + terms > work.most:
        raise TooMuchWork(work.most, terms)
    work.done += terms


def stage(name: str) -> Callable[[Callable[_Given, _Result]], Callable[_Given, _Result]]:
    """Name a stage of a derivation, for the message where there is too much work for it."""

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
        before = _WORK.get().done
        result = function(*arguments)  # type: ignore[call-arg]
        kept[arguments] = (result, _WORK.get().done - before)
        return result

    return of


def terms_of_products(expression: sp.Expr) -> int:
    """The number of products of terms that are multiplied where an expression is expanded."""
    if isinstance(expression, sp.Add):
        return sum(map(terms_of_products, expression.args))
    if isinstance(expression, sp.Mul):
        product = 1
        for factor in expression.args:
            product *= terms_of_products(factor)
        return product
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer and expression.exp > 1:
        return comb(terms_of_products(expression.base) + int(expression.exp) - 1, int(expression.exp))
    return 1
