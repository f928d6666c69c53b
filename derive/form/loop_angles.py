"""Angles that stand in a closed loop as numbers: cosine and sine of 250 degrees are those of 20, but for right angles.

SymPy writes a few of them as roots, whose squares add up to one. Of all others the sum c^2 + s^2 stays as it is: each
becomes the cosine or sine of a fixed angle of at most 45 degrees, under its name.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.form.inner_names import with_symbols
from derive.form.named_angles import NamedAngle, of_degrees
from derive.form.numbers import fixed_angle
from derive.ir.constants import DEGREE


def with_named_loop_angles(mechanism: Mechanism) -> Mechanism:
    """The mechanism with names for the angles whose sines and cosines stand in its equations as numbers."""
    if mechanism.chain is not None or mechanism.is_turning_loop:
        return mechanism
    functions = {f for e in mechanism.equations for f in e.atoms(sp.sin, sp.cos) if f.is_number}
    table: dict[sp.Expr, sp.Expr] = {}
    angles: dict[sp.Expr, NamedAngle] = {}
    for one in sorted(functions, key=sp.default_sort_key):
        quarters = sp.Integer(round(float(2 * one.args[0] / sp.pi)))
        rest = sp.nsimplify(one.args[0] - quarters * sp.pi / 2)
        size = sp.Abs(rest)
        angle = angles.setdefault(size, of_degrees(size * 180 / sp.pi))
        table[one] = one.func(quarters * sp.pi / 2 + sp.sign(rest) * angle.symbol * DEGREE)
    if not table:
        return mechanism
    fixed = tuple(map(fixed_angle, angles.values()))
    renamed: Mechanism = with_symbols(mechanism, table)
    return replace(renamed, home=mechanism.home, parameters=(*mechanism.parameters, *fixed))
