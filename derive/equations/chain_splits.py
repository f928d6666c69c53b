"""Chain splits (Paul, Pieper): T = L M S, so that L^-1 T S^-1 = M holds for every middle part M of the chain.

Positions are split once, before any joint is known. S is the part of the chain at the flange whose joints do not move
its first point: this is the wrist centre, which the commanded position and rotation determine together (Pieper). L is
the part up to the first joint. An arm whose first joints intersect in a point is treated the same way seen from its
flange: T^-1 = S^-1 M^-1 L^-1. For rotations see `rotations`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.algebra.angle_sums import name_of
from derive.algebra.normal_form import is_compound, polynomial
from derive.equations.problem import Equation
from derive.geometry.frames import Chain, Factor, Motion
from derive.geometry.pose import pose_of
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, cosine, real, sine


def is_spatial(chain: Chain) -> bool:
    """Whether a chain turns about more than one axis."""
    return len({f.axis for f in chain.factors if f.motion is Motion.TURN}) > 1


@dataclass(frozen=True)
class Target:
    """A commanded point: its coordinates, and the statements that bind the names in them."""

    point: tuple[sp.Expr, ...]
    lets: tuple[Let, ...] = ()


@dataclass(frozen=True)
class Commanded:
    """The commanded rotation, and which of its columns are followed."""

    rotation: sp.Matrix
    columns: tuple[int, ...]


@dataclass(frozen=True)
class Unknowns:
    """The unknowns of the equations of a chain, and the symbols that their normal form needs."""

    angles: tuple[sp.Symbol, ...]
    lengths: tuple[sp.Symbol, ...]
    units: tuple[sp.Symbol, ...]
    signs: tuple[sp.Symbol, ...]

    def form(self, expression: sp.Expr) -> sp.Expr:
        """The normal form."""
        return polynomial(expression, self.units, self.signs)

    def of(self, form: sp.Expr) -> set[sp.Symbol]:
        """The unknowns in a normal form."""
        present: set[sp.Symbol] = set(form.free_symbols)
        angles = {a for a in self.angles if present & {a, sine(a), cosine(a)}}
        return angles | (set(self.lengths) & present)


@dataclass(frozen=True)
class Split:
    """The position equations of a chain, and the part of the chain that they are written for, with its end point."""

    equations: tuple[Equation, ...]
    links: tuple[Factor, ...] = ()
    target: Target = Target(())
    back: tuple[tuple[Factor, ...], Target] | None = None
    """The chain from its flange to the point in which its first joints intersect, and this point seen from there."""


def split_positions(chain: Chain, point: tuple[sp.Expr, ...], commanded: Commanded, unknowns: Unknowns) -> Split:
    """The position equations of a chain, at the split that isolates an unknown, else those of the whole chain.

    point: the position of its end. If no split isolates one, the chain is also taken from its flange, to the point
    in which its first joints intersect.
    """
    factors, target = chain.factors, Target(point)
    if commanded.columns:
        factors, target = _behind_the_wrist(chain, sp.Matrix(point), commanded, unknowns)
    found = _split(factors, target, unknowns)
    if len(commanded.columns) < 3 or _alone(found, unknowns):
        return Split(found, factors, target)
    turned, seen = _before_the_shoulder(chain, sp.Matrix(point), commanded, unknowns)
    from_flange = _split(turned, seen, unknowns)
    if _alone(from_flange, unknowns):
        return Split(from_flange, turned, seen)
    return Split(found, factors, target, (turned, seen))


def _split(factors: Sequence[Factor], target: Target, unknowns: Unknowns) -> tuple[Equation, ...]:
    """The equations in a frame behind some of the first joints, up to the first that turns, if more of them have one
    unknown than in the frame of the base.
    """
    seen = views(factors, target, unknowns)
    return max(seen, key=lambda equations: _alone(equations, unknowns))  # max keeps the first of equals


def views(factors: Sequence[Factor], target: Target, unknowns: Unknowns) -> list[tuple[Equation, ...]]:
    """The equations in the frame of the base, and in the frame behind every joint up to the first that turns."""
    moving = [i for i, f in enumerate(factors) if f.amount.free_symbols & {*unknowns.angles, *unknowns.lengths}]
    turning = next((k for k, i in enumerate(moving) if factors[i].motion is Motion.TURN), 0)
    return [_equations(factors, first, target, unknowns) for first in (-1, *moving[: turning + 1])]


def _alone(equations: Sequence[Equation], unknowns: Unknowns) -> int:
    """The number of equations with exactly one unknown."""
    return sum(len(unknowns.of(e.expression)) == 1 for e in equations)


def _behind_the_wrist(
    chain: Chain, point: sp.Matrix, commanded: Commanded, unknowns: Unknowns
) -> tuple[tuple[Factor, ...], Target]:
    """The chain up to the wrist centre: the point that the commanded pose determines and the fewest joints move."""
    wordings = [chain.factors]
    if len(commanded.columns) < 3:
        wordings.append(_with_shifts_in_front(chain.factors, commanded.columns))
    for factors in wordings:
        best, target = _cut(factors, point, commanded, unknowns)
        if best != factors:
            return best, target
    return chain.factors, Target(tuple(point))


def _cut(
    factors: tuple[Factor, ...], point: sp.Matrix, commanded: Commanded, unknowns: Unknowns
) -> tuple[tuple[Factor, ...], Target]:
    best, target = factors, Target(tuple(point))
    fewest = len(_movers(Chain(factors), unknowns))
    for cut in reversed([i for i, f in enumerate(factors) if f.motion is Motion.TURN]):
        rest = pose_of(Chain(factors[cut:]))
        seen = [unknowns.form(v) for v in -(rest.rotation.T * rest.position)]
        if any(unknowns.of(v) for v in seen) or any(v != 0 for i, v in enumerate(seen) if i not in commanded.columns):
            break  # the commanded columns of the flange no longer determine the point
        front = Chain(factors[:cut])
        if len(_movers(front, unknowns)) < fewest:
            best, target, fewest = front.factors, _wrist(point, commanded.rotation, seen), len(_movers(front, unknowns))
    return best, target


def _with_shifts_in_front(factors: Sequence[Factor], columns: Sequence[int]) -> tuple[Factor, ...]:
    """An equal chain: every shift across the commanded columns stands in front of the turns about its own direction."""
    found: list[Factor] = []
    for factor in factors:
        place = len(found)
        if factor.motion is Motion.SHIFT and factor.axis not in columns:
            while place and (found[place - 1].motion is Motion.SHIFT or _turns_about(found[place - 1], factor.axis)):
                place -= 1
        found.insert(place, factor)
    return tuple(found)


def _turns_about(factor: Factor, axis: int) -> bool:
    return factor.motion is Motion.TURN and factor.axis == axis


def _before_the_shoulder(
    chain: Chain, point: sp.Matrix, commanded: Commanded, unknowns: Unknowns
) -> tuple[tuple[Factor, ...], Target]:
    """The chain from its flange back to the shoulder: the last point of the base that its first joints do not move."""
    end = 0
    for cut in range(1, len(chain.factors)):
        moved = pose_of(Chain(chain.factors[:cut])).position
        if any(unknowns.of(unknowns.form(v)) for v in moved):
            break
        end = cut
    front, rest = pose_of(Chain(chain.factors[:end])), chain.factors[end:]
    shoulder = sp.Matrix([unknowns.form(v) for v in front.position])
    seen = commanded.rotation.T * (shoulder - point)
    lets = tuple(Let(real(f"shoulder_{c}"), v) for c, v in zip(COORDINATE_NAMES, seen, strict=True))
    return tuple(f.inverse() for f in reversed(rest)), Target(tuple(let.name for let in lets), lets)


def _movers(chain: Chain, unknowns: Unknowns) -> set[sp.Symbol]:
    """The joints that move the end point of a chain."""
    moved: set[sp.Symbol] = set(pose_of(chain).position.free_symbols)
    return moved & {*unknowns.angles, *unknowns.lengths}


def _wrist(point: sp.Matrix, rotation: sp.Matrix, seen: Sequence[sp.Expr]) -> Target:
    moved = point + rotation * sp.Matrix(seen)
    lets = []
    for c, value in zip(COORDINATE_NAMES, moved, strict=True):
        note = "wrist centre: the last joints do not move this point" if c == "x" else ""
        lets.append(Let(real(f"wrist_{c}"), value, note))
    if not any(is_compound(let.value) for let in lets):
        return Target(tuple(moved))
    return Target(tuple(let.name for let in lets), tuple(lets))


def _equations(factors: Sequence[Factor], first: int, target: Target, unknowns: Unknowns) -> tuple[Equation, ...]:
    """The equations of the point in the frame behind the joint at `first` and the links fixed to it; where `first` is
    -1, in the frame of the base.
    """
    moving = {*unknowns.angles, *unknowns.lengths}
    end = first + 1
    while first >= 0 and end < len(factors) and not factors[end].amount.free_symbols & moving:
        end += 1
    front, rest = pose_of(Chain(tuple(factors[:end]))), pose_of(Chain(tuple(factors[end:])))
    seen = front.rotation.T * (sp.Matrix(target.point) - front.position)
    word = "" if first < 0 else f"_from_{_movers_name(factors[first], unknowns)}"
    found = []
    for c, left, right in zip(COORDINATE_NAMES, seen, rest.position, strict=True):
        form = unknowns.form(right - left)
        used = tuple(let for let in target.lets if let.name in form.free_symbols)
        found.append(Equation(f"{c}{word}", form, used))
    return tuple(found)


def _movers_name(factor: Factor, unknowns: Unknowns) -> str:
    return name_of(tuple((s, 1) for s in (*unknowns.angles, *unknowns.lengths) if s in factor.amount.free_symbols))
