"""Feasible arc: a free angle is moved onto the arc on which the later steps have solutions.

Where the conditioning of a step vanishes its angle u is free, and where it is tiny u is known only to a few digits. A
later two-root step needs |e| <= h with e = level + along cos u + across sin u. (The second harmonic of e in u, and what
u changes of h, vanish with the conditioning, and are taken as constant.) So cos(u - centre) lies between two bounds,
and u on one of two arcs, one on each side of the centre. u moves to the nearest point of the arc on its side, if the
change of the pose, which is the conditioning times the angle moved, is no more than rounding. Where e is within its
bound, or far beyond it although u is well known, u stays. Where u turns h alone, |h| >= |e| is met in the same way, on
the side of the sign of h.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import linear_coefficients
from derive.equations.problem import Conditioning, StepDeterminant
from derive.ir.constants import FREE_ANGLE, KNOWN_ANGLE, OUT_OF_REACH, ROUNDING
from derive.ir.passes import needed_lets
from derive.ir.primitives import Atan2, NearestOnArc, Root, Select, Wrap
from derive.ir.program import Let, Statement, binds, reads, rewritten
from derive.ir.symbols import cosine, flag, real, sine
from derive.solver.corners.where_free import square_where_free

WITHIN_ITS_BOUND = "{} has solutions where this is within its bound"
LARGE_ENOUGH = "{} has solutions where this is large enough"


@dataclass(frozen=True)
class _Part:
    """A value that depends on the angle: fixed + along cos u + across sin u."""

    name: sp.Symbol
    fixed: sp.Expr
    along: sp.Expr
    across: sp.Expr


@dataclass(frozen=True)
class _Condition:
    """|e| <= h of a later step: e is a polynomial of at most the second degree in values that depend on the angle."""

    step: sp.Symbol
    """The unknown of the later step."""
    word: str
    """What the names of this motion end in."""
    size: sp.Expr
    """h; e where u turns h"""
    value: sp.Expr
    """e; h where u turns it"""
    parts: tuple[_Part, ...]
    chain: tuple[Let, ...]
    """The statements by which these values follow from the angle, in order."""
    is_least: bool = False
    """Whether |value| >= |size| is needed, not <=."""


def within_reach(
    statements: Sequence[Statement], determinants: Sequence[StepDeterminant], conditionings: Sequence[Conditioning]
) -> tuple[Statement, ...]:
    """The derivation with every angle that can be free moved to where the later steps have solutions."""
    found = list(statements)
    for conditioning in conditionings:
        for determinant in determinants:
            condition = _condition(found, conditioning, determinant)
            if condition is not None:
                found = in_order(_moved(found, conditioning, condition))
    return tuple(found)


def in_order(statements: Sequence[Statement]) -> list[Statement]:
    """The statements, each behind those that it reads: a motion may read values that are bound behind the angle but do
    not depend on it.
    """
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


def _condition(
    statements: Sequence[Statement], conditioning: Conditioning, determinant: StepDeterminant
) -> _Condition | None:
    """The condition of a later step on an angle that may be free; None where it has none."""
    angle = conditioning.angle
    if determinant.reach is None:
        return None
    dependent = _dependent(statements, angle)
    size, value = (sp.expand(_squares(v, dependent)) for v in determinant.reach)
    own = _own(angle)
    moved = sorted(value.free_symbols & (dependent.keys() | own.keys()), key=lambda s: s.name)
    word = f"{angle.name}_of_{determinant.step.name}"
    turned = size.free_symbols & dependent.keys()
    there = square_where_free(statements, size, dependent, _vanishing(statements, conditioning))
    if not moved and turned:
        return _least_size(conditioning, determinant, word, (there, value))
    if not moved or (turned and there.free_symbols & {*own, *dependent}):
        return None
    chosen = {name for name, v in dependent.items() if _is_chosen(v, {*own, *dependent})}
    if any(name in chosen or (name in dependent and dependent[name].free_symbols & chosen) for name in moved):
        return None
    parts = tuple(p for name in moved for p in [own.get(name) or _part(name, dependent[name], angle)] if p is not None)
    read = {s for part in parts for coefficient in (part.along, part.across) for s in coefficient.free_symbols}
    if len(parts) < len(moved) or read & dependent.keys():
        return None  # the later step does not depend on the angle by its first harmonic alone
    gone = _vanishing(statements, conditioning)
    if all(p.along.xreplace(gone) == 0 and p.across.xreplace(gone) == 0 for p in parts):
        return None  # where the angle is free these values do not depend on it
    chain = needed_lets((s for s in statements if isinstance(s, Let) and s.name in dependent), [*moved, *turned])
    return _Condition(determinant.step, word, size, value, parts, chain)


def _own(angle: sp.Symbol) -> dict[sp.Symbol, _Part]:
    """The cosine and sine of the angle itself, as values that depend on it."""
    none, one = sp.Integer(0), sp.Integer(1)
    return {cosine(angle): _Part(cosine(angle), none, one, none), sine(angle): _Part(sine(angle), none, none, one)}


def _least_size(
    conditioning: Conditioning, determinant: StepDeterminant, word: str, needed: tuple[sp.Expr, sp.Expr]
) -> _Condition | None:
    """The condition where the angle turns h, a first harmonic of it, and not e. needed: h^2, and e."""
    square, value = needed
    number, factors = sp.factor_list(square)
    if any(power % 2 for _, power in factors) or not number.is_positive:
        return None
    size = sp.sqrt(number) * sp.Mul(*[base ** (power // 2) for base, power in factors])
    angle = conditioning.angle
    linear = linear_coefficients(sp.expand(size), (cosine(angle), sine(angle)))
    if linear is None or not any(linear[0]):
        return None
    return _Condition(determinant.step, word, value, size, (), (), is_least=True)


def _vanishing(statements: Sequence[Statement], conditioning: Conditioning) -> dict[sp.Symbol, sp.Expr]:
    """The components of the vector whose length the conditioning is: they are zero where it is."""
    values = [s.value for s in statements if isinstance(s, Let) and s.name == conditioning.value]
    terms = [t for value in values if isinstance(value, Root) for t in sp.Add.make_args(value.args[0])]
    return {t.base: sp.Integer(0) for t in terms if isinstance(t, sp.Pow) and t.exp == 2}


def _dependent(statements: Sequence[Statement], angle: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
    """Every name that depends on the angle, through the angle's cosine and sine."""
    own = {cosine(angle), sine(angle)}
    dependent: dict[sp.Symbol, sp.Expr] = {}
    written_out: dict[sp.Symbol, sp.Expr] = {}
    for s in statements:
        if isinstance(s, Let) and s.name not in own and s.value.free_symbols & (own | dependent.keys()):
            dependent[s.name] = s.value if isinstance(s.value, Root) else s.value.xreplace(written_out)
            if not _is_chosen(s.value, own | dependent.keys()):
                written_out[s.name] = dependent[s.name]
    return dependent


def _is_chosen(value: sp.Basic, names: Set[sp.Symbol]) -> bool:
    """Whether a value is a choice whose condition depends on these names: written out, such values become too long."""
    return any(choice.free_symbols & names for choice in value.atoms(Select))


def _squares(value: sp.Expr, dependent: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The value with the squares of lengths written out by the sides of these lengths."""
    roots = {name: v.args[0] for name, v in dependent.items() if isinstance(v, Root)}
    return value.replace(lambda n: isinstance(n, sp.Pow) and n.base in roots and n.exp == 2, lambda n: roots[n.base])


def _part(name: sp.Symbol, value: sp.Expr, angle: sp.Symbol) -> _Part | None:
    linear = linear_coefficients(sp.expand(value), (cosine(angle), sine(angle)))
    if linear is None:
        return None
    (along, across), fixed = linear
    return _Part(name, fixed, along, across)


def _moved(statements: Sequence[Statement], conditioning: Conditioning, condition: _Condition) -> list[Statement]:
    """The statements with the angle moved onto the arc, behind where it was bound."""
    names = {
        f(conditioning.angle): real(f"{f(conditioning.angle).name}_before_{condition.word}") for f in (cosine, sine)
    }
    found: list[Statement] = []
    for s in statements:
        if not (isinstance(s, Let) and s.name in names):
            found.append(s)
            continue
        found.append(replace(s, name=names[s.name]))
        if s.name == sine(conditioning.angle):  # the second of the two
            found += [rewritten(m, lambda e: e.xreplace(names)) for m in _motion(conditioning, condition)]
            found += _bound(conditioning, condition, names)
    return found


def _motion(conditioning: Conditioning, condition: _Condition) -> tuple[Let, ...]:
    """The angle on the arc, computed from where it was."""
    word = condition.word
    value, size = (real(f"{name}_{word}") for name in ("value", "size"))
    angle = cosine(conditioning.angle), sine(conditioning.angle)
    if condition.is_least:
        return _least_motion(condition, (value, size), angle)
    lets, total, derivatives = _parts(condition)
    before = {let.name: real(f"{let.name.name}_before_{word}") for let in condition.chain}
    return (
        *lets,
        Let(value, total, WITHIN_ITS_BOUND.format(condition.step)),
        Let(size, sp.Abs(condition.size.xreplace(before))),
        *nearest_on_arc(word, value, size, derivatives, angle),
    )


def _least_motion(
    condition: _Condition, names: tuple[sp.Symbol, sp.Symbol], angle: tuple[sp.Symbol, sp.Symbol]
) -> tuple[Let, ...]:
    """The angle at which h, with the sign that it has, is as large as e."""
    (value, size), way = names, real(f"way_{condition.word}")
    linear = linear_coefficients(sp.expand(condition.value), angle)
    assert linear is not None
    (along, across), _ = linear
    return (
        Let(way, Select(sp.Ge(condition.value, 0), sp.Integer(1), sp.Integer(-1))),
        Let(value, way * condition.value, LARGE_ENOUGH.format(condition.step)),
        Let(size, sp.Abs(condition.size)),
        *nearest_on_arc(condition.word, value, size, (way * along, way * across), angle, is_least=True),
    )


def nearest_on_arc(
    word: str,
    value: sp.Expr,
    size: sp.Expr,
    derivatives: tuple[sp.Expr, sp.Expr],
    angle: tuple[sp.Expr, sp.Expr],
    *,
    is_least: bool = False,
) -> tuple[Let, ...]:
    """`moved_<word>`: the u nearest to where it was, on its side of the centre, at which |value| <= size, or, where
    this is the least value, value >= size.

    derivatives: those of the value by cos u and sin u. angle: the cosine and sine of u where it was; `value` is its
    value there.
    """
    cos_u, sin_u = angle
    along, across, swing, level = (real(f"{name}_{word}") for name in ("along", "across", "swing", "level"))
    divisor, highest, lowest, near, far = (
        real(f"{name}_{word}") for name in ("divisor", "highest", "lowest", "near", "far")
    )
    centre, before, side, moved = (real(f"{name}_{word}") for name in ("centre", "angle", "side", "moved"))
    turns = sp.Gt(swing, ROUNDING * size)
    one = sp.Integer(1)
    ends = (
        (one, _cosine_of((size - level) / divisor))
        if is_least
        else tuple(_cosine_of((end - level) / divisor) for end in (size, -size))
    )
    return (
        Let(along, derivatives[0]),
        Let(across, derivatives[1]),
        Let(swing, Root(along**2 + across**2)),
        Let(level, value - along * cos_u - across * sin_u),
        Let(divisor, Select(turns, swing, one)),
        Let(highest, Select(turns, ends[0], one), "feasible arc: cosines of its ends"),
        Let(lowest, Select(turns, ends[1], -one)),
        Let(near, Wrap(Atan2(Root((1 - highest) * (1 + highest)), highest))),
        Let(far, Wrap(Atan2(Root((1 - lowest) * (1 + lowest)), lowest))),
        Let(centre, Atan2(across, along)),
        Let(before, Atan2(sin_u, cos_u)),
        Let(side, Select(sp.Ge(along * sin_u - across * cos_u, 0), one, -one)),
        Let(moved, NearestOnArc(before, centre + side * (near + far) / 2, (far - near) / 2)),
    )


def _parts(condition: _Condition) -> tuple[tuple[Let, ...], sp.Expr, tuple[sp.Expr, sp.Expr]]:
    """The values under names, e at the angle, and the coefficients of its first harmonic."""
    before = {let.name: real(f"{let.name.name}_before_{condition.word}") for let in condition.chain}
    lets = [Let(before[let.name], let.value.xreplace(before)) for let in condition.chain]
    fixed: dict[sp.Symbol, sp.Expr] = {}
    for part in condition.parts:
        names = {w: real(f"{part.name.name}_{w}") for w in ("fixed", "along", "across")}
        lets += [Let(n, getattr(part, w)) for w, n in names.items()]
        fixed[part.name] = names["fixed"]
    derivatives = [
        sp.Add(
            *[sp.diff(condition.value, p.name).xreplace(fixed) * real(f"{p.name.name}_{w}") for p in condition.parts]
        )
        for w in ("along", "across")
    ]
    return tuple(lets), condition.value.xreplace(before), (derivatives[0], derivatives[1])


def _cosine_of(value: sp.Expr) -> sp.Expr:
    return Select(sp.Gt(value, 1), sp.Integer(1), Select(sp.Lt(value, -1), sp.Integer(-1), value))


def _bound(conditioning: Conditioning, condition: _Condition, names: dict[sp.Symbol, sp.Symbol]) -> list[Let]:
    """Cosine and sine after the motion, which takes place where it is needed and changes the pose by no more than
    rounding.
    """
    word, before = condition.word, [names[f(conditioning.angle)] for f in (cosine, sine)]
    value, size, moved, costs = (real(f"{name}_{word}") for name in ("value", "size", "moved", "cost"))
    stays = flag(f"stays_{word}")
    after = [sp.cos(moved), sp.sin(moved)]
    names_after = [real(f"{f(conditioning.angle).name}_after_{word}") for f in (cosine, sine)]
    share = conditioning.value / conditioning.scale
    chord = Root(sp.Add(*[(a - b) ** 2 for a, b in zip(names_after, before, strict=True)]))
    smaller, larger = (size, value) if condition.is_least else (sp.Abs(value), size)
    beyond = sp.And(sp.Gt(share, KNOWN_ANGLE), sp.Gt(smaller, (1 + OUT_OF_REACH) * larger))
    reached = sp.Le(smaller, larger)
    dear = sp.And(sp.Gt(share, FREE_ANGLE), sp.Gt(costs, ROUNDING))
    return [
        *(Let(n, v) for n, v in zip(names_after, after, strict=True)),
        Let(costs, share * chord, "change of the pose by this motion"),
        Let(stays, dear),
        *(
            Let(
                f(conditioning.angle),
                Select(reached, b, Select(beyond, b, Select(stays, b, a))),
                f"moved so that {condition.step.name} has a solution",
            )
            for f, a, b in zip((cosine, sine), names_after, before, strict=True)
        ),
    ]
