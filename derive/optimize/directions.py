"""Directions: the angle of a direction is computed from known angles and vectors, without a sine and a cosine that
nothing else reads.

    added      atan2(s1 c2 + c1 s2, c1 c2 - s1 s2)    →  atan2(s1, c1) + atan2(s2, c2), up to a turn, which is chosen
               afterwards
    unscaled   atan2(y/r, x/r)                        →  atan2(y, x)

Both also apply to values made of a direction: to a direction turned by it, or multiplied with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations, product

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.passes import is_read_once, normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select
from derive.ir.program import Let, Output, Program, reason_expressions, rewritten
from derive.ir.symbols import Names, angle_of, angle_word, is_condition, symbols_of

_AXES = {"cos": "x", "sin": "y"}
Pair = tuple[sp.Symbol, sp.Symbol]
"""Two names that are the sine and the cosine of an angle, or are proportional to them."""


@dataclass(frozen=True)
class _Amount:
    """An angle as a signed sum of the angles of directions, and half a turn or not."""

    terms: tuple[tuple[int, Pair], ...]
    is_opposite: bool = False

    def turned(self, sense: int) -> _Amount:
        """The same angle, or its negative."""
        return replace(self, terms=tuple((sense * s, p) for s, p in self.terms))

    def plus(self, other: _Amount) -> _Amount:
        """The sum of two angles."""
        return _Amount((*self.terms, *other.terms), self.is_opposite != other.is_opposite)


def added(program: Program) -> Program:
    """The program with the angle of a rotated direction as a sum of angles, where this needs no more of them."""
    axes = {let.name: pair for let in program.lets() for pair in [direction_of(let)] if pair is not None}
    values = {let.name: let.value for let in program.lets()}
    sums: dict[Pair, _Amount] = {}
    for name, pair in axes.items():
        if any(_readers(program, symbol) != [name] for symbol in pair):
            continue  # another reader needs them anyway
        others = [other for other in axes.values() if other != pair]
        amount = min(_amounts(pair, values, others), key=lambda a: _strangers(a, others), default=None)
        if amount is not None and _strangers(amount, others) <= 1:
            sums[pair] = amount
    return _with_sums(program, sums)


def _with_sums(program: Program, sums: Mapping[Pair, _Amount]) -> Program:
    taken = Names.of(program)
    parts = {p: whole for whole, amount in sums.items() for _, p in amount.terms if p not in sums}
    angles = {p: taken.fresh(_angle_name(p, whole)) for p, whole in parts.items()}
    values: dict[sp.Basic, sp.Basic] = {Atan2(*pair): name for pair, name in angles.items()}
    for pair, amount in sums.items():
        total = sp.Add(*[sign * values.get(Atan2(*p), Atan2(*p)) for sign, p in amount.terms])
        values[Atan2(*pair)] = total + (180 * DEGREE if amount.is_opposite else 0)
    notes = {let.name: let.note for let in program.lets()}
    body = []
    for s in program.body:
        changed = rewritten(s, lambda e: e.xreplace(values))
        whole = direction_of(s) if isinstance(s, Let) else None
        if isinstance(changed, Let) and whole is not None and whole in sums:
            changed = replace(changed, note=_joined(notes[whole[1]], changed.note))
        body.append(changed)
    lets = [Let(name, Atan2(*pair)) for pair, name in angles.items()]
    return normalise(program.name, (*lets, *body), program.outputs) if sums else program


def _angle_name(pair: Pair, whole: Pair) -> str:
    """`angle_q2` for `sin_q2`, `cos_q2`; a pair without the name of an angle is named after the angle that it gives."""
    own = angle_of(pair[1])
    return f"angle_with_{angle_word(whole[1])}" if own is None else f"angle_{own}"


def direction_of(let: Let) -> Pair | None:
    """The pair from which the angle of an axis is computed, if its period is chosen afterwards; else None."""
    if not isinstance(let.value, NearestPeriod):
        return None
    found = [term * DEGREE for term in sp.Add.make_args(let.value.args[0]) if isinstance(term * DEGREE, Atan2)]
    if len(found) != 1 or not all(a.is_Symbol for a in found[0].args):
        return None
    sine, cosine = found[0].args
    return sine, cosine


def _readers(program: Program, symbol: sp.Symbol) -> list[sp.Symbol | None]:
    """The readers of a name: the names that they bind, None for other statements."""
    lets = [s.name if isinstance(s, Let) else None for s in program.body if symbol in s.reads()]
    return lets + [None for o in program.outputs if symbol in symbols_of(o.value)]


def _strangers(amount: _Amount, known: Sequence[Pair]) -> int:
    """The number of angles in a sum that belong to no axis."""
    return sum(pair not in known for _, pair in amount.terms)


def _amounts(pair: Pair, values: Mapping[sp.Symbol, sp.Expr], known: Sequence[Pair]) -> Iterator[_Amount]:
    """The sums of angles that the angle of a direction equals."""
    sine, cosine = (values.get(name) for name in pair)
    if sine is None or cosine is None:
        return
    for opposite, (sense1, first), (sense2, second) in products(sine, cosine):
        parts = [
            _Amount(((1, part),)) if part in known else min(
                [*_amounts(part, values, known), _Amount(((1, part),))], key=lambda a: _strangers(a, known)
            )
            for part in (first, second)
        ]  # fmt: skip
        yield replace(parts[0].turned(sense1).plus(parts[1].turned(sense2)), is_opposite=opposite)


def products(sine: sp.Expr, cosine: sp.Expr) -> Iterator[tuple[bool, tuple[int, Pair], tuple[int, Pair]]]:
    """The two directions whose angles, each with a sign, add up to that of (cosine, sine)."""
    terms = [tuple(sorted(t.free_symbols, key=str)) for t in sp.Add.make_args(cosine)]
    if len(terms) != 2 or any(len(t) != 2 for t in terms):
        return
    for (c1, c2), (s1, s2) in permutations(terms):
        for (p1, p2), m1, m2, k in product(((s1, s2), (s2, s1)), (1, -1), (1, -1), (1, -1)):
            if cosine == k * c1 * c2 - k * m1 * m2 * p1 * p2 and sine == k * m1 * p1 * c2 + k * m2 * c1 * p2:
                yield k < 0, (m1, (p1, c1)), (m2, (p2, c2))


def unscaled(program: Program) -> Program:
    """The program without divisions by a length, where only the direction of the quotients is needed."""
    for names, length in _divided(program):
        graded = _graded(program, names)
        if graded is not None:
            program = _without_division(program, names, length, graded)
    return program


def _divided(program: Program) -> tuple[tuple[frozenset[sp.Symbol], sp.Symbol], ...]:
    """The names that are quotients by one length, on the first side of a choice or always, with this length."""
    found: dict[tuple[sp.Basic, sp.Symbol], list[sp.Symbol]] = {}
    lengths = lengths_of(program)
    for let in (let for let in program.lets() if not is_condition(let.value)):
        condition, value = (
            (let.value.args[0], let.value.args[1]) if isinstance(let.value, Select) else (sp.true, let.value)
        )
        for factor in sp.Mul.make_args(value):
            if 1 / factor in lengths:
                found.setdefault((condition, 1 / factor), []).append(let.name)
    return tuple((frozenset(names), length) for (_, length), names in found.items())


def lengths_of(program: Program) -> frozenset[sp.Symbol]:
    """The names of lengths that are 1 where they would be zero: they are never negative, and may divide."""
    roots = {let.name for let in program.lets() if isinstance(let.value, Root)}
    choices = [let for let in program.lets() if isinstance(let.value, Select) and let.value.args[2] == 1]
    return frozenset(c.name for c in choices if isinstance(c.value.args[1], Root) or c.value.args[1] in roots)


def _graded(program: Program, names: frozenset[sp.Symbol]) -> frozenset[sp.Symbol] | None:
    """All names that are proportional to the given ones; None if any other value depends on them, or a reason reads
    them.
    """
    graded = set(names)
    for statement in program.body:
        if any(symbols_of(value) & graded for value in reason_expressions(statement)):
            return None
        if not statement.reads() & graded:
            continue
        if not isinstance(statement, Let) or statement.name in names:
            return None
        degree = _degree(statement.value, graded)
        if degree is None:
            return None
        if degree == 1:
            graded.add(statement.name)
    return None if any(symbols_of(o.value) & graded for o in program.outputs) else frozenset(graded)


def _degree(value: sp.Expr, graded: set[sp.Symbol]) -> int | None:
    """1 where a value is proportional to the graded names, 0 where it does not depend on them; else None."""
    plain = value.replace(lambda e: isinstance(e, Atan2) and _is_proportional(e.args, graded), lambda _: sp.Dummy())
    if not plain.free_symbols & graded:
        return 0
    sides = plain.args[1:] if isinstance(plain, Select) and not plain.args[0].free_symbols & graded else (plain,)
    return 1 if _is_proportional(sides, graded) else None


def _is_proportional(values: Sequence[sp.Expr], graded: set[sp.Symbol]) -> bool:
    """Whether every term of the values has exactly one graded factor."""
    terms = [t for v in values for t in sp.Add.make_args(v)]
    return all([f in graded for f in sp.Mul.make_args(t) if f.free_symbols & graded] == [True] for t in terms)


def _without_division(
    program: Program, names: frozenset[sp.Symbol], length: sp.Symbol, graded: frozenset[sp.Symbol]
) -> Program:
    """The program in which the names are not divided, and have new names that say so."""
    taken = Names.of(program)
    called = {name: _called(name, taken) for name in sorted(graded, key=str)}
    body = []
    for s in program.body:
        if isinstance(s, Let) and s.name in graded:
            value = _times(s.value, length) if s.name in names else s.value
            s = replace(s, name=called.get(s.name, s.name), value=value)
        body.append(rewritten(s, lambda e: e.xreplace(called)))
    changed = normalise(program.name, body, [Output(o.name, o.value.xreplace(called)) for o in program.outputs])
    return _with_parts(changed, set(called.values()))


def _with_parts(program: Program, names: set[sp.Symbol]) -> Program:
    """The program with these names bound to the value on the first side of a choice, written out where only the choice
    reads it.
    """
    sources = {let.name: let for let in program.lets()}
    body = []
    for s in program.body:
        if isinstance(s, Let) and s.name in names and isinstance(s.value, Select) and s.value.args[1] in sources:
            source, (condition, _, otherwise) = sources[s.value.args[1]], s.value.args
            if is_read_once(program, source.name):
                s = replace(s, value=Select(condition, source.value, otherwise), note=_joined(source.note, s.note))
        body.append(s)
    return normalise(program.name, body, program.outputs)


def _joined(*notes: str) -> str:
    """Several notes in one."""
    return "; ".join(note for note in notes if note)


def _called(name: sp.Symbol, taken: Names) -> sp.Symbol:
    """`direction_x_q4` for `cos_q4`, `direction_y_q4` for `sin_q4`, `scaled_r21` for `r21`."""
    word, _, rest = name.name.partition("_")
    if word in ("direction", "scaled"):
        return name
    return taken.fresh(f"direction_{_AXES[word]}_{rest}" if word in _AXES else f"scaled_{name.name}")


def _times(value: sp.Expr, length: sp.Symbol) -> sp.Expr:
    return (
        value.func(value.args[0], value.args[1] * length, value.args[2])
        if isinstance(value, Select)
        else value * length
    )
