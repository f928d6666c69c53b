"""The residual of a trial multiplied over the signs of all its roots: a function of the joint without roots.

    P + Q w, w = root(D)   →   P² - Q² D

Every value is a sum of products of roots, with factors that have none: a factor for each product. Signs that choose
between two solutions are taken as positive, since the product is over both. What is divided by is kept: multiplied by
powers of it, the product is a wave (see `wave`). Whether a factor vanishes identically, and whether a radicand is the
square of one that is known, is tested at poses of random machines.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.ir.interpret import Array, evaluate
from derive.ir.passes import needed_lets
from derive.ir.primitives import Root, Select, ToReal
from derive.ir.program import Let
from derive.ir.symbols import is_count, real
from derive.solver.unsolved import Unsolved

Roots = frozenset[sp.Symbol]
Value = dict[Roots, sp.Expr]
"""A factor for each product of roots."""
_PLAIN: Roots = frozenset()
_MOST_ROOTS = 8
_NOTHING = 1e-10
_EQUAL = 1e-6
"""Two forms of a value differ by no more than this share of it, or of one: by the digits that the worse one loses."""


@dataclass(frozen=True)
class Product:
    """The product of the residual over the signs of its roots, and what was divided by; all without roots."""

    statements: tuple[Let, ...]
    value: sp.Expr
    divisors: tuple[sp.Symbol, ...]


def product_of(statements: Sequence[Let], residual: sp.Expr, samples: Mapping[str, Array]) -> Product:
    """The product, by the statements of a trial. samples: inputs of the trial at poses of machines that it solves.

    Raises `Unsolved` where a value is no fraction of products of roots.
    """
    algebra = _Algebra(dict(samples))
    for s in needed_lets(statements, [residual]):
        algebra.read(s)
    value = algebra.of(residual)
    for root in reversed(algebra.squares):
        value = algebra.without(value, root)
    return Product(tuple(algebra.lets), value.get(_PLAIN, sp.Integer(0)), tuple(algebra.divisors))


@dataclass
class _Algebra:
    """Values as sums of products of roots, the statements that compute their factors, and these at the samples."""

    numbers: dict[str, Array]
    known: dict[sp.Symbol, Value] = field(default_factory=dict)
    lets: list[Let] = field(default_factory=list)
    squares: dict[sp.Symbol, Value] = field(default_factory=dict)
    within: Array = field(default_factory=lambda: np.ones((1, 1), dtype=bool))
    """The samples at which every root is real."""
    divisors: list[sp.Symbol] = field(default_factory=list)

    def read(self, s: Let) -> None:
        """Take in a statement."""
        chosen = self._chosen(s.value)
        if isinstance(chosen, ToReal) or is_count(chosen):
            self.known[s.name], self.numbers[s.name.name] = {_PLAIN: sp.Integer(1)}, np.ones(1)
        elif not chosen.free_symbols & self.known.keys() and not chosen.has(Root):
            self._bind(s.name, chosen)
        else:
            self.known[s.name] = self._named(s.name.name, self.of(chosen))
            self.numbers[s.name.name] = self._number(self._symbol(self.known[s.name]))

    def of(self, value: sp.Expr) -> Value:
        """The value of an expression."""
        value = self._chosen(value)
        if isinstance(value, ToReal):
            return {_PLAIN: sp.Integer(1)}
        if not value.free_symbols & self.known.keys() and not value.has(Root):
            return {_PLAIN: value}
        if isinstance(value, sp.Symbol):
            return self.known[value]
        if isinstance(value, sp.Add):
            return self._kept(_sum(map(self.of, value.args)))
        if isinstance(value, sp.Mul):
            return reduce(self._times, map(self.of, value.args))
        if isinstance(value, sp.Pow) and value.exp.is_Integer:
            power = reduce(self._times, [self.of(value.base)] * abs(int(value.exp)))
            return power if value.exp > 0 else self._inverse(power)
        if isinstance(value, Root):
            return self._root(self.of(value.args[0]))
        raise Unsolved(f"{value} is no fraction of products of roots")

    def without(self, value: Value, root: sp.Symbol) -> Value:
        """The product of a value with the one that has the other sign of a root."""
        odd = {roots - {root}: f for roots, f in value.items() if root in roots}
        if not odd:
            return value
        even = {roots: f for roots, f in value.items() if root not in roots}
        other = self._times(self._times(odd, odd), self.squares[root])
        difference = _sum((self._times(even, even), {r: -f for r, f in other.items()}))
        return self._named(f"product_{len(self.lets)}", self._kept(difference))

    def _chosen(self, value: sp.Expr) -> sp.Expr:
        """A value where nothing is singular: that of the side that all samples take at which every root is real. Where
        two sides are the same value in two forms, of which one keeps more digits, it is the form for all poses.
        """
        while isinstance(value, Select):
            numbers = {name: np.real(v) for name, v in self.numbers.items()}
            said = np.asarray(evaluate(value.args[0], numbers), dtype=bool)
            if self._all_within(said):
                value = value.args[1]
            elif self._all_within(~said) or self._all_within(~said | self._is_same(*value.args[1:])):
                value = value.args[2]
            else:
                raise Unsolved(f"{value} has a choice")
        return value

    def _all_within(self, holds: NDArray[np.bool_]) -> bool:
        """Whether a condition holds at all samples at which every root is real."""
        shape = np.broadcast_shapes(holds.shape, self.within.shape)
        return bool(np.broadcast_to(holds, shape)[np.broadcast_to(self.within, shape)].all())

    def _is_same(self, first: sp.Expr, second: sp.Expr) -> NDArray[np.bool_]:
        """At which samples two expressions are equal."""
        return np.asarray(np.isclose(self._number(first), self._number(second), rtol=_EQUAL, atol=_EQUAL))

    def _bind(self, name: sp.Symbol, value: sp.Expr) -> sp.Symbol:
        self.lets.append(Let(name, value))
        self.numbers[name.name] = self._number(value)
        return name

    def _symbol(self, value: Value) -> sp.Expr:
        return sp.Add(*[sp.Mul(f, *sorted(roots, key=str)) for roots, f in value.items()])

    def _number(self, value: sp.Expr) -> Array:
        return np.asarray(evaluate(value, self.numbers))

    def _named(self, word: str, value: Value) -> Value:
        """The value with a name for each factor that is no name or number."""
        found: Value = {}
        for roots, f in value.items():
            ending = "".join(f"_{r.name}" for r in sorted(roots, key=str))
            is_named = f.is_Atom or (-f).is_Atom
            found[roots] = f if is_named else self._bind(real(f"{word.removesuffix('_tried')}{ending}_part"), f)
        return found

    def _kept(self, value: Value) -> Value:
        """The value without factors that vanish identically."""
        return {roots: f for roots, f in value.items() if not self._vanishes(f)}

    def _vanishes(self, factor: sp.Expr) -> bool:
        terms = sp.Add.make_args(factor)
        size = sum(np.abs(self._number(t)) for t in terms)
        return factor == 0 or bool(np.all(np.abs(self._number(factor)) <= _NOTHING * size))

    def _times(self, first: Value, second: Value) -> Value:
        parts: list[Value] = []
        for one, f in first.items():
            for other, g in second.items():
                part: Value = {one ^ other: f * g}
                for root in sorted(one & other, key=str):
                    part = self._times(part, self.squares[root])
                parts.append(part)
        return self._kept(self._named(f"factor_{len(self.lets)}", _sum(parts)))

    def _inverse(self, value: Value) -> Value:
        """One divided by a value: multiplied by those with other signs, it is divided by a number without roots."""
        above: Value = {_PLAIN: sp.Integer(1)}
        for root in reversed(self.squares):
            if any(root in roots for roots in value):
                other = {roots: -f if root in roots else f for roots, f in value.items()}
                above, value = self._times(above, other), self._times(value, other)
        below = value.get(_PLAIN, sp.Integer(0))
        if value.keys() - {_PLAIN} or below == 0:
            raise Unsolved("it is divided by what may vanish everywhere")
        divisor = self._not_zero(self._divisor(below))
        return {roots: f / divisor for roots, f in above.items()}

    def _not_zero(self, divisor: sp.Expr) -> sp.Expr:
        """The divisor, or 1 where it is zero: a power of it stands before the product there."""
        name = real(f"{divisor}_or_1")
        if name.name not in self.numbers:
            self._bind(name, Select(sp.Gt(sp.Abs(divisor), 0), divisor, sp.Integer(1)))
        return name

    def _divisor(self, value: sp.Expr) -> sp.Expr:
        """The name of what is divided by; an equal one has its name already."""
        number = self._number(value)
        for known in self.divisors:
            if np.allclose(self.numbers[known.name], number, rtol=_NOTHING, atol=0.0):
                return known
        name = value if value.is_Symbol else self._bind(real(f"divisor_{len(self.lets)}"), value)
        if _varies(number):
            self.divisors.append(name)
        return name

    def _root(self, square: Value) -> Value:
        """The root of a value: another name, or what it is the square of."""
        if not square:
            return {}
        for name, known in self.squares.items():
            if self._are_equal(square, known):
                return {frozenset((name,)): sp.Integer(1)}
            if self._are_equal(square, self._times(known, known)):
                return known
        plain = square.get(_PLAIN)
        if len(square) == 1 and plain is not None and not _varies(self._number(plain)):
            return {_PLAIN: self._bind(real(f"length_{len(self.lets)}"), Root(plain))}
        if len(self.squares) == _MOST_ROOTS:
            raise Unsolved("too many roots stand in it")
        name = real(f"root_{len(self.squares) + 1}")
        self.squares[name] = square
        number = np.sqrt(np.asarray(self._number(self._symbol(square)), dtype=complex))
        self.numbers[name.name], self.within = number, self.within & (number.imag <= _NOTHING * np.abs(number))
        return {frozenset((name,)): sp.Integer(1)}

    def _are_equal(self, first: Value, second: Value) -> bool:
        return not self._kept(_sum((first, {r: -f for r, f in second.items()})))


def _varies(values: Array) -> bool:
    """Whether a value changes with the joint: along the last axis of the samples."""
    return np.ndim(values) > 0 and bool(np.ptp(np.real(values), axis=-1).max() > _NOTHING * np.abs(values).max())


def _sum(values: Iterable[Value]) -> Value:
    found: Value = {}
    for value in values:
        for roots, f in value.items():
            found[roots] = found.get(roots, sp.Integer(0)) + f
    return {roots: f for roots, f in found.items() if f != 0}
