"""A description's own equations in numbers: rods, modes and bounds, differentiated and evaluated, never solved."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.mechanism import Mechanism, Role
from derive.program import DEGREE

Array = NDArray[np.float64]
STARTS = 600
PASSES = 60


class Equations:
    """The closure of one machine. Joint values are in radians and lengths, axis values in degrees and lengths."""

    def __init__(self, mechanism: Mechanism, given: Mapping[str, float]) -> None:
        self.mechanism = mechanism
        roles = (Role.LENGTH, Role.DISTANCE)
        parameters = {p.name: float(given.get(p.name, p.default or 0.0)) for p in mechanism.parameters}
        self.reach = sum(abs(parameters[p.name]) for p in mechanism.parameters if p.role in roles)
        self.units = np.array([np.pi / 180 if j.is_angle else 1.0 for j in mechanism.joints])
        self.offsets = np.array([float(given.get(j.offset.name, 0.0)) for j in mechanism.joints])
        self._known = {p.symbol: sp.Float(parameters[p.name], 17) for p in mechanism.parameters}
        self._known[DEGREE] = sp.Float(np.pi / 180, 17)
        joints = [j.symbol for j in mechanism.joints]
        task = [sp.Symbol(c, real=True) for c in mechanism.task.position]
        phi = [e / self.reach**2 if e in [r.equation for r in mechanism.rods] else e / self.reach for e in mechanism.equations]
        matrix = sp.Matrix(phi)
        self.residual = self._rows(phi)
        self.by_joints = self._matrix(matrix.jacobian(joints))
        self.by_position = self._matrix(matrix.jacobian(task))
        self.branches = self._rows([b.indicator * b.signs[0] for b in mechanism.branches])
        self.positive = self._rows(list(mechanism.positive))
        self.bounds = self._rows([sp.Abs(b.value) - b.largest for b in mechanism.bounds])
        assert mechanism.assembly is not None
        flag = bool(given.get(mechanism.assembly.parameter, False))
        self._side = self._rows([mechanism.assembly.indicator * sp.sign(mechanism.assembly.handedness)])
        self._sign = mechanism.assembly.signs[flag]

    def joints(self, axes: Array) -> Array:
        """Joint values of axis values."""
        return (axes - self.offsets) * self.units

    def side(self, joints: Array, positions: Array) -> Array:
        """Positive in the assembly mode of this machine."""
        return self._sign * self._side(joints, positions)[:, 0]

    def jacobian(self, joints: Array, positions: Array) -> Array:
        """How the position changes with joint values: A dx + B dq = 0."""
        return -np.linalg.solve(self.by_position(joints, positions), self.by_joints(joints, positions))

    def solutions(self, position: Array, generator: np.random.Generator) -> Array:
        """Joint values that put the plate there: Newton's method from everywhere, and what it finds more than once, once."""
        angles = np.array([j.is_angle for j in self.mechanism.joints])
        size = np.where(angles, np.pi, 2 * self.reach)
        joints = generator.uniform(-1.0, 1.0, (STARTS, len(size))) * size
        positions = np.repeat(position[None], STARTS, axis=0)
        for _ in range(PASSES):
            slopes = self.by_joints(joints, positions) + 1e-14 * np.eye(len(size))
            step = np.linalg.solve(slopes, self.residual(joints, positions)[:, :, None])[:, :, 0]
            joints = joints - np.clip(step, -size / 4, size / 4)
        met = joints[np.abs(self.residual(joints, positions)).max(axis=1) < 1e-13]
        found: list[Array] = []
        for one in met:
            one = np.where(angles, (one + np.pi) % (2 * np.pi) - np.pi, one)
            if all(self.distance(one, other) > 1e-5 for other in found):
                found.append(one)
        return np.array(found).reshape(-1, len(size))

    def distance(self, one: Array, other: Array) -> float:
        """How far apart two sets of joint values are, whole turns aside: radians, and lengths over the reach."""
        away = one - other
        turns = np.abs((away + np.pi) % (2 * np.pi) - np.pi)
        return float(np.where([j.is_angle for j in self.mechanism.joints], turns, np.abs(away) / self.reach).max())

    def is_ours(self, joints: Array, positions: Array) -> NDArray[np.bool_]:
        """Whether solutions of the closure are solutions of this machine: its side, its mirror image, inside its bounds."""
        inside = (self.bounds(joints, positions) <= 0).all(axis=1) & (self.positive(joints, positions) > 0).all(axis=1)
        return inside & (self.side(joints, positions) > 0)

    def _rows(self, expressions: Sequence[object]) -> Callable[[Array, Array], Array]:
        inputs = [*(j.symbol for j in self.mechanism.joints), *(sp.Symbol(c, real=True) for c in "xyz")]
        function = sp.lambdify(inputs, [sp.sympify(e).subs(self._known) for e in expressions], "numpy")

        def evaluate(joints: Array, positions: Array) -> Array:
            values = [np.broadcast_to(v, len(joints)) for v in function(*joints.T, *positions.T)]
            return np.stack(values, axis=1).astype(float) if values else np.empty((len(joints), 0))

        return evaluate

    def _matrix(self, entries: sp.Matrix) -> Callable[[Array, Array], Array]:
        flat = self._rows(list(entries))
        return lambda joints, positions: flat(joints, positions).reshape(-1, *entries.shape)
