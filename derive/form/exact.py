"""Exact numbers for those that a closed loop states: 0.3 is 3/10."""

from __future__ import annotations

import sympy as sp

from derive.description.amounts import without_decimals
from derive.description.mechanism import Mechanism
from derive.form.inner_names import with_symbols

_RIGHT = sp.pi / 2
_WRITTEN = 10**6
"""A decimal with at most six decimals is one that a person writes, and its products are short."""


def with_exact_numbers(mechanism: Mechanism) -> Mechanism:
    """The mechanism with fractions for the decimals of its equations: their sums and products are then not rounded.

    Longer decimals than a person writes stay, and those in angles: radians have no exact sines.
    """
    if mechanism.chain is not None:
        return mechanism
    ends = (v for rod in mechanism.rods for v in (*rod.base, *rod.plate, rod.length))
    stated = [sp.sympify(e) for e in (*mechanism.equations, *ends, *(b.indicator for b in mechanism.branches))]
    in_angles = {a for e in stated for f in e.atoms(sp.sin, sp.cos) for a in f.atoms(sp.Float)}
    exact = {d: without_decimals(d) for e in stated for d in e.atoms(sp.Float) - in_angles}
    found: Mechanism = with_symbols(mechanism, {d: n for d, n in exact.items() if n.q <= _WRITTEN})
    return found


def is_right(number: sp.Expr) -> bool:
    """Whether an angle is an exact multiple of 90°."""
    return bool((number / _RIGHT).is_Integer)
