"""Names for constants of a machine: sines and cosines of fixed angles, and roots of parameters."""

from __future__ import annotations

from functools import cache

import sympy as sp

from derive.description.mechanism import Mechanism, Role, Turning
from derive.ir.constants import DEGREE
from derive.ir.program import Let
from derive.ir.symbols import HEADING, ROTATION_ENTRIES, cosine, real, sine


def signs_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The parameters that are +1 or -1, and those that are 0 or 1."""
    return tuple(p.symbol for p in mechanism.parameters if p.role in (Role.SIGN, Role.FLAG))


def fixed_angles(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The angles of the machine that never move: its angle parameters, in degrees."""
    return tuple(p.symbol for p in mechanism.parameters if p.role is Role.ANGLE)


def fixed_lets(mechanism: Mechanism) -> tuple[Let, ...]:
    """The bindings of the cosines and sines of fixed angles, and of the roots that are made of parameters alone."""
    functions = ((cosine, sp.cos), (sine, sp.sin))
    angles = tuple(Let(f(a), g(a * DEGREE)) for a in fixed_angles(mechanism) for f, g in functions)
    return (
        *angles,
        *(let for _, let in _fixed_roots(mechanism.equations, tuple(p.symbol for p in mechanism.parameters))),
    )


def fixed_names(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """Every name that is made of parameters alone."""
    return (*(p.symbol for p in mechanism.parameters), *(let.name for let in fixed_lets(mechanism)))


def fixed_squares(mechanism: Mechanism) -> dict[sp.Symbol, sp.Expr]:
    """The squares of the roots of parameters, by the names of the roots."""
    parameters = tuple(p.symbol for p in mechanism.parameters)
    own = {real(p.name): p for p in parameters}
    return {
        let.name: sp.expand((let.value**2).xreplace(own)) for _, let in _fixed_roots(mechanism.equations, parameters)
    }


@cache
def _fixed_roots(equations: tuple[sp.Expr, ...], parameters: tuple[sp.Symbol, ...]) -> tuple[tuple[sp.Expr, Let], ...]:
    """The square roots in the equations that are made of parameters alone, inner ones first, each with its name.

    A radicand under a name is not expanded: a difference of squares stays a product of lengths.
    """
    powers = {p for e in equations for p in sp.sympify(e).atoms(sp.Pow) if p.exp == sp.Rational(1, 2)}
    roots = [r for r in powers if r.free_symbols and r.free_symbols <= set(parameters)]
    found: list[tuple[sp.Expr, Let]] = []
    for number, root in enumerate(sorted(roots, key=lambda r: (sp.count_ops(r), str(r))), 1):
        radicand = sp.factor(root.base.xreplace({inner: let.name for inner, let in found}))
        radicand = radicand.xreplace({s: real(s.name) for s in radicand.free_symbols})  # else SymPy splits the root
        found.append((root, Let(real(f"fixed_length_{number}"), sp.sqrt(radicand), "a length made of parameters")))
    return tuple(found)


def all_angles(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """Every angle whose sine and cosine have names."""
    return (*angles_of(mechanism), *fixed_angles(mechanism))


def with_fixed_names(mechanism: Mechanism, expression: sp.Expr) -> sp.Expr:
    """The expression with the sines and cosines of fixed angles and of the heading of a loop, and the roots of
    parameters, by their names.
    """
    functions = ((cosine, sp.cos), (sine, sp.sin))
    table = {g(a * DEGREE): f(a) for a in fixed_angles(mechanism) for f, g in functions}
    if mechanism.is_turning_loop and mechanism.task.turning is Turning.ABOUT_Z:
        table |= heading_entries()
    for root, let in _fixed_roots(mechanism.equations, tuple(p.symbol for p in mechanism.parameters)):
        table[root] = let.name
    return sp.sympify(expression).xreplace(table)


def heading_entries() -> dict[sp.Expr, sp.Expr]:
    """The entries of a rotation about z, by the names of its cosine and sine."""
    cos_heading, sin_heading = cosine(HEADING), sine(HEADING)
    entries = (cos_heading, -sin_heading, 0, sin_heading, cos_heading, 0, 0, 0, 1)
    return dict(zip(ROTATION_ENTRIES, map(sp.sympify, entries), strict=True))


def angles_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The angles of the rotary joints."""
    return tuple(j.symbol for j in mechanism.joints if j.is_angle)
