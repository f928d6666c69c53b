"""Rotation identities: the cross product of two columns of a rotation is the third column.

    dx = -r33', dy = r23   (or a free direction)          y = select(radius > known, r12' * …, dx * r21 + dy * r31')
    y = dx * r21 + dy * r31'                         →    with r12' = cos * r12 + sin * r32, of the same rotation

(dx, dy) is the part of a column at right angles to the axis, divided by its length. If this length is far from zero,
the turned value equals an entry of the third column times a factor, which is as exact and shorter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.constants import FREE_ANGLE, KNOWN_ANGLE
from derive.ir.passes import normalise
from derive.ir.primitives import Select
from derive.ir.program import Let, Program
from derive.ir.symbols import ROTATION_ENTRIES, angle_of
from derive.ir.symbols import cosine as cosine_of
from derive.ir.symbols import sine as sine_of

_Entries = tuple[tuple[sp.Expr, ...], ...]
"""The entries of a rotation by rows: names or expressions."""


def with_rotation_identities(program: Program) -> Program:
    """The program in which such products are replaced by entries, where the direction is well known."""
    values = {let.name: let.value for let in program.lets()}
    rotations = list(_rotations(values))
    body = list(program.body)
    for place, statement in enumerate(body):
        if isinstance(statement, Let):
            found = _third(statement.value, values, rotations)
            if found is not None:
                body[place] = replace(statement, value=found)
    return normalise(program.name, body, program.outputs)


def _rotations(values: Mapping[sp.Symbol, sp.Expr]) -> Iterator[_Entries]:
    """The commanded rotation, and the remaining rotation after every turn of two rows whose entries have names."""
    names = {value: name for name, value in values.items()}
    pending: list[_Entries] = [tuple(tuple(ROTATION_ENTRIES[3 * i : 3 * i + 3]) for i in range(3))]
    while pending:
        rotation = pending.pop(0)
        yield rotation
        for angle in [angle for angle in map(angle_of, values) if angle is not None]:
            cosine, sine = cosine_of(angle), sine_of(angle)
            for i, j in ((0, 1), (1, 2), (2, 0)):
                for sense in (1, -1):
                    turned = _turned(rotation, i, j, cosine, sense * sine)
                    if all(any(entry in names for entry in turned[row]) for row in (i, j)):
                        pending.append(tuple(tuple(names.get(e, e) for e in row) for row in turned))


def _turned(rotation: _Entries, i: int, j: int, cosine: sp.Expr, sine: sp.Expr) -> _Entries:
    """The rotation with two rows turned."""
    first = tuple(cosine * a + sine * b for a, b in zip(rotation[i], rotation[j], strict=True))
    second = tuple(cosine * b - sine * a for a, b in zip(rotation[i], rotation[j], strict=True))
    return tuple(first if row == i else second if row == j else entries for row, entries in enumerate(rotation))


@dataclass(frozen=True)
class _Product:
    """A term of the cross product: a coordinate of the direction times an entry of another column."""

    condition: sp.Basic
    """The condition under which the coordinate of the direction is `first`, an entry of a column, times `factor`."""
    factor: sp.Expr
    first: sp.Symbol
    second: sp.Symbol


def _third(value: sp.Expr, values: Mapping[sp.Symbol, sp.Expr], rotations: Sequence[_Entries]) -> sp.Expr | None:
    """The choice between an entry of the third column and the value; None if the value is no such product."""
    entries = {e for rotation in rotations for row in rotation for e in row if e.is_Symbol}
    terms = [_product(term, values, entries) for term in sp.Add.make_args(value)]
    if len(terms) != 2 or terms[0] is None or terms[1] is None:
        return None
    one, other = terms[0], terms[1]
    if one.condition != other.condition or one.factor != -other.factor:
        return None
    for rotation in rotations:
        place = {e: (i, k) for i, row in enumerate(rotation) for k, e in enumerate(row)}
        if place.keys() >= {one.first, one.second, other.first, other.second}:
            (i, q), (j, p) = place[one.first], place[one.second]
            if (place[other.first], place[other.second]) == ((j, q), (i, p)) and i != j and p != q:
                sign = sp.LeviCivita(i, j, 3 - i - j) * sp.LeviCivita(q, p, 3 - q - p)
                third = rotation[3 - i - j][3 - q - p]
                return Select(one.condition.xreplace({FREE_ANGLE: KNOWN_ANGLE}), sign * one.factor * third, value)
    return None


def _product(term: sp.Expr, values: Mapping[sp.Symbol, sp.Expr], entries: set[sp.Expr]) -> _Product | None:
    coordinates = [f for f in sp.Mul.make_args(term) if isinstance(values.get(f), Select) and f not in entries]
    seconds = [f for f in sp.Mul.make_args(term) if f in entries]
    if len(coordinates) != 1 or len(seconds) != 1:
        return None
    condition, value, _ = values[coordinates[0]].args
    firsts = [f for f in sp.Mul.make_args(value) if f in entries]
    if len(firsts) != 1 or not isinstance(condition, sp.StrictGreaterThan):
        return None
    return _Product(condition, term / coordinates[0] / seconds[0] * value / firsts[0], firsts[0], seconds[0])
