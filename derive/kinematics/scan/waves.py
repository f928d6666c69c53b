"""Values of a straight-line program as waves in one angle t, whose coefficients are computed by a program, too.

    Let(a, k + l cos t)        ->  1: k, cos t: l
    Let(b, a^2)                ->  1: k^2 + l^2/2, cos t: 2 k l, cos 2t: l^2/2
    Let(w, root(b)), w^2       ->  b again; w alone stays a name, whose coefficients are waves

Nothing is expanded: a coefficient that is no single name gets one, so that what the program has factored stays so.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce

import numpy as np
import sympy as sp

from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, ToReal
from derive.ir.program import Let, Output
from derive.ir.symbols import is_count, real

Wave = dict[int, sp.Expr]
"""The factors of cos nt, at n, and of sin nt, at -n."""
Roots = frozenset[sp.Symbol]
Value = dict[Roots, Wave]
"""A wave for each product of roots."""
NO_ROOT: Roots = frozenset()
DEGREE_TWO = (2, -2, 1, -1, 0)
"""The waves of a conic in cosine and sine."""
_HIGHEST, _ROOTS = 4, 3
"""A conic may be the square of one; of higher waves, and of more roots, there would be too many to go on."""
_SEED, _SAMPLES, _NOTHING = 71, 8, 1e-11


class NoWaveError(Exception):
    """A value is no sum of waves: it has a choice, or divides by one."""


@dataclass
class Waves:
    """The values of the names of a program as waves, with the statements that compute the coefficients."""

    known: dict[sp.Symbol, Value]
    """At first the cosine and the sine of the angle."""
    lets: list[Let] = field(default_factory=list)
    squares: dict[sp.Symbol, Value] = field(default_factory=dict)
    """The squares of the names of roots."""
    signs: set[sp.Symbol] = field(default_factory=set)

    def read(self, statements: Iterable[Let]) -> None:
        """Take in statements, in their order; those that do not depend on the angle are computed as they are."""
        for s in statements:
            if s.name in self.known:
                continue
            if not s.value.free_symbols & self.known.keys():
                self.lets.append(s)
                self.signs |= {s.name} if isinstance(s.value, ToReal) else set()
            else:
                self.known[s.name] = self._named(s.name, self.of(s.value))

    def of(self, value: sp.Expr) -> Value:
        """The value of an expression."""
        if not value.free_symbols & self.known.keys():
            return {NO_ROOT: {0: value}}
        if isinstance(value, sp.Symbol):
            return self.known[value]
        if isinstance(value, sp.Add):
            return _sum(map(self.of, value.args))
        if isinstance(value, sp.Mul):
            return reduce(self.product, map(self.of, value.args))
        if isinstance(value, sp.Pow) and value.exp.is_Integer and value.exp > 0:
            return reduce(self.product, [self.of(value.base)] * int(value.exp))
        if isinstance(value, Root):
            return self._root(self.of(value.args[0]))
        raise NoWaveError(f"{value} is no wave")

    def _root(self, square: Value) -> Value:
        name = next((n for n, known in self.squares.items() if known == square), sp.Dummy("w"))
        self.squares[name] = square
        return {frozenset((name,)): {0: sp.Integer(1)}}

    def product(self, first: Value, second: Value) -> Value:
        """The product of two values."""
        found: Value = {}
        for one, wave in first.items():
            for other, factor in second.items():
                part: Value = {one ^ other: self._product(wave, factor)}
                for root in sorted(one & other, key=str):
                    part = self.product(part, self.squares[root])
                found = _sum((found, part))
        return found

    def _product(self, first: Wave, second: Wave) -> Wave:
        if max(map(abs, first)) + max(map(abs, second)) > _HIGHEST or len(self.squares) > _ROOTS:
            raise NoWaveError("no conic comes of it")
        ones = {sign**2: sp.Integer(1) for sign in self.signs}
        found: dict[int, list[sp.Expr]] = {}
        for m, a in first.items():
            for n, b in second.items():
                for k, factor in _terms(m, n):
                    found.setdefault(k, []).append((a * b * factor).xreplace(ones))
        return {k: total for k, terms in found.items() if (total := sp.Add(*terms)) != 0}

    def _named(self, name: sp.Symbol, value: Value) -> Value:
        """The value with a name for each coefficient that is no name, number or sign."""
        return {
            roots: {n: self._name(f"{name.name}_{_word(n)}{len(roots) or ''}", f) for n, f in wave.items()}
            for roots, wave in value.items()
        }

    def _name(self, name: str, factor: sp.Expr) -> sp.Expr:
        if factor.is_Atom or (-factor).is_Atom or factor.free_symbols & self.signs:
            return factor
        self.lets.append(Let(real(name), factor))
        return real(name)

    def vanishing(self, factors: Sequence[sp.Expr]) -> set[sp.Expr]:
        """The coefficients that vanish identically: tested at random numbers, relative to the size of their terms."""
        named = {let.name: let.value for let in self.lets}
        written = {f: f.xreplace(named) for f in factors}
        sums = [(f, [s for s in sp.Mul.make_args(v) if isinstance(s, sp.Add)]) for f, v in written.items()]
        outputs = [
            Output(f"{word}_{k}_{n}", value)
            for k, (_, parts) in enumerate(sums)
            for n, part in enumerate(parts)
            for word, value in (("sum", part), ("terms", sp.Add(*map(sp.Abs, part.args))))
        ]
        program, rng = normalise("coefficients", self.lets, outputs), np.random.default_rng(_SEED)
        samples = {
            s.name: rng.choice([-1.0, 1.0], _SAMPLES) if is_count(s) else rng.uniform(0.5, 1.5, _SAMPLES)
            for s in program.inputs
        }
        found, _ = run(program, samples)
        return {f for f, v in written.items() if v == 0} | {
            f
            for k, (f, parts) in enumerate(sums)
            for n in range(len(parts))
            if np.all(np.abs(found[f"sum_{k}_{n}"]) <= _NOTHING * found[f"terms_{k}_{n}"])
        }


def wave_at(wave: Wave, c: sp.Expr, s: sp.Expr) -> sp.Expr:
    """A wave of the second degree at an angle with this cosine and sine."""
    known = {0: sp.Integer(1), 1: c, -1: s, 2: (c - s) * (c + s), -2: 2 * c * s}
    return sp.Add(*[factor * known[n] for n, factor in wave.items()])


def size_of(wave: Wave) -> sp.Expr:
    """The size of the terms of which a wave is the sum."""
    return sp.Add(*map(sp.Abs, wave.values()))


def derivatives(wave: Wave, c: sp.Expr, s: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Value, slope and bend of a wave of the second degree at an angle with this cosine and sine."""
    slope = {-n: -n * factor for n, factor in wave.items() if n != 0}
    bend = {n: -(n**2) * factor for n, factor in wave.items() if n != 0}
    return wave_at(wave, c, s), wave_at(slope, c, s), wave_at(bend, c, s)


def _word(n: int) -> str:
    if n == 0:
        return "level"
    return f"{'cos' if n > 0 else 'sin'}{abs(n) if abs(n) > 1 else ''}"


def _terms(m: int, n: int) -> list[tuple[int, sp.Rational]]:
    """The waves of which the product of two is the sum, with their factors."""
    half = sp.Rational(1, 2)
    if m == 0 or n == 0:
        return [(m + n, sp.Integer(1))]
    if m > 0 and n > 0:
        return [(abs(m - n), half), (m + n, half)]
    if m < 0 and n < 0:
        return [(abs(m - n), half), (-m - n, -half)]
    s, c = (-m, n) if m < 0 else (-n, m)
    found = [(-s - c, half)]
    return found if s == c else [*found, (-abs(s - c), half if s > c else -half)]


def _sum(values: Iterable[Mapping[Roots, Wave]]) -> Value:
    found: dict[Roots, Wave] = {}
    for value in values:
        for roots, wave in value.items():
            own = found.setdefault(roots, {})
            for n, factor in wave.items():
                own[n] = own.get(n, sp.Integer(0)) + factor
    return {roots: left for roots, wave in found.items() if (left := {n: f for n, f in wave.items() if f != 0})}
