"""A description as the field can hold it: fractions for decimals, and no roots of coordinates."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.amounts import STATED, as_right_angles, number_in, without_decimals
from derive.description.mechanism import Mechanism, Role
from derive.geometry.frames import Motion
from derive.ir.symbols import COORDINATE_NAMES, real

_COORDINATES = {real(c) for c in COORDINATE_NAMES}


def as_fractions(mechanism: Mechanism) -> Mechanism:
    """The mechanism with fractions for the decimals of its rods, which their equations subtract and square; each
    equation of a point that has a root is multiplied by that with the other sign of it, and has none.
    """
    ends = [(r, tuple(map(without_decimals, r.base)), tuple(map(without_decimals, r.plate))) for r in mechanism.rods]
    rods = (replace(r, base=b, plate=p, length=without_decimals(sp.sympify(r.length))) for r, b, p in ends)
    stated = map(sp.sympify, mechanism.closure)
    closure = mechanism.closure if mechanism.is_platform else tuple(map(_without_roots, stated))
    return replace(mechanism, rods=tuple(rods), closure=closure)


def _without_roots(equation: sp.Expr) -> sp.Expr:
    roots = [p for p in equation.atoms(sp.Pow) if p.exp == sp.Rational(1, 2) and p.free_symbols & _COORDINATES]
    names = {root: sp.Dummy() for root in sorted(roots, key=sp.default_sort_key)}
    left = equation.xreplace(names)
    for root, name in names.items():
        left = sp.expand(left * left.xreplace({name: -name})).xreplace({name: root})  # powers are even
    return left


def is_rounded(machine: Mechanism, described: Mechanism) -> bool:
    """Whether numbers of the machine were computed of those of the description, other than by sums."""
    if described.chain is None:
        stated = (*described.closure, *[v for r in described.rods for v in r.base])
        numbers = (d for e in stated for d in sp.sympify(e).atoms(sp.Float, sp.Rational))
        long = (d for d in numbers if without_decimals(d).q > STATED)
        return any(long) or any(sp.sympify(e).has(sp.Float) for e in machine.equations)
    turns = [number_in(f.amount) for f in described.chain.factors if f.motion is Motion.TURN]
    shifts = [f.amount for f in described.chain.factors if f.motion is Motion.SHIFT]
    powers = [p for a in shifts for p in a.atoms(sp.Pow, sp.Function) if p.is_number and p.as_base_exp()[0] != sp.pi]
    fixed = [p for p in machine.parameters if p.fixed is not None and p.role is Role.ANGLE]
    return bool(powers or fixed) or any(as_right_angles(n) is None for n in turns)
