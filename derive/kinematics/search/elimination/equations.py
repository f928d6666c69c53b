"""The statements that compute the six equations in half angles of d and e, linear in cosine and sine of c.

The lines on the known side are moved up to c, link after link; the equations, as rows, are moved back from b to c. What
depends on the machine alone is computed once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import held_lets, reference_value
from derive.equations.closures.fixed_names import fixed_lets
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Program, Solve, Statement
from derive.ir.symbols import real
from derive.kinematics.search.elimination.line import SIZE, Move, axis_line
from derive.kinematics.search.elimination.numbers import halves
from derive.kinematics.search.elimination.order import PRODUCTS, Elimination
from derive.kinematics.search.elimination.ring import Fixed, Place
from derive.kinematics.search.programs import GOAL

NAME = "eliminate_two_joints"
_UNKNOWNS = (3, 6, 1, 2)
"""The two unknowns of a, then those of b, among all products of 1 and the unknowns of both."""
Vector = list[sp.Expr]


@dataclass(frozen=True)
class Equations:
    """The program, and by what its outputs are read."""

    elimination: Elimination
    program: Program
    arguments: tuple[sp.Symbol, ...]
    """Its inputs that are no constants of the machine."""
    table: dict[tuple[int, int, int, int], sp.Expr]
    """By equation, power of c (1, cosine, sine), place among C², CS, S² of d, and of e: a name, or a number.

    The first six vanish; the others are the two unknowns of a, then those of b.
    """


@dataclass
class Written:
    """Statements, with a new name for every value that is no name or number."""

    statements: list[Statement] = field(default_factory=list)
    count: int = 0

    def named(self, word: str, value: sp.Expr) -> sp.Expr:
        """The name of a value."""
        if value.is_Atom or (-value).is_Atom:
            return value
        self.count += 1
        name = real(f"{word}_{self.count}")
        self.statements.append(Let(name, value))
        return name

    def through(self, word: str, line: Vector, link: Iterable[Fixed]) -> Vector:
        """A line behind a link."""
        for fixed in reversed(tuple(link)):
            line = [self.named(word, v) for v in _times(fixed.move, line)]
        return line

    def back(self, word: str, row: Vector, link: Iterable[Fixed]) -> Vector:
        """A row of an equation for lines in front of a link."""
        for fixed in link:
            matrix = fixed.move.matrix
            row = [self.named(word, sp.Add(*terms)) for terms in _columns(row, matrix)]
        return row


def equations_of(mechanism: Mechanism, elimination: Elimination) -> Equations:
    """The program that eliminates a and b."""
    ring = elimination.ring
    _, _, c, d, e, f = ring.places
    held = (let for j in mechanism.held_joints for let in held_lets(j))
    written = Written([*fixed_lets(mechanism), *held, *ring.lets])
    line = written.through("line", list(axis_line(f.axis)), ring.links[4])
    lines: dict[tuple[int, int], Vector] = {}
    for y, one in enumerate(_halved(written, line, e)):
        behind = written.through("line", one, ring.links[3])
        for x, other in enumerate(_halved(written, behind, d)):
            lines[x, y] = written.through("line", other, ring.links[2])
    rows = _rows(written, elimination)
    table: dict[tuple[int, int, int, int], sp.Expr] = {}
    for k, row in enumerate(rows):
        moved = written.back("row", row, ring.links[1])
        for power, part in enumerate(c.move.parts):
            turned = [sp.Add(*terms) for terms in _columns(moved, sp.Matrix(part))]
            for (x, y), values in lines.items():
                value = sp.Add(*(r * v for r, v in zip(turned, values, strict=True)))
                table[k, power, x, y] = _with_name(written, f"equation_{k}_{power}_{x}{y}", value)
    found = dict.fromkeys(v for v in table.values() if v.is_Symbol)
    program = normalise(NAME, written.statements, [Output(v.name, v) for v in found])
    summary = "Six equations without two of the joints, linear in cosine and sine of the searched one"
    own = {*GOAL.values(), *map(reference_value, mechanism.joints)}
    return Equations(
        elimination, replace(program, summary=summary), tuple(s for s in program.inputs if s in own), table
    )


def _with_name(written: Written, name: str, value: sp.Expr) -> sp.Expr:
    if value.is_number:
        return value
    written.statements.append(Let(real(name), value))
    return real(name)


def _times(move: Move, line: Vector) -> Vector:
    """A line behind a motion."""
    found: list[list[sp.Expr]] = [[] for _ in line]
    for (i, j), entry in sorted(sp.SparseMatrix(move.matrix).todok().items()):
        found[i].append(entry * line[j])
    return [sp.Add(*terms) for terms in found]


def _columns(row: Vector, matrix: sp.Matrix) -> list[list[sp.Expr]]:
    """The terms of a row times a matrix, by columns."""
    found: list[list[sp.Expr]] = [[] for _ in range(SIZE)]
    for (i, j), entry in sorted(sp.SparseMatrix(matrix).todok().items()):
        found[j].append(row[i] * entry)
    return found


def _halved(written: Written, line: Vector, place: Place) -> list[Vector]:
    """The lines behind a joint that belong to C², CS and S² of it."""
    parts = [list(sp.Matrix(part) * sp.Matrix(line)) for part in place.move.parts]
    return [
        [written.named("line", sp.Add(*(int(n) * p[i] for n, p in zip(row, parts, strict=True)))) for i in range(SIZE)]
        for row in halves(place)
    ]


def _rows(written: Written, elimination: Elimination) -> list[Vector]:
    """The equations, as rows that known lines are multiplied by."""
    constant, *unknown = _eliminated_side(written, elimination)
    solved, left = elimination.solved, elimination.left
    wanted = [place - 1 for place in _UNKNOWNS]
    names = {(n, s): real(f"factor_{n}_{s}") for n in range(len(left) + len(wanted)) for s in solved}
    matrix = [unknown[m][s] for m, s in product(range(PRODUCTS), solved)]
    right: list[sp.Expr] = []
    for m in range(PRODUCTS):
        right += [*(unknown[m][k] for k in left), *(sp.Integer(int(m == w)) for w in wanted)]
    bound = [names[n, s] for s in solved for n in range(len(left) + len(wanted))]
    note = "what every equation takes from those that give the products of two joints"
    written.statements.append(Solve(tuple(bound), tuple(matrix), tuple(right), None, note))
    rows = [_row(constant, {k: sp.Integer(1)} | {s: -names[n, s] for s in solved}) for n, k in enumerate(left)]
    rows += [_row(constant, {s: names[len(left) + n, s] for s in solved}) for n in range(len(wanted))]
    return [[written.named("row", v) for v in row] for row in rows]


def _eliminated_side(written: Written, elimination: Elimination) -> list[Vector]:
    """The line seen from b, on the way over a: what is multiplied by each product of unknowns of a and b."""
    a, b, *_, f = elimination.ring.places
    line = written.through("eliminated", list(axis_line(f.axis)), _inverse(elimination.ring.links[5]))
    found: list[Vector] = []
    for part in a.inverse.move.parts:
        behind = [written.named("eliminated", v) for v in sp.Matrix(part) * sp.Matrix(line)]
        behind = written.through("eliminated", behind, _inverse(elimination.ring.links[0]))
        for other in b.inverse.move.parts:
            found.append([written.named("eliminated", v) for v in sp.Matrix(other) * sp.Matrix(behind)])
    return found


def _row(constant: Vector, factors: dict[int, sp.Expr]) -> Vector:
    """An equation: values times factors, without what neither a nor b moves."""
    row: Vector = [sp.Integer(0)] * SIZE
    for k, factor in factors.items():
        row[k] = factor
        row[0] -= factor * constant[k]
    return row


def _inverse(link: Sequence[Fixed]) -> tuple[Fixed, ...]:
    return tuple(fixed.inverse for fixed in reversed(link))
