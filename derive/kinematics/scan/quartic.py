"""The residual of a trial as a conic in the cosine and the sine of the scanned joint, where it is one.

Where the trial has no two roots, the residual must be a polynomial of degree two. Where it has, its root w is the root
of a polynomial D, and the residual is P + Q w: it vanishes, on one of the two sides, where P^2 = Q^2 D. This is a
conic where P is of degree one, Q is a number and D is of degree two.

    z_of_a2 = ... + k cos t, reach = root(z_of_a2^2 + ...), residual = reach^2 - ...      ->  P
    sin_a3 = sign root(D), ...,  residual = P + sign q root(D)                            ->  P^2 - q^2 D

An arm of three axes whose residual is of this kind is solved for all of its up to four solutions (D. L. Pieper, 1968).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.primitives import Root, ToReal
from derive.ir.program import Let
from derive.ir.symbols import SIDE, TRIED
from derive.kinematics.scan.waves import NO_ROOT, NoWaveError, Wave, Waves, size_of

_ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Quartic:
    """The residual P + Q w, w = root(D), as waves."""

    statements: tuple[Let, ...]
    """What computes the coefficients."""
    plain: Wave
    factor: sp.Expr
    """Q on the wanted side; zero where the residual has no root."""
    square: Wave

    @property
    def has_sides(self) -> bool:
        """Whether the residual is another one on the other side."""
        return bool(self.factor != 0)

    @property
    def terms(self) -> sp.Expr:
        """The size of the terms of which the residual is the sum."""
        return size_of(self.plain) + sp.Abs(self.factor) * Root(size_of(self.square))


def quartic_of(statements: Sequence[Let], residual: sp.Expr) -> Quartic | None:
    """The residual as a conic; None where it is none. statements: those of a trial."""
    start = {s.name: s.value for s in statements if s.value in (sp.cos(TRIED), sp.sin(TRIED))}
    waves = Waves({name: {NO_ROOT: {1 if isinstance(v, sp.cos) else -1: sp.Integer(1)}} for name, v in start.items()})
    try:
        waves.read(_wanted(_read_by(statements, residual)))
        value = waves.of(residual)
    except NoWaveError:
        return None
    nothing = waves.vanishing([f for wave in value.values() for f in wave.values()])
    value = {roots: {n: f for n, f in wave.items() if f not in nothing} for roots, wave in value.items()}
    odd = [roots for roots, wave in value.items() if roots and wave]
    plain = value.get(NO_ROOT, {})
    if not odd:
        return Quartic(tuple(waves.lets), plain, _ZERO, {}) if _degree(plain) <= 2 else None
    (roots, *others) = odd
    square = waves.squares[next(iter(roots))]
    is_conic = not others and len(roots) == 1 and [*square] == [NO_ROOT] and _degree(square[NO_ROOT]) <= 2
    if not is_conic or _degree(plain) > 1 or _degree(value[roots]) > 0:
        return None
    return Quartic(tuple(waves.lets), plain, value[roots][0], square[NO_ROOT])


def _degree(wave: Wave) -> int:
    return max(map(abs, wave), default=0)


def _read_by(statements: Sequence[Let], value: sp.Expr) -> list[Let]:
    """The statements that a value reads, directly or not."""
    wanted, found = set(value.free_symbols), []
    for s in reversed(statements):
        if s.name in wanted:
            found.append(s)
            wanted |= s.value.free_symbols
    return found[::-1]


def _wanted(statements: Iterable[Let]) -> list[Let]:
    """The statements on the wanted side."""
    here = {SIDE: sp.Integer(1)}
    return [replace(s, value=s.value.xreplace(here)) if isinstance(s.value, ToReal) else s for s in statements]
