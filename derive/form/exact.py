"""Exact numbers for those that a chain states: 0.425 is 17/40."""

from __future__ import annotations

import sympy as sp

_RIGHT = sp.pi / 2


def without_decimals(amount: sp.Expr) -> sp.Expr:
    """The amount with fractions for its decimals, as they are written: 0.425 is 17/40."""
    return amount.xreplace({f: sp.Rational(repr(float(f))) for f in amount.atoms(sp.Float)})


def is_right(number: sp.Expr) -> bool:
    """Whether an angle is an exact multiple of 90°."""
    return bool((number / _RIGHT).is_Integer)
