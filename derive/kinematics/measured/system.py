"""A linear system in two parts of at most three equations each, by inverses with names: no pivots are sought.

The unknowns `turns` are eliminated from the last equations, the others follow from the first ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import sympy as sp

from derive.algebra.normal_form import is_compound
from derive.ir.primitives import Select
from derive.ir.program import Let
from derive.ir.symbols import real


@dataclass
class System:
    """The inverse of a matrix. first: its first equations. turns: the columns of the unknowns that are eliminated."""

    matrix: sp.Matrix
    first: int
    turns: Sequence[int]
    least: Sequence[sp.Expr]
    """Determinants of at most this size, of the last and of the first equations, are taken for zero."""
    lets: list[Let] = field(default_factory=list)
    conditions: list[sp.Basic] = field(default_factory=list)
    """They hold where the matrix has an inverse."""

    def __post_init__(self) -> None:
        """Name the inverses of both parts."""
        self.others = [k for k in range(self.matrix.cols) if k not in self.turns]
        self.shifted = self.matrix[: self.first, :].extract(range(self.first), self.turns)
        last = self.matrix[self.first :, :]
        self.turning = self._inverse("turning", last.extract(range(last.rows), self.turns), self.least[0])
        self.carried = self._named("carried", self.turning * last.extract(range(last.rows), self.others))
        own = self.matrix.extract(range(self.first), self.others) - self.shifted * self.carried
        self.shifting = self._inverse("shifting", self._named("shift", own), self.least[1])

    def solve(self, word: str, right: sp.Matrix) -> sp.Matrix:
        """The unknowns for a right-hand side."""
        turned = self._named(f"turned_by_{word}", self.turning * right[self.first :, :])
        rest = self._named(f"rest_of_{word}", right[: self.first, :] - self.shifted * turned)
        others = self._named(f"others_by_{word}", self.shifting * rest)
        turns, found = turned - self.carried * others, sp.zeros(self.matrix.cols, 1)
        for places, values in ((self.others, others), (self.turns, turns)):
            for place, value in zip(places, values, strict=True):
                found[place] = value
        return found

    def _inverse(self, word: str, matrix: sp.Matrix, least: sp.Expr) -> sp.Matrix:
        if not matrix.rows:
            return matrix
        adjugate = self._named(f"adjugate_{word}", matrix.adjugate())
        determinant = real(f"determinant_{word}")
        self.lets.append(Let(determinant, (matrix[0, :] * adjugate[:, 0])[0]))
        is_regular = sp.Gt(sp.Abs(determinant), least)
        self.conditions.append(is_regular)
        divided = self._named(f"one_by_{word}", sp.Matrix([1 / Select(is_regular, determinant, sp.Integer(1))]))
        return self._named(f"inverse_{word}", adjugate * divided[0])

    def _named(self, word: str, matrix: sp.Matrix) -> sp.Matrix:
        found = []
        for k, value in enumerate(matrix):
            name = real(f"{word}_{k // matrix.cols + 1}_{k % matrix.cols + 1}")
            self.lets += [Let(name, value)] if is_compound(value) else []
            found.append(name if is_compound(value) else value)
        return sp.Matrix(matrix.rows, matrix.cols, found)
