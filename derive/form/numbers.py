"""Names for the numbers in a chain: many descriptions state their dimensions as numbers, not as parameters.

An angle that is no multiple of 90° and a length become fixed parameters. No user gives them, and the derivation treats
them like those that users give: their sines and cosines are computed once, and no product holds a long decimal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import sympy as sp

from derive.description.amounts import STATED, in_radians, number_in, with_symbols, without_decimals
from derive.description.dimensions import Parameter, Role
from derive.description.mechanism import Mechanism
from derive.geometry.frames import Chain, Factor, Motion
from derive.ir.constants import DEGREE
from derive.ir.symbols import Names, cosine, real, sine

_AXES = "xyz"


def with_named_numbers(mechanism: Mechanism) -> Mechanism:
    """The mechanism with every number of its chain under a name."""
    if mechanism.chain is None:
        return mechanism
    factors = mechanism.chain.factors
    numbers = [number_in(f.amount) for f in factors]
    turns = zip(factors, numbers, strict=True)
    angles = NamedAngles([n for f, n in turns if f.motion is Motion.TURN and not is_right(n)])
    lengths = _Lengths(Names([p.name for p in mechanism.parameters]))
    named = (_named(f, n, angles, lengths) for f, n in zip(factors, numbers, strict=True))
    chain = Chain(tuple(replace(f, amount=amount) for f, amount in zip(factors, named, strict=True)))
    fixed = (*lengths.found, *map(fixed_angle, angles.named))
    return replace(mechanism, chain=chain, parameters=(*mechanism.parameters, *fixed))


def _named(factor: Factor, number: sp.Expr, angles: NamedAngles, lengths: _Lengths) -> sp.Expr:
    if factor.motion is Motion.FLIP or number == 0:
        return without_decimals(factor.amount)
    if factor.motion is Motion.SHIFT:
        named = lengths.named(number, factor.axis)
    else:
        named = number if is_right(number) else angles.written(number)
    return without_decimals(sp.expand(factor.amount) - number) + named


class _Lengths:
    """The lengths of a chain, found by their absolute values."""

    def __init__(self, names: Names) -> None:
        self.found: list[Parameter] = []
        self._names = names

    def named(self, number: sp.Expr, axis: int) -> sp.Expr:
        """A number as the length with its absolute value, or as the negative of that length."""
        size = sp.Abs(number)
        known = next((p for p in self.found if p.fixed == size), None)
        if known is None:
            along = [p for p in self.found if p.name.startswith(f"shift_{_AXES[axis]}")]
            name = self._names.fresh(f"shift_{_AXES[axis]}_{len(along) + 1}").name
            known = _fixed(name, Role.LENGTH, sp.Symbol(name, positive=True), size)
            self.found.append(known)
        return known.symbol if number == size else -known.symbol


def fixed_angle(angle: NamedAngle) -> Parameter:
    """The parameter that holds a named angle; no user gives it."""
    return _fixed(angle.symbol.name, Role.ANGLE, angle.symbol, angle.degrees)


def _fixed(name: str, role: Role, symbol: sp.Symbol, value: sp.Expr) -> Parameter:
    is_angle = role is Role.ANGLE
    unit, nominal = ("deg", in_radians(value * DEGREE) * 180 / float(sp.pi)) if is_angle else ("u", value)
    meaning = f"{'angle' if is_angle else 'length'} that the description states as a number{', in degrees' * is_angle}"
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


def with_named_loop_angles(mechanism: Mechanism) -> Mechanism:
    """The mechanism with names for the angles whose sines and cosines stand in the equations of its loop as numbers.

    Each becomes a fixed angle of at most 45 degrees, and right angles; one that SymPy writes as roots stays as it is.
    """
    if mechanism.chain is not None:
        return mechanism
    functions = {f for e in mechanism.equations for f in e.atoms(sp.sin, sp.cos) if f.is_number}
    table: dict[sp.Expr, sp.Expr] = {}
    angles: dict[sp.Expr, NamedAngle] = {}
    for one in sorted(functions, key=sp.default_sort_key):
        quarters = sp.Integer(round(float(2 * one.args[0] / sp.pi)))
        rest = sp.expand(without_decimals(one.args[0]) - quarters * sp.pi / 2)
        size = sp.Abs(rest)
        angle = angles.setdefault(size, of_degrees(size * 180 / sp.pi))
        table[one] = one.func(quarters * sp.pi / 2 + sp.sign(rest) * angle.symbol * DEGREE)
    if not table:
        return mechanism
    fixed = tuple(map(fixed_angle, angles.values()))
    renamed: Mechanism = with_symbols(mechanism, table)
    return replace(renamed, home=mechanism.home, parameters=(*mechanism.parameters, *fixed))


_RIGHT = sp.pi / 2


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
    found: Mechanism = with_symbols(mechanism, {d: n for d, n in exact.items() if n.q <= STATED})
    return found


def is_right(number: sp.Expr) -> bool:
    """Whether an angle is an exact multiple of 90°."""
    return bool((number / _RIGHT).is_Integer)


_SAME = 1e-9
"""Angles that differ by less than this (radians) are equal."""
_THOUSANDTHS = 1000
"""An angle that is a whole number of thousandths of a degree is named by its degrees."""
_MULTIPLES = (-2, -1, 0, 1, 2)


@dataclass(frozen=True)
class NamedAngle:
    """The name of an angle, and its value in degrees."""

    symbol: sp.Symbol
    degrees: sp.Expr


class NamedAngles:
    """The named angles of a chain, and every other angle written as a sum of few of them, and of right angles: 60° and
    -60° have one name, and so have 45° and 135°.
    """

    def __init__(self, numbers: Sequence[sp.Expr]) -> None:
        """numbers: those that are no multiple of 90°, in radians; in degrees with `DEGREE`."""
        self.named: list[NamedAngle] = []
        self._written: dict[sp.Expr, sp.Expr] = {}
        for number in sorted(dict.fromkeys(numbers), key=lambda n: abs(in_radians(n))):
            found = next(self._sums(in_radians(number)), None)
            if found is None:
                self.named.append(_of(number))
                found = next(self._sums(in_radians(number)))
            self._written[number] = found

    def written(self, number: sp.Expr) -> sp.Expr:
        """A number as a sum of named angles and right angles."""
        return self._written[number]

    def _sums(self, value: float) -> Iterator[sp.Expr]:
        """The sums of right angles and of few named angles that have a value, the simplest first."""
        known = [in_radians(angle.degrees * DEGREE) for angle in self.named]
        right = float(_RIGHT)
        for count in (1, 2):
            for chosen in combinations(range(len(known)), count):
                for factors in sorted(product(_MULTIPLES, repeat=count), key=lambda f: [abs(x) for x in f]):
                    rest = value - sum(f * known[k] for f, k in zip(factors, chosen, strict=True))
                    nearest = round(rest / right)
                    if 0 not in factors and abs(rest - nearest * right) < _SAME:
                        parts = [f * self.named[k].symbol * DEGREE for f, k in zip(factors, chosen, strict=True)]
                        yield sp.Add(nearest * _RIGHT, *parts)


def of_degrees(degrees: sp.Expr) -> NamedAngle:
    """An angle under the name that its degrees give it."""
    return NamedAngle(real(f"angle_{_digits(degrees)}_deg"), degrees)


def _of(number: sp.Expr) -> NamedAngle:
    """The angle that is left of a number without its right angles: 45° of 135°; a decimal in radians stays whole."""
    degrees = abs(in_radians(number)) * 180 / float(sp.pi)
    rounded = sp.Rational(round(degrees * _THOUSANDTHS), _THOUSANDTHS)
    if abs(degrees - float(rounded)) * float(sp.pi) / 180 < _SAME:
        return of_degrees(rounded % 90)
    size = sp.Float(abs(in_radians(number)))
    return NamedAngle(real(f"angle_{_digits(size)}_rad"), size / DEGREE)


def _digits(number: sp.Expr) -> str:
    """A number as it stands in a name: 22_5 for 22.5."""
    text = repr(float(number)).removesuffix(".0")
    return text.replace(".", "_").replace("-", "minus").replace("+", "")
