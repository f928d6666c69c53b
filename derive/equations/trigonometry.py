"""Names for sines and cosines: `cos_a12` for the cosine of A1 + A2."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.algebra.angle_sums import name_of, terms_of
from derive.algebra.normal_form import polynomial
from derive.description.mechanism import Mechanism
from derive.equations.closures.fixed_names import angles_of, fixed_angles, signs_of
from derive.ir.constants import DEGREE
from derive.ir.program import Let
from derive.ir.symbols import HEADING, cosine, real, sine

_FUNCTIONS = ((sine, sp.sin), (cosine, sp.cos))


def heading_at_joints(mechanism: Mechanism) -> tuple[Let, ...]:
    """Cosine and sine of the heading of a loop at joint values; empty for a loop without a heading."""
    if mechanism.heading is None:
        return ()
    lets, values = named_trigonometry(mechanism, [sp.cos(mechanism.heading), sp.sin(mechanism.heading)])
    return (*lets, *(Let(f(HEADING), v) for f, v in zip((cosine, sine), values, strict=True)))


def named_trigonometry(mechanism: Mechanism, values: Iterable[sp.Expr]) -> tuple[tuple[Let, ...], list[sp.Expr]]:
    """The statements that bind every sine and cosine (`cos_a12`), and the values with these names."""
    values = [sp.sympify(v) for v in values]
    lets: dict[sp.Symbol, Let] = {}
    table: dict[sp.Expr, sp.Expr] = {}
    angles = angles_of(mechanism)
    for function in sorted(sp.Matrix(values).atoms(sp.sin, sp.cos), key=sp.default_sort_key):
        terms = terms_of(sp.expand(function.args[0]), angles)
        word = "sin" if isinstance(function, sp.sin) else "cos"
        if terms is None:
            fixed = [a for a in fixed_angles(mechanism) if a in function.free_symbols]
            table[function] = polynomial(function, (*angles, *fixed), signs_of(mechanism))
            moving = angles if function.free_symbols - {*fixed, DEGREE} else ()
            values_of = [*((a, a) for a in moving), *((a, a * DEGREE) for a in fixed)]
            lets.update({f(a): Let(f(a), g(v)) for a, v in values_of for f, g in _FUNCTIONS})
        else:
            name = real(f"{word}_{name_of(terms)}")
            table[function] = name
            lets[name] = Let(name, function)
    return tuple(lets.values()), [v.xreplace(table) for v in values]
