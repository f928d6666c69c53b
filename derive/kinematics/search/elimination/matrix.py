"""The linear equations for products of powers of the half angles of d and e, with c known: their matrix."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.ir.program import Call, Let, Solve
from derive.ir.symbols import cosine, real, sine
from derive.kinematics.search.elimination.equations import Equations
from derive.kinematics.search.elimination.order import EQUATIONS, Elimination

Entries = dict[tuple[int, int, int], sp.Expr]
"""By equation, and place among C², CS, S² of d, and of e."""


def call_of(equations: Equations) -> Call:
    """The call of the program that eliminates a and b."""
    program = equations.program
    return Call(
        program,
        tuple((s, s) for s in equations.arguments),
        tuple(real(o.name) for o in program.outputs),
        "two of the joints are eliminated",
    )


def entries_at(equations: Equations, cos_c: sp.Expr, sin_c: sp.Expr, numbers: range) -> tuple[list[Let], Entries]:
    """Equations where c has this cosine and sine: the statements, and by what their entries are read."""
    lets: list[Let] = []
    entries: Entries = {}
    for k in numbers:
        for x in range(3):
            for y in range(3):
                one, of_cosine, of_sine = (equations.table[k, power, x, y] for power in range(3))
                value = one + of_cosine * cos_c + of_sine * sin_c
                entries[k, x, y] = value
                if not value.is_Atom:
                    entries[k, x, y] = real(f"entry_{k}_{x}{y}")
                    lets.append(Let(entries[k, x, y], value))
    return lets, entries


def rows_of(elimination: Elimination, entries: Entries) -> Iterator[list[sp.Expr]]:
    """The matrix, by rows."""
    width = elimination.highest[1] + 1
    for k, i, j in elimination.rows:
        row: list[sp.Expr] = [sp.Integer(0)] * elimination.columns
        for x in range(3):
            for y in range(3):
                row[(i + x) * width + j + y] = entries[k, x, y]
        yield row


def determinant_of(equations: Equations) -> tuple[list[Let | Solve], sp.Expr]:
    """The determinant of the matrix: it vanishes where the arm closes. The statements read cosine and sine of c."""
    joint = equations.elimination.searched.symbol
    lets, entries = entries_at(equations, cosine(joint), sine(joint), VANISHING)
    rows = [entry for row in rows_of(equations.elimination, entries) for entry in row]
    note = "it vanishes where powers of two half angles satisfy all equations"
    return [*lets, Solve((), tuple(rows), (), real("determinant"), note)], real("determinant")


VANISHING = range(EQUATIONS)
"""The equations that vanish."""
UNKNOWNS = range(EQUATIONS, EQUATIONS + 4)
"""Those that give the unknowns of a and b."""
