"""How much is missing where the radicand of a two-root step is negative: the amount of its reason.

For two lengths, (r - l)(r + l), this is |l| - |r|. For the three sides of a triangle, (l1 + l2 - r)(l1 + l2 + r)
(l1 - l2 + r)(l2 + r - l1), it is the larger of r - (l1 + l2) and |l1 - l2| - r, with the sizes of lengths that have a
sign. For a length that occurs only as its square, such as the rod l in l^2 - x^2 - y^2, it is the length by which the
rod is too short or too long.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import sympy as sp

from derive.ir.passes import plain
from derive.ir.primitives import Root, Select, larger
from derive.ir.program import Let
from derive.ir.reason import Reason, Unit, Why, about, about_joint
from derive.ir.symbols import real


def out_of_reach(joint: sp.Symbol, radicand: sp.Expr, known: Iterable[Let]) -> Reason:
    """The reason why an angle has no value; `known` binds the names in the radicand."""
    return _with_amount(about_joint(joint, Why.OUT_OF_REACH), radicand, known)


def cannot_reach(what: str, radicand: sp.Expr, known: Iterable[Let]) -> Reason:
    """The reason why a length has no value: the equation's rod does not reach."""
    return _with_amount(about(what, Why.CANNOT_REACH), radicand, known)


def _with_amount(reason: Reason, radicand: sp.Expr, known: Iterable[Let]) -> Reason:
    values = {real(let.name.name): plain(let.value) for let in known}
    positive = {real(s.name) for s in radicand.free_symbols if s.is_positive}
    positive |= {real(s.name) for let in known for s in let.value.free_symbols if s.is_positive}
    lengths = frozenset(positive - values.keys())
    missing = _missing(_factors(plain(radicand)), values, lengths)
    return reason if missing is None else replace(reason, amount=missing, unit=Unit.LENGTH)


def _missing(sums: list[sp.Expr], values: Mapping[sp.Symbol, sp.Expr], lengths: frozenset[sp.Symbol]) -> sp.Expr | None:
    if not sums:
        return None
    if all(t.as_coeff_Mul()[1].is_Symbol for f in sums for t in f.args):
        return _of_lengths(sums, values, lengths)
    return _of_rod(sums, values, lengths)


def _factors(radicand: sp.Expr) -> list[sp.Expr]:
    """The sums in a product, each with the sign that makes it positive where the step has roots."""
    sums = [f for f in sp.Mul.make_args(radicand) if f.is_Add]
    turned = [-f if _negative_terms(f) > 0 else f for f in sums]
    is_negative = radicand.as_coeff_Mul()[0].is_negative
    if is_negative != bool(sum(a != b for a, b in zip(sums, turned, strict=True)) % 2):
        place = next((k for k, f in enumerate(turned) if _negative_terms(f) == 0), 0)
        turned[place] = -turned[place]
    return turned


def _negative_terms(value: sp.Expr) -> int:
    """The number of terms of a sum with a minus, less the number of those without."""
    return sum(1 if term.could_extract_minus_sign() else -1 for term in value.args)


def _of_lengths(
    sums: list[sp.Expr], values: Mapping[sp.Symbol, sp.Expr], lengths: frozenset[sp.Symbol]
) -> sp.Expr | None:
    """The amount by which one length is too short for another, or a triangle's third side is too long or too short."""

    def size(value: sp.Expr) -> sp.Expr:
        """The size of a length, which may have a sign."""
        known = {s for s in value.free_symbols if s in lengths or isinstance(values.get(s), Root | Select)}
        return value if value.free_symbols == known and not _has_minus(value) else sp.Abs(value)

    if len(sums) == 1:
        return -sums[0]
    if len(sums) == 2:
        first, second = sums
        return size((first - second) / 2) - size((first + second) / 2)
    sides = _sides(sums)
    if sides is None:
        return None
    *two, third = map(size, sorted(sides, key=lambda side: (side in values, str(side))))
    return larger(third - sp.Add(*two), sp.Abs(two[0] - two[1]) - third)


def _has_minus(value: sp.Expr) -> bool:
    return any(term.could_extract_minus_sign() for term in sp.Add.make_args(value))


def _sides(sums: list[sp.Expr]) -> list[sp.Expr] | None:
    """The sides of the triangle in Heron's product; None if the product is another one."""
    perimeter = next((f for f in sums if 2 * f == sp.Add(*sums)), None)
    return None if len(sums) != 4 or perimeter is None else [(perimeter - f) / 2 for f in sums if f != perimeter]


def _of_rod(sums: list[sp.Expr], values: Mapping[sp.Symbol, sp.Expr], lengths: frozenset[sp.Symbol]) -> sp.Expr | None:
    """The amount by which a length that occurs only as its square is too short or too long; names of products are
    written out.
    """
    expanded = [sp.expand(_written_out(f, values)) for f in sums]
    for rod in sorted({s for f in expanded for s in f.free_symbols if s in lengths}, key=str):
        signs = [f.coeff(rod, 2) for f in expanded]
        if all(s in (1, -1) and not sp.expand(f - s * rod**2).has(rod) for s, f in zip(signs, expanded, strict=True)):
            below = [-f if len(sums) == 1 else ((sp.Abs(f) - f) / 2) for f in sums]
            needed = sp.Add(rod**2, *[s * b for s, b in zip(signs, below, strict=True)])
            return sp.Abs(Root(needed) - rod)
    return None


def _written_out(value: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """A sum with the names of products replaced by these products."""
    return value.xreplace({s: v for s in value.free_symbols if (v := values.get(s, s)).is_Mul})
