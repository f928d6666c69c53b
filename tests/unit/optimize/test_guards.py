"""Guards: a condition that holds where a root is positive is asked only where it is not."""

from __future__ import annotations

import pytest
import sympy as sp

from derive.emit.python.printer import ScalarPrinter
from derive.emit.python.program import Refusals, item_lines
from derive.ir.primitives import Root
from derive.ir.program import Let, Require, Status
from derive.ir.symbols import real
from derive.ir.tree import If
from derive.optimize.guards import PositiveRoot, guarded

A, B, D, R, S, X, Y = (real(n) for n in "abdrsxy")
SQUARE = Let(S, X * Y)
ROOT = Let(A, R * Root(S))


def asked(bound: sp.Expr) -> Require:
    return Require(sp.Ge(S, bound), Status.UNREACHABLE, "out of reach")


@pytest.mark.parametrize("bound", [sp.Float("-1e-12"), sp.Integer(0), -3 * D**2, -(D**2) - 2 * Y**4])
def test_where_the_root_is_positive_it_is_not_asked(bound: sp.Expr) -> None:
    """A condition that a positive radicand implies is tested only where the radicand is not positive."""
    square, choice, last = guarded([SQUARE, asked(bound), ROOT, Let(B, A + 1)])
    assert square == SQUARE and last == Let(B, A + 1)
    assert choice == If(sp.Gt(S, 0), (Let(A, R * PositiveRoot(S)),), (asked(bound), Let(A, sp.Integer(0))), (A,))


@pytest.mark.parametrize("bound", [sp.Float("1e-12"), -D, D**2, -(D**3), Y - D**2])
def test_a_bound_that_may_be_positive_is_always_asked(bound: sp.Expr) -> None:
    """A condition with a bound that may be positive is always tested."""
    body = (SQUARE, asked(bound), ROOT)
    assert guarded(body) == body


def test_another_comparison_is_always_asked() -> None:
    """A condition that a positive radicand does not imply is always tested."""
    for condition in (sp.Le(S, 1), sp.Gt(S, -1), sp.Ge(S + X, -1)):
        body = (SQUARE, Require(condition, Status.UNREACHABLE), ROOT)
        assert guarded(body) == body


@pytest.mark.parametrize("square", [4.0, 0.0, -1e-13, -1.0, float("nan"), float("inf")])
def test_it_does_what_the_statements_did(square: float) -> None:
    """Run as text, before and after: not a number is refused by both."""
    body = [asked(sp.Float("-1e-12")), ROOT]
    answers = []
    for items in (body, guarded(body)):
        lines = [*item_lines(items, Refusals(lambda _: "None"), ScalarPrinter()), "return a"]
        text = "\n".join(["from math import sqrt", "def f(s, r):", *(f"    {line}" for line in lines)])
        scope: dict[str, object] = {}
        exec(text, scope)
        answers.append(scope["f"](square, -2.0))  # type: ignore[operator]
    assert answers[0] == answers[1]
