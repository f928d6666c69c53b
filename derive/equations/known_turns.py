"""Known rotations: their matrices, and names for coordinates in a frame behind them or in front of them.

`x_from_a12` is an x in the frame behind A1 and A2, `r13_before_a6` an entry of the rotation in front of A6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.angle_sums import name_of, terms_of
from derive.algebra.normal_form import is_compound, polynomial
from derive.equations.problem import Problem
from derive.geometry.frames import Factor
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, real

_LONG = 24
"""The most letters of the names of joints in the name of a frame."""


@dataclass(frozen=True)
class Side:
    """The known rotations at one end of the chain, from which the endings of names are made."""

    word: str
    end: str
    joints: tuple[str, ...] = ()
    """Base first."""
    fixed: int = 0
    """The number of fixed rotations since the last joint, without those by right angles, which only permute entries."""

    def behind(self, joints: tuple[str, ...], turn: Factor) -> Side:
        """The side with one more rotation."""
        if joints:
            return replace(
                self, joints=(*self.joints, *joints) if self.word == "from" else (*joints, *self.joints), fixed=0
            )
        is_oblique = any(entry not in (-1, 0, 1) for entry in turn.matrix())
        return replace(self, fixed=self.fixed + is_oblique)

    @property
    def suffix(self) -> str:
        """The end of the names of entries: `_from_a12`, `_from_a12_turned`, `_before_flange`; of many joints with long
        names, `_from_base_to_a4_elbow`, `_before_a5_elbow_to_flange`.
        """
        turned = ("", "_turned", *(f"_turned_{n}" for n in range(2, self.fixed + 1)))
        if self.joints:
            joints = name_of(tuple((real(name), 1) for name in self.joints))
            if len(joints) > _LONG:
                joints = f"base_to_{self._again(-1)}" if self.word == "from" else f"{self._again(0)}_to_flange"
            return f"_{self.word}_{joints}{turned[self.fixed]}"
        return f"_{self.word}_{self.end}{turned[self.fixed - 1]}" if self.fixed else ""

    def _again(self, place: int) -> str:
        """The name at one end; of an angle that stands at several links, with a number."""
        name, count = self.joints[place], self.joints.count(self.joints[place])
        return name if count == 1 else f"{name}_{count}"


def is_unknown(problem: Problem, factor: Factor) -> bool:
    """Whether a frame of the chain has an unknown joint."""
    return bool(factor.amount.free_symbols & {*problem.lengths, *problem.angles, *problem.pending})


def joints_of(problem: Problem, turn: Factor) -> tuple[str, ...]:
    """The names of the joints of a rotation: A3 for `a23 - a2`."""
    turned = sp.expand(turn.amount.xreplace(dict(problem.sums)))
    return tuple(a.name for a in problem.units if a in turned.free_symbols)


def matrix_of(problem: Problem, turn: Factor, lets: list[Let]) -> sp.Matrix:
    """The matrix of a known rotation, with names for the cosine and sine of a sum of angles."""
    matrix = sp.Matrix(turn.matrix()[:3, :3])
    table: dict[sp.Expr, sp.Expr] = {}
    for function in sorted(matrix.atoms(sp.sin, sp.cos), key=sp.default_sort_key):
        table[function] = polynomial(function, problem.units, problem.signs)
        terms = terms_of(function.args[0], problem.units)
        if terms is not None and len(terms) > 1:
            name = real(f"{'sin' if isinstance(function, sp.sin) else 'cos'}_{name_of(terms)}")
            lets.append(Let(name, table[function]))
            table[function] = name
    return matrix.xreplace(table)


def between_known(problem: Problem, *, moves_last: bool) -> tuple[list[Factor], sp.Matrix, list[Let]]:
    """The rotations from the first unknown one to the last, the commanded rotation that they must make, and the values
    in it. moves_last: whether the known ones behind the last are moved, too. One of them must be unknown.
    """
    turns, entries, lets = list(problem.turns), sp.Matrix(3, 3, list(problem.rotation)), list[Let]()
    front, back = Side("from", "base"), Side("before", "flange")
    while not is_unknown(problem, turns[0]):
        turn = turns.pop(0)
        front = front.behind(joints_of(problem, turn), turn)
        entries = _named_entries(matrix_of(problem, turn, lets).T * entries, front.suffix, lets)
    while moves_last and not is_unknown(problem, turns[-1]):
        turn = turns.pop()
        back = back.behind(joints_of(problem, turn), turn)
        entries = _named_entries(entries * matrix_of(problem, turn, lets).T, front.suffix + back.suffix, lets)
    return turns, entries, lets


def _named_entries(entries: sp.Matrix, word: str, lets: list[Let]) -> sp.Matrix:
    """The entries of a rotation; an entry that is more than a name gets a name."""
    return sp.Matrix(3, 3, lambda i, j: _named(entries[i, j], f"r{i + 1}{j + 1}{word}", lets))


def named_point(point: sp.Matrix, word: str, lets: list[Let]) -> sp.Matrix:
    """The coordinates of a point; a coordinate that is more than a name gets a name."""
    return sp.Matrix([_named(v, f"{c}{word}", lets) for c, v in zip(COORDINATE_NAMES, point, strict=True)])


def _named(value: sp.Expr, name: str, lets: list[Let]) -> sp.Expr:
    if not is_compound(value):
        return value
    lets.append(Let(real(name), value))
    return lets[-1].name


def needed(lets: Sequence[Let], expression: sp.Expr) -> tuple[Let, ...]:
    """The statements that bind the names in an expression, directly or by other names, in order."""
    wanted = set(expression.free_symbols)
    kept: list[Let] = []
    for let in reversed(lets):
        if let.name in wanted:
            kept.append(let)
            wanted |= let.value.free_symbols
    return tuple(reversed(kept))
