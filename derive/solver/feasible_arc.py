"""Free angles stay where the rest can be solved: a partial step's angle is moved onto the arc that later steps can reach.

Where a partial step's measure vanishes its angle u is free, and where the measure is tiny u is known only to a few digits.
A later two-root step needs |e| <= h; there e = level + along cos u + across sin u (what else e holds of u, its second harmonic,
vanishes with the measure, and is taken as constant). So cos(u - centre) lies between two bounds: on each side of the centre an
arc. u moves to the nearest point of the arc on its side, where the motion that this costs, measure times arc, is rounding.
Where e is within its bound, or far beyond it though u is known, u stays, and nothing of this is looked at.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import cosine, linear_coefficients, sine
from derive.equations.problem import Measure, Slope
from derive.ir.constants import (
    FREE_ANGLE,
    KNOWN_ANGLE,
    OUT_OF_REACH,
    ROUNDING,
)
from derive.ir.primitives import (
    Atan2,
    NearestOnArc,
    Root,
    Select,
    Wrap,
)
from derive.ir.program import (
    Let,
    Statement,
    binds,
    reads,
    rewritten,
)
from derive.ir.symbols import (
    flag,
    real,
)


@dataclass(frozen=True)
class _Part:
    """A name that the angle moves: fixed + along cos u + across sin u."""

    name: sp.Symbol
    fixed: sp.Expr
    along: sp.Expr
    across: sp.Expr


@dataclass(frozen=True)
class _Condition:
    """|e| <= h of a later step: e is made of the parts that the angle moves, at most squared."""

    word: str
    size: sp.Expr
    value: sp.Expr
    parts: tuple[_Part, ...]
    chain: tuple[Let, ...]
    """How the parts follow from the angle, step by step."""


def within_reach(
    statements: Sequence[Statement], slopes: Sequence[Slope], measures: Sequence[Measure]
) -> tuple[Statement, ...]:
    """The derivation with every angle that can be free kept where later steps have solutions."""
    found = list(statements)
    for measure in measures:
        for slope in slopes:
            condition = _condition(found, measure, slope)
            if condition is not None:
                found = _in_order(_moved(found, measure, condition))
    return tuple(found)


def _in_order(statements: Sequence[Statement]) -> list[Statement]:
    """Every statement behind those that it reads: a motion reads what was bound after the angle, but does not depend on it."""
    sources = {name: s for s in statements for name in binds(s)}
    ordered: list[Statement] = []
    begun: set[int] = set()

    def provide(statement: Statement) -> None:
        if id(statement) not in begun:
            begun.add(id(statement))
            for source in [s for name, s in sources.items() if name in reads(statement)]:
                provide(source)
            ordered.append(statement)

    for s in statements:
        provide(s)
    return ordered


def _condition(statements: Sequence[Statement], measure: Measure, slope: Slope) -> _Condition | None:
    """The condition of a later step on the angle of a partial step; None where it has none."""
    angle = measure.angle
    if slope.reach is None:
        return None
    dependent = _dependent(statements, angle)
    size, value = (sp.expand(_squares(v, dependent)) for v in slope.reach)
    moved = sorted(value.free_symbols & dependent.keys(), key=lambda s: s.name)
    if not moved or size.free_symbols & dependent.keys():
        return None
    parts = tuple(p for name in moved for p in [_part(name, dependent[name], angle)] if p is not None)
    if len(parts) < len(moved):
        return None  # the later step depends on the angle in a way that no arc can tell
    gone = _vanishing(statements, measure)
    if all(p.along.xreplace(gone) == 0 and p.across.xreplace(gone) == 0 for p in parts):
        return None  # where the angle is free it no longer moves them
    chain = tuple(_chain(statements, moved, dependent))
    return _Condition(f"{angle.name}_of_{slope.step.name}", size, value, parts, chain)


def _chain(statements: Sequence[Statement], names: Sequence[sp.Symbol], dependent: Mapping[sp.Symbol, sp.Expr]) -> list[Let]:
    """The statements by which names depend on the angle."""
    needed, found = set(names), list[Let]()
    for s in reversed(statements):
        if isinstance(s, Let) and s.name in needed & dependent.keys():
            needed |= s.value.free_symbols
            found.insert(0, s)
    return found


def _vanishing(statements: Sequence[Statement], measure: Measure) -> dict[sp.Symbol, sp.Expr]:
    """What is zero where the measure, a length, is zero: what it is the length of."""
    values = [s.value for s in statements if isinstance(s, Let) and s.name == measure.value]
    terms = [t for value in values if isinstance(value, Root) for t in sp.Add.make_args(value.args[0])]
    return {t.base: sp.Integer(0) for t in terms if isinstance(t, sp.Pow) and t.exp == 2}


def _dependent(statements: Sequence[Statement], angle: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
    """Every name that depends on the angle, through the angle's cosine and sine."""
    own = {cosine(angle), sine(angle)}
    dependent: dict[sp.Symbol, sp.Expr] = {}
    for s in statements:
        if isinstance(s, Let) and s.name not in own and s.value.free_symbols & (own | dependent.keys()):
            dependent[s.name] = s.value if isinstance(s.value, Root) else s.value.xreplace(dependent)
    return dependent


def _squares(value: sp.Expr, dependent: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The squares of lengths through what the lengths are made of."""
    roots = {name: v.args[0] for name, v in dependent.items() if isinstance(v, Root)}
    return value.replace(lambda n: isinstance(n, sp.Pow) and n.base in roots and n.exp == 2, lambda n: roots[n.base])


def _part(name: sp.Symbol, value: sp.Expr, angle: sp.Symbol) -> _Part | None:
    linear = linear_coefficients(sp.expand(value), (cosine(angle), sine(angle)))
    if linear is None:
        return None
    (along, across), fixed = linear
    return _Part(name, fixed, along, across)


def _moved(statements: Sequence[Statement], measure: Measure, condition: _Condition) -> list[Statement]:
    """The statements with the angle moved onto the arc, where it was bound."""
    names = {f(measure.angle): real(f"{f(measure.angle).name}_before_{condition.word}") for f in (cosine, sine)}
    found: list[Statement] = []
    for s in statements:
        if not (isinstance(s, Let) and s.name in names):
            found.append(s)
            continue
        found.append(replace(s, name=names[s.name]))
        if s.name == sine(measure.angle):  # the second of the two
            found += [rewritten(m, lambda e: e.xreplace(names)) for m in _motion(measure, condition)]
            found += _bound(measure, condition, names)
    return found


def _motion(measure: Measure, condition: _Condition) -> tuple[Let, ...]:
    """Where the angle moves, in terms of where it was."""
    word = condition.word
    value, size = (real(f"{name}_{word}") for name in ("value", "size"))
    lets, total, slopes = _parts(condition)
    return (
        *lets,
        Let(value, total, f"a later step needs this of {measure.angle.name}: no larger in size than"),
        Let(size, sp.Abs(condition.size)),
        *nearest_on_arc(word, value, size, slopes, (cosine(measure.angle), sine(measure.angle))),
    )


def nearest_on_arc(
    word: str, value: sp.Expr, size: sp.Expr, slopes: tuple[sp.Expr, sp.Expr], angle: tuple[sp.Expr, sp.Expr]
) -> tuple[Let, ...]:
    """`moved_<word>`: the u nearest to where it was at which a value is no larger in size; on its side of the arc's centre.

    slopes: of the value by cos u and sin u. angle: the cosine and sine of u where it was, and where the value is `value`.
    """
    cos_u, sin_u = angle
    along, across, swing, level = (real(f"{name}_{word}") for name in ("along", "across", "swing", "level"))
    divisor, highest, lowest, near, far = (real(f"{name}_{word}") for name in ("divisor", "highest", "lowest", "near", "far"))
    centre, before, side, moved = (real(f"{name}_{word}") for name in ("centre", "angle", "side", "moved"))
    turns = sp.Gt(swing, ROUNDING * size)
    one = sp.Integer(1)
    return (
        Let(along, slopes[0]),
        Let(across, slopes[1]),
        Let(swing, Root(along**2 + across**2)),
        Let(level, value - along * cos_u - across * sin_u),
        Let(divisor, Select(turns, swing, one)),
        Let(highest, Select(turns, _cosine_of((size - level) / divisor), one), "the arc: cosines from its centre"),
        Let(lowest, Select(turns, _cosine_of((-size - level) / divisor), -one)),
        Let(near, Wrap(Atan2(Root((1 - highest) * (1 + highest)), highest))),
        Let(far, Wrap(Atan2(Root((1 - lowest) * (1 + lowest)), lowest))),
        Let(centre, Atan2(across, along)),
        Let(before, Atan2(sin_u, cos_u)),
        Let(side, Select(sp.Ge(along * sin_u - across * cos_u, 0), one, -one)),
        Let(moved, NearestOnArc(before, centre + side * (near + far) / 2, (far - near) / 2)),
    )


def _parts(condition: _Condition) -> tuple[tuple[Let, ...], sp.Expr, tuple[sp.Expr, sp.Expr]]:
    """The parts under names, e at the angle, and the coefficients of its first harmonic."""
    before = {let.name: real(f"{let.name.name}_before_{condition.word}") for let in condition.chain}
    lets = [Let(before[let.name], let.value.xreplace(before)) for let in condition.chain]
    fixed: dict[sp.Symbol, sp.Expr] = {}
    for part in condition.parts:
        names = {w: real(f"{part.name.name}_{w}") for w in ("fixed", "along", "across")}
        lets += [Let(n, getattr(part, w)) for w, n in names.items()]
        fixed[part.name] = names["fixed"]
    slopes = [
        sp.Add(*[sp.diff(condition.value, p.name).xreplace(fixed) * real(f"{p.name.name}_{w}") for p in condition.parts])
        for w in ("along", "across")
    ]
    return tuple(lets), condition.value.xreplace(before), (slopes[0], slopes[1])


def _cosine_of(value: sp.Expr) -> sp.Expr:
    return Select(sp.Gt(value, 1), sp.Integer(1), Select(sp.Lt(value, -1), sp.Integer(-1), value))


def _bound(measure: Measure, condition: _Condition, names: dict[sp.Symbol, sp.Symbol]) -> list[Let]:
    """Cosine and sine after the motion, where it is needed and costs no more than rounding."""
    word, before = condition.word, [names[f(measure.angle)] for f in (cosine, sine)]
    value, size, moved, costs = (real(f"{name}_{word}") for name in ("value", "size", "moved", "cost"))
    stays = flag(f"stays_{word}")
    after = [sp.cos(moved), sp.sin(moved)]
    names_after = [real(f"{f(measure.angle).name}_after_{word}") for f in (cosine, sine)]
    share = measure.value / measure.scale
    chord = Root(sp.Add(*[(a - b) ** 2 for a, b in zip(names_after, before, strict=True)]))
    beyond = sp.And(sp.Gt(share, KNOWN_ANGLE), sp.Gt(sp.Abs(value), (1 + OUT_OF_REACH) * size))
    reached = sp.Le(sp.Abs(value), size)
    dear = sp.And(sp.Gt(share, FREE_ANGLE), sp.Gt(costs, ROUNDING))
    return [
        *(Let(n, v) for n, v in zip(names_after, after, strict=True)),
        Let(costs, share * chord, "what the motion changes of the pose"),
        Let(stays, dear),
        *(
            Let(
                f(measure.angle),
                Select(reached, b, Select(beyond, b, Select(stays, b, a))),
                "kept where the rest can be reached",
            )
            for f, a, b in zip((cosine, sine), names_after, before, strict=True)
        ),
    ]
