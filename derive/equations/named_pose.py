"""The pose of a chain that turns about several axes, frame by frame, every entry of every frame under a name.

`r13_at_a23` is the z axis behind A2 and A3, seen from the base; `x_at_a4` is where A4 turns. Parallel turns that
follow each other are one turn by the sum of their angles, so that `cos(a2 + a3)` stays one cosine.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from derive.algebra.angle_sums import name_of, terms_of
from derive.algebra.normal_form import is_compound
from derive.description.mechanism import (
    Mechanism,
)
from derive.equations.closure import angles_of
from derive.equations.trigonometry import named_trigonometry
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import Screw
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import (
    COORDINATE_NAMES,
    real,
)

Column = tuple[sp.Expr, sp.Expr, sp.Expr]


@dataclass(frozen=True)
class Walk:
    """The statements that name the frames; position, rotation by rows, and the screw of every factor."""

    statements: tuple[Let, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    screws: tuple[Screw, ...]


def walk(mechanism: Mechanism) -> Walk:
    """Walk the chain from its base."""
    assert mechanism.chain is not None
    walker = _Walker(mechanism)
    for factor in mechanism.chain.factors:
        walker.pass_over(factor)
    columns = walker.columns()
    rows = tuple(columns[j][i] for i in range(3) for j in range(3))
    return Walk(tuple(walker.lets.values()), tuple(walker.position), rows, tuple(walker.screws))


def _unit(axis: int) -> Column:
    entries = [sp.Integer(int(i == axis)) for i in range(3)]
    return entries[0], entries[1], entries[2]


@dataclass
class _Walker:
    mechanism: Mechanism
    lets: dict[sp.Symbol, Let] = field(default_factory=dict)
    position: list[sp.Expr] = field(default_factory=lambda: [sp.Integer(0)] * 3)
    screws: list[Screw] = field(default_factory=list)
    _base: tuple[Column, ...] = (_unit(0), _unit(1), _unit(2))
    """The columns of the frame before the turn that is being made."""
    _turn: Factor | None = None
    _names: list[str] = field(default_factory=list)
    """The joints passed so far: the last one names the frame."""

    def pass_over(self, factor: Factor) -> None:
        """Go through one factor."""
        if factor.motion is Motion.SHIFT:
            direction = self.columns()[factor.axis]
            self.screws.append(self._screw(factor, direction))
            self.position = [p + d * factor.amount for p, d in zip(self.position, direction, strict=True)]
            return
        self._name_position(factor)
        self.screws.append(self._screw(factor, self.columns()[factor.axis]))
        previous = self._turn
        if previous is not None and previous.motion is factor.motion is Motion.TURN and previous.axis == factor.axis:
            self._turn = Factor(Motion.TURN, factor.axis, sp.expand(previous.amount + factor.amount))
        else:
            self._base, self._turn = self.columns(), factor

    def columns(self) -> tuple[Column, ...]:
        """The axes of the frame, seen from the base."""
        if self._turn is None:
            return self._base
        matrix = self._turn.matrix()[:3, :3]
        lets, values = named_trigonometry(self.mechanism, list(matrix))
        self.lets.update({let.name: let for let in lets})
        turned = sp.Matrix(3, 3, lambda i, j: self._base[j][i]) * sp.Matrix(3, 3, values)
        word = self._frame()
        columns = [[self._named(f"r{i + 1}{j + 1}_at_{word}", turned[i, j]) for i in range(3)] for j in range(3)]
        return tuple((c[0], c[1], c[2]) for c in columns)

    def _frame(self) -> str:
        """What the frame is called: after the angles of its turn, or after the joint before a fixed turn."""
        assert self._turn is not None
        angles = [a for a in angles_of(self.mechanism) if a in self._turn.amount.free_symbols]
        terms = terms_of(self._turn.amount, angles) or tuple((a, 1) for a in angles)
        if terms:
            return name_of(terms)
        return f"{self._names[-1]}_turned" if self._names else "base"

    def _screw(self, factor: Factor, direction: Column) -> Screw:
        return Screw(factor.motion, factor.amount, sp.ImmutableMatrix(direction), sp.ImmutableMatrix(self.position))

    def _name_position(self, factor: Factor) -> None:
        moving = [a for a in angles_of(self.mechanism) if a in factor.amount.free_symbols]
        if not moving:
            return
        key = "_".join(a.name for a in moving)
        self._names.append(key)
        self.position = [
            self._named(f"{c}_at_{key}", p) for c, p in zip(COORDINATE_NAMES, self.position, strict=True)
        ]

    def _named(self, name: str, value: sp.Expr) -> sp.Expr:
        """The value where it is a symbol or a number, else its name."""
        if not is_compound(value):
            return value
        number, symbol = 1, real(name)
        while symbol in self.lets and self.lets[symbol].value != value:
            number += 1
            symbol = real(f"{name}_{number}")
        self.lets.setdefault(symbol, Let(symbol, value))
        return symbol
