"""The conditions of a refusal, one by one, and the values whose size alone is tested."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.ir.constants import LARGEST


def parts_of(conditions: Iterable[sp.Basic]) -> list[sp.Basic]:
    """Conditions that must all hold, without an "and" in any of them."""
    return [p for c in conditions for p in (sp.ordered(c.args) if isinstance(c, sp.And) else [c])]


def is_size_test(condition: sp.Basic) -> bool:
    """Whether a condition tests that an input is a number of reasonable size."""
    if not isinstance(condition, sp.Le) or condition.rhs != LARGEST or not isinstance(condition.lhs, sp.Abs):
        return False
    return bool(condition.lhs.args[0].is_Symbol)


def magnitude_tests(conditions: Iterable[sp.Basic], least: int = 2) -> list[sp.Expr]:
    """The values, if the conditions test nothing but the size of this many values or more; else none."""
    parts = parts_of(conditions)
    return [part.lhs.args[0] for part in parts] if len(parts) >= least and all(map(is_size_test, parts)) else []
