"""Joints that loops move: from the motor to the joint and back, and the derivatives of the loops.

A loop is one equation: along cos u + across sin u = level in an angle, a square in a length. Each has two roots, of
which the machine has the one on its side, where the derivative of the equation has a known sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.joints import Joint, Loop
from derive.description.mechanism import DescriptionError, Mechanism
from derive.equations.closures.fixed_names import all_angles, fixed_angles, signs_of
from derive.ir.constants import BOUNDARY, DEGREE, FREE_ANGLE, LEAST
from derive.ir.primitives import Atan2, Root, Select, Wrap
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about
from derive.ir.symbols import SCALE, cosine, real, sine


def joint_of_motor(mechanism: Mechanism, joint: Joint) -> tuple[Statement, ...]:
    """The joint value from the motor value, which has a name; refused where a loop does not close."""
    statements: list[Statement] = []
    for number, loop in enumerate(joint.loops):
        statements += _named(loop.by, loop.turns[1]) if not number else []
        root = _root(mechanism, loop, loop.moved, loop.turns[0], loop.sides[0])
        last = number == len(joint.loops) - 1
        statements += [*root.lets, _closed(joint, root.is_real, Status.IMPOSSIBLE), *root.values(joint_alone=last)]
        if root.turns and not last:
            statements.append(Let(loop.moved, Wrap(Atan2(sine(loop.moved), cosine(loop.moved)))))
        statements.append(_on_side(mechanism, joint, loop, loop.by, Status.IMPOSSIBLE))
    return tuple(statements)


def motor_of_joint(mechanism: Mechanism, joint: Joint) -> tuple[Statement, ...]:
    """The motor value from the cosine and sine of the joint, or its length; refused where a loop does not close."""
    statements: list[Statement] = []
    for loop in reversed(joint.loops):
        root = _root(mechanism, loop, loop.by, loop.turns[1], loop.sides[1])
        values = root.values(joint_alone=False)
        statements += [*root.lets, _closed(joint, root.is_real, Status.UNREACHABLE), *values]
        statements.append(_on_side(mechanism, joint, loop, loop.moved, Status.UNREACHABLE))
    first = joint.loops[0]
    if first.turns[1]:
        statements.append(Let(first.by, Wrap(Atan2(sine(first.by), cosine(first.by)))))
    return tuple(statements)


def slopes(mechanism: Mechanism, joint: Joint, *, names: bool) -> tuple[tuple[Loop, sp.Expr, sp.Expr], ...]:
    """The derivatives of the equation of every loop by what it moves and by what moves it, at given values.

    names: whether the functions of the joint have names (those of what is between loops always have).
    """
    found = []
    for loop in joint.loops:
        form = _form(mechanism, loop)
        plain = {f(joint.symbol): g(joint.symbol) for f, g in ((cosine, sp.cos), (sine, sp.sin))}
        by_both = (_slope(form, u, t) for u, t in zip((loop.moved, loop.by), loop.turns, strict=True))
        moved, by = (s if names else s.xreplace(plain) for s in by_both)
        found.append((loop, moved, by))
    return tuple(found)


def rate(mechanism: Mechanism, joint: Joint) -> tuple[tuple[Statement, ...], sp.Expr]:
    """The velocity of the joint per velocity of its motor; refused at a dead point, where the joint is free."""
    statements: list[Statement] = []
    product: sp.Expr = sp.Integer(1)
    for loop, by_moved, by_motor in slopes(mechanism, joint, names=False):
        slope, ratio = real(f"slope_{loop.moved.name}"), real(f"rate_{loop.moved.name}")
        holds = sp.Gt(sp.Abs(slope), FREE_ANGLE * size(mechanism, loop, loop.moved))
        reason = about(joint.name, Why.NEAR_TYPE_2)
        statements += [
            Let(slope, by_moved, f"the loop of {joint.name}: its equation by what it moves"),
            Require(holds, Status.IMPOSSIBLE, reason=reason),
            Let(ratio, -by_motor / Select(holds, slope, sp.Integer(1))),
        ]
        product = product * ratio
    return tuple(statements), product


def size(mechanism: Mechanism, loop: Loop, unknown: sp.Symbol) -> sp.Expr:
    """The unit of a derivative of a loop: its largest value, where parameters alone determine it."""
    turns = loop.turns[0 if unknown == loop.moved else 1]
    moving = {s for u in (loop.moved, loop.by) for s in (u, cosine(u), sine(u))}
    if turns:
        form = _form(mechanism, loop)
        square = form.coeff(cosine(unknown)) ** 2 + form.coeff(sine(unknown)) ** 2
        if not square.free_symbols & moving:
            return sp.sqrt(sp.factor(_plain(mechanism, square)))
    rates = sum((v.diff(unknown) ** 2 for v in loop.vector), sp.Integer(0))
    square = polynomial(rates, _angles(mechanism, loop), signs_of(mechanism))
    if square != 0 and not (square * loop.length).free_symbols & moving:
        return 2 * loop.length * sp.sqrt(sp.factor(_plain(mechanism, square)))
    return SCALE**2 if turns else SCALE


@dataclass(frozen=True)
class _Solution:
    """One root of a loop."""

    unknown: sp.Symbol
    turns: bool
    lets: tuple[Let, ...]
    is_real: sp.Basic
    parts: tuple[sp.Expr, ...]
    """Cosine and sine of an angle, or the length."""

    def values(self, *, joint_alone: bool) -> tuple[Let, ...]:
        """The bindings of the unknown. joint_alone: an angle has its value alone, not its cosine and sine."""
        if not self.turns:
            return (Let(self.unknown, self.parts[0]),)
        if joint_alone:
            return (Let(self.unknown, Wrap(Atan2(self.parts[1], self.parts[0]))),)
        return tuple(Let(f(self.unknown), v) for f, v in zip((cosine, sine), self.parts, strict=True))


def _root(mechanism: Mechanism, loop: Loop, unknown: sp.Symbol, turns: bool, side: sp.Expr) -> _Solution:
    """The root of a loop on a side."""
    form, name = _form(mechanism, loop), unknown.name
    note = f"the loop of {loop.moved.name.upper()}, solved for {name.upper()}"
    if not turns:
        return _length(sp.Poly(form, unknown), loop, unknown, side)
    cos_u, sin_u = cosine(unknown), sine(unknown)
    poly = sp.Poly(form, cos_u, sin_u)
    if poly.total_degree() != 1:
        raise DescriptionError(f"the loop of {loop.moved.name.upper()} is not linear in the cosine and sine of {name}")
    values = (poly.coeff_monomial(cos_u), poly.coeff_monomial(sin_u), -poly.coeff_monomial(1))
    along, across, level = (real(f"{word}_of_{name}") for word in ("along", "across", "level"))
    reach, root, divisor = (real(f"{word}_of_{name}") for word in ("reach", "root", "divisor"))
    square = along**2 + across**2
    lets = (
        *(Let(n, v, w) for n, v, w in zip((along, across, level), values, (note, "", ""), strict=True)),
        Let(reach, Root(square)),
        Let(root, side * Root((reach - level) * (reach + level))),
        Let(divisor, Select(sp.Gt(square, LEAST), square, sp.Integer(1))),
    )
    parts = ((along * level + across * root) / divisor, (across * level - along * root) / divisor)
    return _Solution(unknown, True, lets, sp.Le(sp.Abs(level), reach * (1 + BOUNDARY)), parts)


def _length(poly: sp.Poly, loop: Loop, unknown: sp.Symbol, side: sp.Expr) -> _Solution:
    """The root of square u^2 + slope u + rest = 0, for a length u."""
    square, slope, rest = (poly.coeff_monomial(unknown**k) for k in (2, 1, 0))
    if not square.is_number or square == 0 or poly.degree() > 2:
        raise DescriptionError(f"the loop of {loop.moved.name.upper()} is no square of {unknown.name.upper()}")
    middle, far, left = (real(f"{word}_of_{unknown.name}") for word in ("middle", "square", "rest"))
    note = f"the loop of {loop.moved.name.upper()}, solved for {unknown.name.upper()}"
    lets = (Let(middle, -slope / (2 * square), note), Let(left, -rest / square), Let(far, middle**2 + left))
    is_real = sp.Ge(far, -BOUNDARY * (middle**2 + sp.Abs(left)))
    return _Solution(unknown, False, lets, is_real, (middle + side * sp.sign(square) * Root(far),))


def _on_side(mechanism: Mechanism, joint: Joint, loop: Loop, unknown: sp.Symbol, status: Status) -> Require:
    """The condition that a value that was given is on its side of the dead point, with names for functions."""
    place = 0 if unknown == loop.moved else 1
    slope = loop.sides[place] * _slope(_form(mechanism, loop), unknown, loop.turns[place])
    if status is Status.IMPOSSIBLE and loop == joint.loops[-1]:
        plain = {f(loop.moved): g(loop.moved) for f, g in ((cosine, sp.cos), (sine, sp.sin))}
        slope = slope.xreplace(plain)
    unit = size(mechanism, loop, unknown)
    return Require(sp.Ge(slope, -BOUNDARY * unit), status, reason=about(joint.name, Why.NEAR_TYPE_2))


def _closed(joint: Joint, condition: sp.Basic, status: Status) -> Require:
    return Require(condition, status, reason=about(joint.name, Why.LOOP_OPEN))


def _named(symbol: sp.Symbol, turns: bool) -> list[Let]:
    """Names for the cosine and sine of an angle."""
    return [Let(f(symbol), g(symbol)) for f, g in ((cosine, sp.cos), (sine, sp.sin))] if turns else []


def _angles(mechanism: Mechanism, loop: Loop) -> tuple[sp.Symbol, ...]:
    own = (u for u, turns in zip((loop.moved, loop.by), loop.turns, strict=True) if turns)
    return tuple(dict.fromkeys((*all_angles(mechanism), *own)))


def _form(mechanism: Mechanism, loop: Loop) -> sp.Expr:
    """The equation as a polynomial of cosines and sines."""
    form = polynomial(loop.equation, _angles(mechanism, loop), signs_of(mechanism))
    return _plain(mechanism, sp.expand(form))


def _plain(mechanism: Mechanism, value: sp.Expr) -> sp.Expr:
    """The value with the functions of fixed angles written out: no other statement binds their names here."""
    functions = ((cosine, sp.cos), (sine, sp.sin))
    return value.xreplace({f(a): g(a * DEGREE) for a in fixed_angles(mechanism) for f, g in functions})


def _slope(form: sp.Expr, unknown: sp.Symbol, turns: bool) -> sp.Expr:
    if not turns:
        return sp.diff(form, unknown)
    return form.coeff(sine(unknown)) * cosine(unknown) - form.coeff(cosine(unknown)) * sine(unknown)


def renamed(statements: tuple[Statement, ...], names: Mapping[sp.Symbol, sp.Symbol]) -> tuple[Let, ...]:
    """The values of statements under other names, without the conditions."""
    lets = [s for s in statements if isinstance(s, Let)]
    table = {s.name: real(f"reference_{s.name.name}") for s in lets} | dict(names)
    return tuple(replace(s, name=table[s.name], value=s.value.xreplace(table)) for s in lets)
