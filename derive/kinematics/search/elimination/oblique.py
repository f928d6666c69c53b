"""Slides at any angle to the axes before and behind them, gathered in one place of the ring.

The form of a chain writes such a slide along the axes of its frames, in up to three factors, some of them behind a turn
about their own axis. Here the frame is turned to the direction of the slide, and back.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.geometry.frames import Factor, Motion
from derive.ir.primitives import Root

Factors = tuple[Factor, ...]


@dataclass(frozen=True)
class Oblique:
    """A slide along a direction, which is not that of an axis of its frame."""

    slide: sp.Symbol
    direction: tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Turned:
    """Turns that take an axis of the frame (0, 1, 2) to a direction: axis, cosine and sine of each."""

    axis: int
    turns: tuple[tuple[int, sp.Expr, sp.Expr], ...]


def gathered(factors: Factors, slides: Collection[sp.Symbol], moving: set[sp.Symbol]) -> tuple[Factor | Oblique, ...]:
    """The factors with each slide of several parts in one place, if there is one from which no joint turns a part.

    moving: the values of all joints that are solved.
    """
    found: list[Factor | Oblique] = list(factors)
    for slide in slides:
        parts = [k for k, f in enumerate(found) if isinstance(f, Factor) and slide in f.amount.free_symbols]
        places = range(parts[0], parts[-1] + 1) if len(parts) > 1 else ()
        for place in places:
            if (direction := _direction(found, slide, parts, place, moving)) is not None:
                for k in parts:
                    found[k] = _without(found[k], slide)
                found.insert(place, Oblique(slide, tuple(direction)))
                break
    return tuple(found)


def _without(factor: Factor | Oblique, slide: sp.Symbol) -> Factor | Oblique:
    return replace(factor, amount=factor.amount.subs(slide, 0)) if isinstance(factor, Factor) else factor


def _direction(
    factors: Sequence[Factor | Oblique], slide: sp.Symbol, parts: Sequence[int], place: int, moving: set[sp.Symbol]
) -> sp.Matrix | None:
    """The direction of a slide, seen from in front of a factor; None if a joint turns one of its parts."""
    direction = sp.zeros(3, 1)
    for k in parts:
        part = factors[k]
        assert isinstance(part, Factor)
        vector = sp.zeros(3, 1)
        vector[part.axis] = sp.expand(part.amount).coeff(slide)
        way = [(f, 1) for f in reversed(factors[place:k])] if k >= place else [(f, -1) for f in factors[k:place]]
        for factor, sense in way:
            if not isinstance(factor, Factor) or factor.motion is Motion.SHIFT:
                continue
            if all(v == 0 for i, v in enumerate(vector) if i != factor.axis):
                continue
            if factor.amount.free_symbols & moving:
                return None
            rotation = sp.Matrix(factor.matrix()[:3, :3])
            vector = (rotation if sense > 0 else rotation.T) * vector
        direction += vector
    return direction


def turned_to(x: sp.Expr, y: sp.Expr, z: sp.Expr) -> Turned:
    """The turns to a direction of length one."""
    if z == 0:
        return Turned(0, ((2, x, y),))
    if y == 0:
        return Turned(2, ((1, z, x),))
    if x == 0:
        return Turned(2, ((0, z, -y),))
    aside = Root(x**2 + y**2)
    return Turned(2, ((2, x / aside, y / aside), (1, z, aside)))
