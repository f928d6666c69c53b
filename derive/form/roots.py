"""Roots in the equations of a loop: sqrt(A) = B says that A = B^2, where B is not negative.

So a rod whose length is stated, and not its square, is the same rod. A length that joints change is not negative at the
nominal machine, and becomes one of the quantities that are positive, like that of a rod.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism
from derive.ir.constants import DEGREE
from derive.ir.symbols import COORDINATE_NAMES, real

_COORDINATES = {real(c) for c in COORDINATE_NAMES}


def with_squared_roots(mechanism: Mechanism) -> Mechanism:
    """The mechanism without roots of coordinates in `closure`, where the other side of their equations is not negative.

    Raises `DescriptionError` where that is made of parameters and may be negative.
    """
    sides = [_sides(sp.sympify(e)) for e in mechanism.closure]
    joints, parameters = ({q.symbol for q in some} for some in (mechanism.joints, mechanism.parameters))
    closure, moved = list(mechanism.closure), list[sp.Expr]()
    for number, found in enumerate(sides):
        if found is None:
            continue
        root, other, radicands = found
        if not (other.is_nonnegative or other in mechanism.positive):
            read = other.free_symbols
            if read <= parameters:
                raise DescriptionError(
                    f"equation {number + 1} of closure= says that a root is {other}, which is not known to be "
                    "positive: make its parameters lengths, or state positive=(...), or the squares"
                )
            if not read <= {*joints, *parameters, DEGREE} or not _at_nominal(mechanism, other).is_positive:
                continue
            moved.append(other)
        closure[number] = (root**2 - other**2).xreplace(radicands)
    return replace(mechanism, closure=tuple(closure), positive=(*mechanism.positive, *moved))


def _sides(equation: sp.Expr) -> tuple[sp.Symbol, sp.Expr, dict[sp.Symbol, sp.Expr]] | None:
    """A root, what it equals, and every root by its name; None where the equation is not linear in its first root."""
    expanded = sp.expand(equation)
    roots = [p for p in expanded.atoms(sp.Pow) if p.exp == sp.Rational(1, 2) and p.free_symbols & _COORDINATES]
    radicands = {sp.Dummy(nonnegative=True): p for p in sorted(roots, key=sp.default_sort_key)}
    left = expanded.xreplace({p: name for name, p in radicands.items()})
    root = next(iter(radicands), None)
    if root is None or not left.is_polynomial(root) or sp.degree(left, root) != 1:
        return None
    factor = left.coeff(root)
    if factor.free_symbols & {*_COORDINATES, *radicands}:
        return None
    return root, sp.cancel((factor * root - left) / factor), radicands


def _at_nominal(mechanism: Mechanism, value: sp.Expr) -> sp.Expr:
    nominal = {p.symbol: sp.Float(p.nominal) for p in mechanism.parameters} | {DEGREE: sp.pi / 180}
    return value.xreplace(nominal | {j.symbol: sp.Float(j.nominal) for j in mechanism.joints}).evalf()
