"""A rotation that a caller gives: a matrix that is no rotation is refused, a rounded one is repaired, any other is used
bit for bit.

A frame may have been stored in single precision. The repair keeps the direction of the tool: z is normalised, x is made
perpendicular to it and normalised, and y = z × x. The repair runs once a call, before everything else; all other
programs read a rotation that is orthogonal to all digits. Nearly every frame is a rotation but for rounding, which
`surely_exact` finds out with half of the operations.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, reduce

import sympy as sp

from derive.equations.axes import finite
from derive.ir.constants import EXACT_ROTATION, ROTATION, SURE_ROTATION
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, larger
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Why, about_input
from derive.ir.symbols import ROTATION_ENTRIES, real

_RIGHT_HANDED = "a right-handed frame"
_GIVEN = sp.Matrix(3, 3, ROTATION_ENTRIES)
_COLUMNS = "xyz"
_PAIRS = ((0, 1), (0, 2), (1, 2))


@cache
def rotation_program() -> Program:
    """The program from r11 … r33 as given to r11 … r33 as used: the same for every mechanism that reads a rotation."""
    columns = [_GIVEN[:, k] for k in range(3)]
    sizes = [Let(real(f"uneven_{c}"), sp.Abs(v.dot(v) - 1)) for c, v in zip(_COLUMNS, columns, strict=True)]
    angles = [Let(real(f"askew_{_COLUMNS[i]}{_COLUMNS[j]}"), sp.Abs(columns[i].dot(columns[j]))) for i, j in _PAIRS]
    determinant = sum(columns[0][k] * columns[1].cross(columns[2])[k] for k in range(3))
    is_exact = sp.And(*[sp.Le(let.name, EXACT_ROTATION) for let in (*sizes, *angles)])
    lets, repaired = _repaired()
    chosen = [
        Let(real(f"made_{r.name}"), Select(is_exact, r, value))
        for r, value in zip(ROTATION_ENTRIES, repaired, strict=True)
    ]
    body: tuple[Statement, ...] = (
        *finite(ROTATION_ENTRIES),
        *sizes,
        _small(sizes, Why.COLUMNS_UNEVEN),
        *angles,
        _small(angles, Why.COLUMNS_ASKEW),
        Require(sp.Gt(determinant, 0), Status.BAD_INPUT, _RIGHT_HANDED, about_input(Why.NOT_GIVEN, _RIGHT_HANDED)),
        *lets,
        *chosen,
    )
    return normalise(
        "rotation", body, [Output(r.name, let.name) for r, let in zip(ROTATION_ENTRIES, chosen, strict=True)]
    )


@cache
def surely_exact() -> tuple[sp.Basic, ...]:
    """The conditions that x and y are at right angles and of length one, and z is x × y: the program then changes
    nothing.

    The bound is so small that all of |R^T R - I| is below `EXACT_ROTATION`: z z differs from one by less than two and a
    half bounds more than x x and y y together.
    """
    x, y, z = (_GIVEN[:, k] for k in range(3))
    errors = [x.dot(x) - 1, y.dot(y) - 1, x.dot(y), *(x.cross(y) - z)]
    return tuple(sp.Le(sp.Abs(error), SURE_ROTATION) for error in errors)


def _small(errors: list[Let], why: Why) -> Require:
    """The condition that all errors are small; the amount of its reason is the largest of them."""
    conditions = [sp.Le(let.name, ROTATION) for let in errors]
    return Require(
        sp.And(*conditions), Status.BAD_INPUT, reason=about_input(why, amount=_largest([let.name for let in errors]))
    )


def _largest(values: Sequence[sp.Expr]) -> sp.Expr:
    first, *others = values
    return reduce(lambda most, value: larger(value, most), others, first)


def _repaired() -> tuple[list[Let], sp.Matrix]:
    """Unit vectors along z, along the part of x that is perpendicular to z, and along z × x."""
    x, z = _GIVEN[:, 0], _GIVEN[:, 2]
    along_z, divisor_x = real("along_z"), real("divisor_x")
    unit_z, across_z = (sp.Matrix([real(f"{word}_z{k}") for k in (1, 2, 3)]) for word in ("unit", "across"))
    lets = [
        *_length(z, "z", "z keeps its direction, which is that of the tool"),
        *(Let(n, v / real("divisor_z")) for n, v in zip(unit_z, z, strict=True)),
        Let(along_z, x.dot(unit_z)),
        *(Let(n, v - along_z * u) for n, v, u in zip(across_z, x, unit_z, strict=True)),
        *_length(across_z, "x", "x is made perpendicular to z"),
    ]
    return lets, sp.Matrix.hstack(across_z / divisor_x, unit_z.cross(across_z) / divisor_x, unit_z)


def _length(vector: sp.Matrix, word: str, note: str) -> tuple[Let, Let]:
    """The length of a column, and a divisor that is never zero: a matrix that is no rotation may have a column of
    zeros.
    """
    length = real(f"length_{word}")
    nonzero = Select(sp.Gt(length, sp.Rational(1, 2)), length, sp.Integer(1))
    return Let(length, Root(vector.dot(vector)), note), Let(real(f"divisor_{word}"), nonzero)
