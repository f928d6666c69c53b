"""The amounts of a chain: their numbers, and a message, quoting the factor, for what no turn or shift can have.

`pi/2`, `90*DEGREE` and `1.5708` are one right angle. `1.5708` is one written with four decimals; `1.57` is 0.0008 rad
short of one, and stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from itertools import combinations_with_replacement
from typing import Any

import sympy as sp

from derive.description.dimensions import Parameter
from derive.description.mechanism import Kind, Mechanism, Role
from derive.geometry.frames import LETTERS, Chain, Factor, Motion
from derive.ir.constants import DEGREE

_RIGHT = sp.pi / 2
_ANY_DECIMALS = 1e-6
"""An angle as near to a multiple of 90° as this (radians) is that multiple, however many decimals it has."""
_LONG_DECIMALS = 1e-9
"""A decimal as near to a whole number of thousandths of a degree as this (radians) is that angle."""
_THOUSANDTHS = 1000
_UNIT = 1e-15
"""Decimals whose squares differ from one by less than this, in their sum, are cosine and sine of one angle."""
STATED = 10**6
"""A decimal with at most six decimals is one that a person writes: it is exact as it stands, its products are short."""
_DECIMALS = 4
"""A decimal with at least this many digits that equals a rounded multiple of 90° is that multiple."""
_NEARLY = 0.01
"""Any other angle as near to a multiple of 90° as this (radians) was perhaps meant to be that multiple."""
_LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)


def number_in(amount: sp.Expr) -> sp.Expr:
    """The sum of the terms of an amount that are numbers; an angle may be in degrees."""
    return sp.Add(*[t for t in sp.Add.make_args(sp.expand(amount)) if not t.free_symbols - {DEGREE}])


def without_decimals(amount: sp.Expr) -> sp.Expr:
    """The amount with fractions for its decimals, as they are written: 0.425 is 17/40."""
    return amount.xreplace({f: sp.Rational(repr(float(f))) for f in amount.atoms(sp.Float)})


def in_radians(number: sp.Expr) -> float:
    """The value of a number in which `DEGREE` may stand."""
    return float(number.subs(DEGREE, sp.pi / 180))


def written(factor: Factor) -> str:
    """A factor as a description writes it: `Rz(a1 + pi/4)`."""
    return f"{LETTERS[factor.motion]}{'xyz'[factor.axis]}({sp.sstr(factor.amount, full_prec=False)})"


def wrong_amounts(mechanism: Mechanism) -> Iterator[str]:
    """The faults in the amounts of a chain."""
    for factor in mechanism.chain.factors if mechanism.chain is not None else ():
        if not isinstance(factor.amount, sp.Expr):
            yield f"{written(factor)} of the chain is given what is true or false: it needs an angle or a length"
        elif factor.amount.has(sp.nan, sp.oo, -sp.oo, sp.zoo, sp.I):
            yield f"{written(factor)} of the chain holds what is no number"
        elif (strange := _strange(mechanism, factor.amount)) is not None:
            yield f"{written(factor)} of the chain holds {strange}: it is made of +, -, *, powers, sines and cosines"
        elif factor.motion is Motion.TURN:
            yield from _wrong_turn(mechanism, factor)
        else:
            yield from _wrong_shift(mechanism, factor)


def _strange(mechanism: Mechanism, amount: sp.Expr) -> sp.Basic | None:
    """A part of an amount that no equation can have: a root of a joint, or a function other than sine and cosine."""
    joints = {j.symbol for j in mechanism.joints}
    for part in sp.preorder_traversal(amount):
        if isinstance(part, sp.Pow) and part.free_symbols & joints and not part.exp.is_nonnegative:
            return part
        if isinstance(part, sp.Pow) and part.free_symbols & joints and not part.exp.is_Integer:
            return part
        if isinstance(part, sp.Function) and not isinstance(part, sp.sin | sp.cos):
            return part
    return None


def _wrong_turn(mechanism: Mechanism, factor: Factor) -> Iterator[str]:
    number, place = number_in(factor.amount), written(factor)
    literal = sp.sstr(number, full_prec=False)
    if not number.has(sp.pi, DEGREE) and abs(in_radians(number)) > 2 * float(sp.pi):
        meant = f"write radians({literal}), which derive.mechanism has"
        yield f"{place} of the chain turns by {literal} radians, more than a full turn: {meant}"
    for parameter in mechanism.parameters:
        if parameter.symbol not in factor.amount.free_symbols:
            continue
        rate = sp.diff(factor.amount, parameter.symbol)
        if parameter.role is Role.ANGLE and not rate.has(DEGREE, sp.pi):
            yield f"{place} of the chain has the angle {parameter.name} in degrees: write radians({parameter.name})"
        if parameter.role in _LENGTHS and rate.is_number:
            yield f"{place} of the chain turns by the length {parameter.name}: a turn needs an angle"
    for joint in (j for j in mechanism.joints if j.is_angle):
        if sp.diff(factor.amount, joint.symbol).has(DEGREE):
            yield f"{place} of the chain converts {joint.name}, which is in radians already: leave out radians()"


def _wrong_shift(mechanism: Mechanism, factor: Factor) -> Iterator[str]:
    """A term that is a product of powers of lengths, such as an area, and no length."""
    lengths = {p.symbol for p in mechanism.parameters if p.role in _LENGTHS}
    lengths |= {j.symbol for j in mechanism.joints if not j.is_angle and j.kind is not Kind.DRIVING}
    for term in sp.Add.make_args(sp.expand(factor.amount)):
        powers = [part.as_base_exp() for part in sp.Mul.make_args(term) if part.free_symbols & lengths]
        degree = sp.Add(*[exponent for _, exponent in powers])
        if powers and all(base in lengths for base, _ in powers) and degree.is_number and degree not in (0, 1):
            amount = sp.sstr(term, full_prec=False)
            yield f"{written(factor)} of the chain shifts by {amount}, which is no length: its powers must add to 1"


def with_exact_angles(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the exact multiples of 90° in its chain, however they are written: `90*DEGREE`, `1.5708`; and
    with the exact thousandths of a degree for long decimals, 22.5° for `0.3926990817`. In the equations of
    a loop `120*DEGREE` becomes 2 pi/3.
    """
    if mechanism.chain is None:
        return _with_exact_functions(mechanism)
    return replace(mechanism, chain=Chain(tuple(map(_with_exact_angle, mechanism.chain.factors))))


def _with_exact_functions(mechanism: Mechanism) -> Mechanism:
    stated = [sp.sympify(e) for e in (*mechanism.equations, *(b.indicator for b in mechanism.branches))]
    functions = {f for e in stated for f in e.atoms(sp.sin, sp.cos)}
    table = {f: f.func(sp.Add(*map(_in_exact_radians, sp.Add.make_args(sp.expand(f.args[0]))))) for f in functions}
    decimals = {d for e in stated for d in e.atoms(sp.Float)} - {d for f in functions for d in f.atoms(sp.Float)}
    table |= _as_functions(sorted((d for d in decimals if without_decimals(d).q > STATED), key=sp.Abs))
    exact: Mechanism = with_symbols(mechanism, {f: g for f, g in table.items() if f != g})
    return exact


def _as_functions(decimals: Sequence[sp.Float]) -> dict[sp.Expr, sp.Expr]:
    """Decimals that are cosine and sine of one angle, as these: the sum of their squares is then one, not rounded."""
    found: dict[sp.Expr, sp.Expr] = {}
    sizes = list(dict.fromkeys(map(abs, decimals)))
    for sine, cosine in combinations_with_replacement(sizes, 2):
        if abs(float(sine) ** 2 + float(cosine) ** 2 - 1) < _UNIT:
            angle = exact_angle(float(sp.atan2(sine, cosine)))
            found = {sine: sp.sin(angle), cosine: sp.cos(angle)} | found
    return {d: sp.sign(d) * found[abs(d)] for d in decimals if abs(d) in found}


def exact_angle(radians: float) -> sp.Expr:
    """The thousandths of a degree that a decimal in radians is, else its fraction."""
    near = round(radians * 180 / float(sp.pi) * _THOUSANDTHS) * sp.pi / (180 * _THOUSANDTHS)
    return near if abs(radians - float(near)) < _UNIT else sp.Rational(f"{radians:.15f}")


def _in_exact_radians(term: sp.Expr) -> sp.Expr:
    degrees = term / DEGREE
    return without_decimals(degrees) * sp.pi / 180 if degrees.is_number else term


def _with_exact_angle(factor: Factor) -> Factor:
    number = number_in(factor.amount) if factor.motion is Motion.TURN else sp.Integer(0)
    exact = as_right_angles(number)
    if exact is None and number.has(sp.Float):
        exact = round(in_radians(number) * 180 / float(sp.pi) * _THOUSANDTHS) * sp.pi / (180 * _THOUSANDTHS)
        exact = exact if abs(in_radians(number) - float(exact)) <= _LONG_DECIMALS else None
    if exact is None or exact == number:
        return factor
    return replace(factor, amount=sp.expand(factor.amount) - number + exact)


def almost_right_angles(mechanism: Mechanism) -> str:
    """The message about angles of a chain that are almost multiples of 90°; empty if there are none."""
    factors = mechanism.chain.factors if mechanism.chain is not None else ()
    turns = (number_in(f.amount) for f in factors if f.motion is Motion.TURN)
    return "; ".join(dict.fromkeys(text for n in turns if (text := almost_right(n)) is not None))


def as_right_angles(number: sp.Expr) -> sp.Expr | None:
    """The exact multiple of 90° that a number stands for; None if it stands for none."""
    exact = sp.nsimplify(number.subs(DEGREE, sp.pi / 180) / _RIGHT) if not number.has(sp.Float) else None
    if exact is not None and exact.is_Integer:
        return exact * _RIGHT
    value = in_radians(number)
    nearest = round(value / float(_RIGHT))
    off = abs(value - nearest * float(_RIGHT))
    if off <= _ANY_DECIMALS or _is_rounded(number, value, nearest):
        return nearest * _RIGHT
    return None


def _is_rounded(number: sp.Expr, value: float, nearest: int) -> bool:
    """Whether a decimal is a multiple of 90°, rounded to as many digits as the decimal has."""
    decimals = len(repr(value).partition(".")[2])
    return number.is_Float and decimals >= _DECIMALS and round(nearest * float(_RIGHT), decimals) == value


def almost_right(number: sp.Expr) -> str | None:
    """The message about an angle that is almost a multiple of 90°; None for any other angle."""
    value = in_radians(number)
    nearest = round(value / float(_RIGHT))
    off = abs(value) - abs(nearest) * float(_RIGHT)
    if nearest == 0 or abs(off) > _NEARLY or as_right_angles(number) is not None:
        return None
    side = "short of" if off < 0 else "more than"
    many = "a right angle" if abs(nearest) == 1 else f"{abs(nearest)} right angles"
    exact = sp.sstr(sp.sign(value) * abs(nearest) * _RIGHT)
    literal = sp.sstr(number, full_prec=False)
    return f"{literal} is {abs(off):.1g} rad {side} {many}; write {exact} or {90 * nearest}*DEGREE"


def with_symbols(value: Any, symbols: Mapping[Any, sp.Expr]) -> Any:
    """A copy of nested data in which symbols are replaced."""
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return value.xreplace(symbols)
    if isinstance(value, tuple):
        return tuple(with_symbols(one, symbols) for one in value)
    if isinstance(value, Parameter) and value.symbol in symbols:
        symbol = symbols[value.symbol]
        return replace(value, symbol=symbol, name=symbol.name, given=value.given_name)
    if is_dataclass(value) and not isinstance(value, type):
        own = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        changed = {name: with_symbols(one, symbols) for name, one in own.items()}
        return replace(value, **changed)
    return value
