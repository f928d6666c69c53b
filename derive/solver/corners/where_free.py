"""The square of a length where an angle is free: there some entries of the commanded rotation vanish, others are
one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from derive.algebra.normal_form import reduce_units
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Statement
from derive.ir.symbols import ROTATION_ENTRIES, angle_of


def square_where_free(
    statements: Sequence[Statement],
    size: sp.Expr,
    dependent: Mapping[sp.Symbol, sp.Expr],
    gone: Mapping[sp.Symbol, sp.Expr],
) -> sp.Expr:
    """The square of a length, made of the cosine and sine of the angle, where the angle is free."""
    written = size**2
    while found := written.free_symbols & dependent.keys():
        written = sp.expand(written.xreplace({name: _chosen(dependent[name]) for name in found}))
        written = written.replace(
            lambda n: isinstance(n, sp.Pow) and isinstance(n.base, Root) and n.exp % 2 == 0,
            lambda n: n.base.args[0] ** (n.exp / 2),
        )
        if written.atoms(Root, Select):
            return written
    entries = {s.name: s.value for s in statements if isinstance(s, Let) and s.value in ROTATION_ENTRIES}
    written = sp.expand(written.xreplace(entries).xreplace(dict(gone)))
    for one in _alone(gone):
        written = written.replace(
            lambda n, one=one: isinstance(n, sp.Pow) and n.base == one and n.exp % 2 == 0, lambda n: sp.Integer(1)
        )
    turns = [a for a in (angle_of(s) for s in written.free_symbols if isinstance(s, sp.Symbol)) if a is not None]
    return sp.expand(reduce_units(sp.expand(written), tuple(sorted(turns, key=lambda s: s.name)), ()))


def _chosen(value: sp.Expr) -> sp.Expr:
    """The value of a divisor where it divides."""
    return sp.sympify(value.args[1]) if isinstance(value, Select) else value


def _alone(gone: Mapping[sp.Symbol, sp.Expr]) -> list[sp.Symbol]:
    """The entries of the commanded rotation that are one or less one, because the others of a row or column vanish."""
    lines = [ROTATION_ENTRIES[3 * k : 3 * k + 3] for k in range(3)] + [ROTATION_ENTRIES[k::3] for k in range(3)]
    left = [[s for s in line if s not in gone] for line in lines]
    return [line[0] for line in left if len(line) == 1]
