"""The pose of a spatial chain, frame by frame, with a name for every entry of every frame.

`r13_at_a23` is the x component of the z axis behind A2 and A3, in the frame of the base; `x_at_a4` is the x of axis A4.
Consecutive rotations about parallel axes are one rotation by the sum of their angles, so that `cos(a2 + a3)` stays one
cosine.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from derive.algebra.angle_sums import name_of, terms_of
from derive.algebra.normal_form import is_compound
from derive.description.mechanism import Mechanism
from derive.equations.closures.fixed_names import angles_of
from derive.equations.trigonometry import named_trigonometry
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import Screw
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.kept import kept_by_identity

Column = tuple[sp.Expr, sp.Expr, sp.Expr]


@dataclass(frozen=True)
class NamedPose:
    """The statements that bind the frames; position, rotation by rows, and the screw of every factor."""

    statements: tuple[Let, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    screws: tuple[Screw, ...]


@kept_by_identity(10)
def named_pose(mechanism: Mechanism) -> NamedPose:
    """The pose of the chain of a mechanism, composed from its base."""
    assert mechanism.chain is not None
    frames = _Frames(mechanism)
    for factor in mechanism.chain.factors:
        frames.append(factor)
    columns = frames.columns()
    rows = tuple(columns[j][i] for i in range(3) for j in range(3))
    return NamedPose(tuple(frames.lets.values()), tuple(frames.position), rows, tuple(frames.screws))


def _unit(axis: int) -> Column:
    entries = [sp.Integer(int(i == axis)) for i in range(3)]
    return entries[0], entries[1], entries[2]


@dataclass
class _Frames:
    mechanism: Mechanism
    lets: dict[sp.Symbol, Let] = field(default_factory=dict)
    position: list[sp.Expr] = field(default_factory=lambda: [sp.Integer(0)] * 3)
    screws: list[Screw] = field(default_factory=list)
    _base: tuple[Column, ...] = (_unit(0), _unit(1), _unit(2))
    """The axes of the frame in front of the current rotation."""
    _turn: Factor | None = None
    _names: list[str] = field(default_factory=list)
    """The joints so far: the last one names the frame."""

    def append(self, factor: Factor) -> None:
        """Compose the pose with one more factor."""
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
        """The axes of the frame, in the frame of the base."""
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
        """The name of the frame: that of its angle, or of the joint in front where its rotation is fixed."""
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
        self.position = [self._named(f"{c}_at_{key}", p) for c, p in zip(COORDINATE_NAMES, self.position, strict=True)]

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
