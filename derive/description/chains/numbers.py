"""Names for the numbers in a chain: many descriptions state their dimensions as numbers, not as parameters.

An angle that is no multiple of 90° and a length become fixed parameters. No user gives them, and the derivation treats
them like those that users give: their sines and cosines are computed once, and no product holds a long decimal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import sympy as sp

from derive.description.chains.turns import NamedAngle, NamedAngles, almost_right, as_right_angles, in_radians
from derive.description.dimensions import Parameter, Role
from derive.description.mechanism import Mechanism
from derive.geometry.frames import Chain, Factor, Motion
from derive.ir.constants import DEGREE
from derive.ir.names import Names
from derive.ir.symbols import cosine, sine

_AXES = "xyz"


def with_named_numbers(mechanism: Mechanism) -> Mechanism:
    """The mechanism with every number of its chain under a name."""
    if mechanism.chain is None or not any(number_in(f.amount) != 0 for f in mechanism.chain.factors):
        return mechanism
    factors = tuple(_merged(mechanism.chain.factors))
    names = Names([p.name for p in mechanism.parameters])
    angles = NamedAngles([n for n in numeric_turns(factors) if as_right_angles(n) is None])
    lengths = _Lengths(names)
    amounts = [_named(f, angles, lengths) for f in factors]
    kept = tuple(replace(f, amount=a) for f, a in zip(factors, amounts, strict=True) if a != 0)
    fixed = (*lengths.found, *map(_fixed_angle, angles.named))
    return replace(mechanism, chain=Chain(kept), parameters=(*mechanism.parameters, *fixed))


def almost_right_angles(mechanism: Mechanism) -> str:
    """The message about angles of a chain that are almost multiples of 90°; empty where there are none."""
    factors = mechanism.chain.factors if mechanism.chain is not None else ()
    return "; ".join(dict.fromkeys(told for n in numeric_turns(factors) if (told := almost_right(n)) is not None))


def numeric_turns(factors: Sequence[Factor]) -> list[sp.Expr]:
    """The numbers in the angles of a chain."""
    found = (number_in(f.amount) for f in factors if f.motion is Motion.TURN)
    return [number for number in found if number != 0]


def number_in(amount: sp.Expr) -> sp.Expr:
    """The sum of the terms of an amount that are numbers; an angle may be in degrees."""
    return sp.Add(*[t for t in sp.Add.make_args(sp.expand(amount)) if not t.free_symbols - {DEGREE}])


def _named(factor: Factor, angles: NamedAngles, lengths: _Lengths) -> sp.Expr:
    number = number_in(factor.amount)
    if factor.motion is Motion.FLIP:
        return factor.amount
    if number == 0:
        return _without_decimals(factor.amount)
    if factor.motion is Motion.SHIFT:
        named = lengths.named(number, factor.axis)
    else:
        exact = as_right_angles(number)
        if exact == number:
            return _without_decimals(factor.amount)
        named = angles.written(number) if exact is None else exact
    return _without_decimals(sp.expand(factor.amount) - number) + named


def _without_decimals(amount: sp.Expr) -> sp.Expr:
    """The amount with fractions for its decimals: half of a joint is exactly half."""
    return amount.xreplace({f: _fraction(f) for f in amount.atoms(sp.Float)})


def _fraction(number: sp.Expr) -> sp.Expr:
    """The number as it was written: 0.425 is 17/40."""
    return sp.Rational(repr(float(number))) if number.has(sp.Float) else number


def _merged(factors: Sequence[Factor]) -> Iterator[Factor]:
    """The factors, with the numbers of neighbouring shifts along one axis in the first of them."""
    first = 0
    while first < len(factors):
        last = first
        while last < len(factors) and factors[last].motion is Motion.SHIFT:
            last += 1
        yield from _one_number_an_axis(factors[first:last])
        yield from factors[last : last + 1]
        first = last + 1


def _one_number_an_axis(shifts: Sequence[Factor]) -> Iterator[Factor]:
    numbers = [number_in(f.amount) for f in shifts]
    for place, factor in enumerate(shifts):
        own = [k for k, f in enumerate(shifts) if f.axis == factor.axis and numbers[k] != 0]
        if len(own) < 2 or place not in own:
            yield factor
            continue
        total = sp.Add(*[_fraction(numbers[k]) for k in own]) if place == own[0] else sp.Integer(0)
        yield replace(factor, amount=sp.expand(factor.amount) - numbers[place] + total)


class _Lengths:
    """The lengths of a chain, found by their absolute values."""

    def __init__(self, names: Names) -> None:
        self.found: list[Parameter] = []
        self._names = names

    def named(self, number: sp.Expr, axis: int) -> sp.Expr:
        """A number as the length with its absolute value, or as the negative of that length; zero stays zero."""
        size = sp.Abs(_fraction(number))
        if size == 0:
            return sp.Integer(0)
        known = next((p for p in self.found if p.fixed == size), None)
        if known is None:
            along = [p for p in self.found if p.name.startswith(f"shift_{_AXES[axis]}")]
            name = self._names.fresh(f"shift_{_AXES[axis]}_{len(along) + 1}").name
            known = _fixed(name, Role.LENGTH, sp.Symbol(name, positive=True), size)
            self.found.append(known)
        return known.symbol if _fraction(number) == size else -known.symbol


def _fixed_angle(angle: NamedAngle) -> Parameter:
    return _fixed(angle.symbol.name, Role.ANGLE, angle.symbol, angle.degrees)


def _fixed(name: str, role: Role, symbol: sp.Symbol, value: sp.Expr) -> Parameter:
    is_angle = role is Role.ANGLE
    unit, nominal = ("deg", in_radians(value * DEGREE) * 180 / float(sp.pi)) if is_angle else ("u", value)
    meaning = f"{'angle' if is_angle else 'length'} that the chain states as a number{', in degrees' * is_angle}"
    return Parameter(symbol, name, role, meaning, unit, -1e9, 1e9, False, None, float(nominal), value)


def fixed_numbers(mechanism: Mechanism) -> dict[sp.Symbol, sp.Expr]:
    """The values of the names of numbers of the chain, and of the sines and cosines of such angles."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for p in (p for p in mechanism.parameters if p.fixed is not None):
        found[p.symbol] = sp.Float(p.nominal)
        if p.role is Role.ANGLE:
            radians = sp.Float(p.nominal) * sp.pi / 180
            found |= {sine(p.symbol): sp.sin(radians).evalf(), cosine(p.symbol): sp.cos(radians).evalf()}
    return found
