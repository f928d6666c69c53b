"""The pose of the true chain: between two motions stands one rigid frame, which the setup computes."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from derive.algebra.normal_form import is_compound
from derive.description.mechanism import Mechanism
from derive.equations.closures.fixed_names import fixed_angles
from derive.equations.named_pose import NamedPose
from derive.form.deviations import true_factors
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import Screw
from derive.ir.constants import DEGREE
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, cosine, real, sine


def true_pose(mechanism: Mechanism) -> NamedPose:
    """The pose of a machine with deviations at its joint values; its screws are the motions alone."""
    off = {p.given_name: p.symbol for p in mechanism.parameters}
    moved = {j.symbol for j in mechanism.joints}
    frames = _Frames({a: a * DEGREE for a in fixed_angles(mechanism)})
    for factor in true_factors(mechanism, off):
        if factor.amount.free_symbols & moved:
            frames.move(factor)
        else:
            frames.rigid.append(factor)
    frames.close("tool")
    lets, rotation = tuple(frames.lets.values()), tuple(frames.rotation)
    return NamedPose(lets, tuple(frames.position), rotation, tuple(frames.screws))


@dataclass
class _Frames:
    fixed: dict[sp.Symbol, sp.Expr]
    """The angles of the machine in radians."""
    lets: dict[sp.Symbol, Let] = field(default_factory=dict)
    position: sp.Matrix = field(default_factory=lambda: sp.zeros(3, 1))
    rotation: sp.Matrix = field(default_factory=lambda: sp.eye(3))
    screws: list[Screw] = field(default_factory=list)
    rigid: list[Factor] = field(default_factory=list)
    """The factors since the last motion."""

    def move(self, factor: Factor) -> None:
        """Compose with the rigid frame, and with a turn or a shift behind it."""
        word = f"motion_{len(self.screws) + 1}"
        self.close(word)
        direction, origin = sp.ImmutableMatrix(self.rotation[:, factor.axis]), sp.ImmutableMatrix(self.position)
        self.screws.append(Screw(factor.motion, factor.amount, direction, origin))
        if factor.motion is Motion.SHIFT:
            self.position = self.named(f"moved_{word}", self.position + self.rotation[:, factor.axis] * factor.amount)
            return
        self.rotation = self.named(f"turned_{word}", self.rotation * self._with_names(factor.matrix()[:3, :3], word))

    def close(self, word: str) -> None:
        """Compose with the rigid frame."""
        frame = sp.eye(4)
        for factor in self.rigid:
            frame = frame * factor.matrix()
        frame = self._with_names(frame, word)
        place, turn = self.named(f"rigid_{word}", frame[:3, 3]), self.named(f"rigid_{word}", frame[:3, :3])
        self.position = self.named(f"at_{word}", self.position + self.rotation * place)
        self.rotation = self.named(f"at_{word}", self.rotation * turn)
        self.rigid = []

    def _with_names(self, matrix: sp.Matrix, word: str) -> sp.Matrix:
        """The matrix with names for its sines and cosines."""
        table: dict[sp.Basic, sp.Symbol] = {}
        known = {value: a for a, value in self.fixed.items()}
        for function in sorted(matrix.atoms(sp.sin, sp.cos), key=sp.default_sort_key):
            angle = function.args[0]
            own = known.setdefault(angle, angle if angle.is_Symbol else real(f"angle_{len(known)}_of_{word}"))
            name = (sine if isinstance(function, sp.sin) else cosine)(own)
            table[function], self.lets[name] = name, Let(name, function)
        return matrix.xreplace(table)

    def named(self, word: str, matrix: sp.Matrix) -> sp.Matrix:
        """The matrix with a name for each compound entry."""
        names = COORDINATE_NAMES if matrix.cols == 1 else [f"r{i}{j}" for i in "123" for j in "123"]
        found = []
        for name, value in zip(names, matrix, strict=True):
            symbol = real(f"{name}_{word}")
            if is_compound(value):
                self.lets[symbol] = Let(symbol, value)
            found.append(symbol if is_compound(value) else value)
        return sp.Matrix(matrix.rows, matrix.cols, found)
