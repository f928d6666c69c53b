"""Angles are added before their sines are taken, for a language in which a sine costs no more than a few products.

    along  = x * u + y * v                  (x, y) turned back by the direction (u, v) of the arm
    across = y * u - x * v
    c2, s2 = along/l, across/l              angle_q2 = atan2(y, x) - atan2(v, u)
    c23 = c2 * c3 - s2 * s3           →     c23 = cos(angle_q2 + angle_q3)
    s23 = s2 * c3 + c2 * s3                 s23 = sin(angle_q2 + angle_q3)

Two branches share these angles, or have them with opposite signs. No digits are lost: an arc tangent is as exact as its
arguments. Two names `cos_…` and `sin_…` of one angle have length one; any other pair is a direction, of which only the
angle is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Select
from derive.ir.program import Let, Program, Statement, rewritten
from derive.ir.symbols import Names, angle_of, angle_word, is_branch_sign, real, symbols_of
from derive.ir.symbols import cosine as cosine_of
from derive.ir.symbols import sine as sine_of
from derive.optimize.directions import Pair, lengths_of, products
from derive.optimize.without_periods import angles_modulo_turns

_Values = Mapping[sp.Symbol, sp.Expr]
_Signs = Mapping[sp.Symbol, frozenset[sp.Symbol]]
"""For each name: the branch signs on which it depends."""


def with_added_angles(program: Program, constants: frozenset[str]) -> Program:
    """The program with angles added before their sines and cosines are taken, where nothing else reads the latter."""
    values = {let.name: let.value for let in program.lets()}
    context = _Known(values, constants, _signs(program), lengths_of(program))
    names = _directions_modulo_turns(program)
    candidates = {pair: _angle(pair, context) for pair in names}
    angles = {pair: angle for pair, angle in candidates.items() if angle is not None}
    sums = {s.pair: s for s in _sums(values, angles)}
    while True:
        wanted = {pair: {name for s in sums.values() if pair in s.parts for name in s.pair} for pair in angles}
        known = {pair for pair, readers in wanted.items() if _readers(program, pair) <= readers}
        fewer = {pair: s for pair, s in sums.items() if known.issuperset(s.parts)}
        if fewer == sums:
            return _with_angles(program, {p: a for p, a in angles.items() if p in known}, names, list(sums.values()))
        sums = fewer


@dataclass(frozen=True)
class _Known:
    """Known properties of the names of a program."""

    values: _Values
    constants: frozenset[str]
    signs: _Signs
    lengths: frozenset[sp.Symbol]


@dataclass(frozen=True)
class _Sum:
    """Sine and cosine of a signed sum of two angles, or of that sum plus half a turn."""

    pair: Pair
    parts: tuple[Pair, Pair]
    senses: tuple[int, int]
    is_opposite: bool


def _directions_modulo_turns(program: Program) -> dict[Pair, sp.Symbol]:
    """The names whose arc tangent is taken, and may be a turn more or less, with the name of the angle."""
    nodes = (node for let in program.lets() for node in sp.preorder_traversal(let.value) if isinstance(node, Atan2))
    pairs = [node.args for node in dict.fromkeys(nodes) if all(a.is_Symbol for a in node.args)]
    names, taken = {let.value: let.name for let in program.lets() if isinstance(let.value, Atan2)}, Names.of(program)
    for pair in pairs:
        if Atan2(*pair) not in names:
            names[Atan2(*pair)] = taken.fresh(_name_of(pair))
    free = angles_modulo_turns(replace(program, body=_read_by_name(program, names)))
    return {(s, c): names[Atan2(s, c)] for s, c in pairs if names[Atan2(s, c)] in free}


def _read_by_name(program: Program, names: Mapping[sp.Basic, sp.Basic]) -> tuple[Statement, ...]:
    """The statements with names in place of angles, which are bound first."""
    bound = [s for s in program.body if not (isinstance(s, Let) and names.get(s.value) == s.name)]
    lets = [Let(real(str(name)), angle) for angle, name in names.items() if isinstance(angle, Atan2)]
    return (*lets, *(rewritten(s, lambda e: e.xreplace(dict(names))) for s in bound))


def _name_of(pair: Pair) -> str:
    """`angle_q2` of `cos_q2` or `direction_x_q2`."""
    return f"angle_{angle_word(pair[1])}"


def _angle(pair: Pair, known: _Known) -> sp.Expr | None:
    """The angle of a direction that is another direction turned: where a condition holds, or always."""
    sine, cosine = (known.values.get(name, name) for name in pair)
    if not (isinstance(sine, Select) and isinstance(cosine, Select)):
        return _turned(sine, cosine, known)
    (condition, across, sine_else), (same, along, cosine_else) = sine.args, cosine.args
    if condition != same or not isinstance(sine_else, sp.sin) or cosine_else != sp.cos(sine_else.args[0]):
        return None
    for length in [1 / f for f in sp.Mul.make_args(along) if 1 / f in known.lengths]:
        across, along = (across * length, along * length)  # a divisor of only one of the two would be left
    first = _turned(known.values.get(across, across), known.values.get(along, along), known)
    return None if first is None else Select(condition, first, sine_else.args[0])


def _turned(sine: sp.Expr, cosine: sp.Expr, known: _Known) -> sp.Expr | None:
    """The angle of one direction turned by another, or by an angle of the machine."""
    found = sorted(products(sine, cosine), key=lambda product: sum(_is_flipped(p, known.signs) for _, p in product[1:]))
    for is_opposite, (sense1, first), (sense2, second) in found:
        return sense1 * Atan2(*first) + sense2 * Atan2(*second) + (180 * DEGREE if is_opposite else 0)
    moving = sorted((s for s in symbols_of(cosine) if s.name not in known.constants), key=str)
    for x, y in (moving, moving[::-1]) if len(moving) == 2 else ():
        a, b = sine.coeff(y), sine.coeff(x)
        if sp.expand(cosine - a * x + b * y) == 0 and sp.expand(sine - b * x - a * y) == 0:
            return Atan2(b, a) + Atan2(y, x)
    return None


def _is_flipped(pair: Pair, signs: _Signs) -> bool:
    """Whether a branch mirrors a direction at its second axis: its angle is then not just the negative."""
    sine, cosine = (signs.get(name, frozenset()) for name in pair)
    return not cosine <= sine


def _signs(program: Program) -> _Signs:
    """The branch signs that every name depends on."""
    found = {s: frozenset({s}) for s in program.inputs if is_branch_sign(s)}
    for let in program.lets():
        found[let.name] = frozenset[sp.Symbol]().union(*(found.get(s, frozenset()) for s in symbols_of(let.value)))
    return found


def _sums(values: _Values, angles: Mapping[Pair, sp.Expr]) -> list[_Sum]:
    """The pairs that the addition theorem makes of two such directions."""
    found = []
    for angle in [angle for angle in map(angle_of, values) if angle is not None]:
        cosine, sine = cosine_of(angle), sine_of(angle)
        if sine in values:
            for is_opposite, (sense1, first), (sense2, second) in products(values[sine], values[cosine]):
                if first in angles and second in angles and all(map(_are_of_one_angle, (first, second))):
                    found.append(_Sum((sine, cosine), (first, second), (sense1, sense2), is_opposite))
                    break
    return found


def _are_of_one_angle(pair: Pair) -> bool:
    """Whether two names are the sine and the cosine of an angle: a derivation gives these names to nothing else."""
    angle = angle_of(pair[1])
    return angle is not None and pair[0] == sine_of(angle)


def _readers(program: Program, pair: Pair) -> set[sp.Symbol | None]:
    """The readers of a direction that need more than its angle: the names that they bind, None for other statements."""
    found: set[sp.Symbol | None] = set()
    for statement in program.body:
        plain = rewritten(statement, lambda e: e.xreplace({Atan2(*pair): sp.Integer(0)}))
        if plain.reads() & set(pair):
            found.add(statement.name if isinstance(statement, Let) else None)
    return found | {None for o in program.outputs if symbols_of(o.value) & set(pair)}


def _with_angles(
    program: Program, angles: Mapping[Pair, sp.Expr], names: Mapping[Pair, sp.Symbol], sums: Sequence[_Sum]
) -> Program:
    """The program with names for these angles, and with the sines and cosines of their sums."""
    taken = Names(s.name for s in (*program.inputs, *program.bound(), *names.values()))
    parts: dict[sp.Basic, sp.Symbol] = {}
    for part in (p for angle in angles.values() for p in sorted(angle.atoms(Atan2), key=str)):
        if part not in parts and part.args[1].is_Symbol:
            parts[part] = taken.fresh(f"angle_of_{angle_word(part.args[1])}")
    lets: list[Statement] = [Let(name, sp.sympify(part)) for part, name in parts.items()]
    lets += [Let(names[pair], angle.xreplace(parts)) for pair, angle in angles.items()]
    sines: dict[sp.Symbol, sp.Expr] = {}
    for s in sums:
        total, sign = taken.fresh(_name_of(s.pair)), -1 if s.is_opposite else 1
        lets.append(Let(total, sp.Add(*[sense * names[part] for sense, part in zip(s.senses, s.parts, strict=True)])))
        sines |= {s.pair[0]: sign * sp.sin(total), s.pair[1]: sign * sp.cos(total)}
    known = {Atan2(*pair): names[pair] for pair in angles}
    for statement in program.body:
        if isinstance(statement, Let) and statement.name in sines:
            lets.append(replace(statement, value=sines[statement.name]))
        elif not (isinstance(statement, Let) and known.get(statement.value) == statement.name):
            lets.append(rewritten(statement, lambda e: e.xreplace(known)))
    return normalise(program.name, lets, program.outputs)
