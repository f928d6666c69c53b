"""The closure equations of a mechanism in plain NumPy, from its description alone.

Nothing here knows a solution: a chain is multiplied out as 4 x 4 matrices, stated equations are evaluated as
they stand. Derivatives are complex steps, exact to rounding. Arrays have one row a pose.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism, Turning, X, Y, Z
from derive.geometry.frames import Motion
from derive.ir.constants import (
    DEGREE,
)

Array = NDArray[np.float64]
STEP = 1e-30
ONE_DEGREE = np.pi / 180.0
COLUMNS = {Turning.NONE: [], Turning.ABOUT_Z: [0, 1, 2], Turning.DIRECTION: [2], Turning.FULL: [0, 1, 2]}
"""The columns of the commanded rotation that the task prescribes."""
POSITION = (X.symbol, Y.symbol, Z.symbol)


class Closure:
    """The closure of one machine: a mechanism with its parameters."""

    def __init__(self, mechanism: Mechanism, parameters: Mapping[str, float]) -> None:
        self.mechanism = mechanism
        self.constants = [float(parameters[p.name]) for p in mechanism.parameters]
        self.offsets = np.array([parameters[j.offset.name] for j in mechanism.joints], dtype=float)
        self.units = np.array([ONE_DEGREE if j.is_angle else 1.0 for j in mechanism.joints])
        self.angles = np.array([j.is_angle for j in mechanism.joints])
        self.task = ["xyz".index(c) for c in mechanism.task.position]
        self.follows_turn = mechanism.task.turning is Turning.ABOUT_Z
        self.follows_rotation = mechanism.task.turning is not Turning.NONE
        self.columns = COLUMNS[mechanism.task.turning]
        self._equations: list[sp.Expr] = list(mechanism.closure)

    def joints(self, axes: Array) -> Array:
        """Joint values in radians and lengths: motor = axis - offset, joint = motor + coupling."""
        motors = (axes - self.offsets) * self.units
        symbols = [j.motor for j in self.mechanism.joints]
        couplings = [j.coupling for j in self.mechanism.joints]
        return motors + self._evaluate(couplings, symbols, motors)

    def axes(self, joints: Array) -> Array:
        """Axis values of joint values: couplings come from motors of earlier axes, so motor by motor."""
        motors = np.zeros_like(joints)
        symbols = [j.motor for j in self.mechanism.joints]
        for i, joint in enumerate(self.mechanism.joints):
            motors[:, i] = joints[:, i] - self._evaluate([joint.coupling], symbols, motors)[:, 0]
        return motors / self.units + self.offsets

    def poses(self, axes: Array) -> tuple[Array, Array]:
        """Position and rotation at axis values: of the chain, or what satisfies the stated equations."""
        joints = self.joints(axes)
        if self.mechanism.chain is not None:
            return self.frames(joints)
        positions = np.zeros((len(axes), 3))
        for _ in range(3):  # Newton's method: one step where the position is affine
            by_pose = derivative(lambda p: self._stated(joints, p), positions)[:, :, self.task]
            steps = np.linalg.solve(by_pose, self._stated(joints, positions)[:, :, None])
            positions[:, self.task] -= steps[:, :, 0]
        return positions, np.tile(np.eye(3), (len(axes), 1, 1))

    def frames(self, joints: Array) -> tuple[Array, Array]:
        """Position and rotation at the end of a chain."""
        assert self.mechanism.chain is not None
        factors = self.mechanism.chain.factors
        amounts = self.at_joints([f.amount for f in factors], joints)
        product = np.tile(np.eye(4, dtype=amounts.dtype), (len(joints), 1, 1))
        for k, factor in enumerate(factors):
            product = product @ _elementary(factor.motion, factor.axis, amounts[:, k])
        return product[:, :3, 3], product[:, :3, :3]

    def residual(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The residual of the closure at a pose: lengths, then entries of the rotation."""
        if self.mechanism.chain is None:
            lengths = self._stated(joints, positions)
            if 2 not in self.task:
                lengths = np.hstack([lengths, positions[:, 2:]])
            return np.hstack([lengths, (rotations - np.eye(3)).reshape(-1, 9)])
        position, rotation = self.frames(joints)
        return np.hstack([position - positions, (rotation - rotations).reshape(-1, 9)])

    def equations(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The commanded part of the closure, which the inverse has to solve."""
        if self.mechanism.chain is None:
            return self._stated(joints, positions)
        position, rotation = self.frames(joints)
        lengths = (position - positions)[:, self.task]
        return np.hstack(
            [lengths, (rotation - rotations)[:, :, self.columns].reshape(len(lengths), 3 * len(self.columns))]
        )

    def jacobian(self, axes: Array, positions: Array) -> Array:
        """Rows of the task by axes, per radian for an axis in degrees."""
        if self.mechanism.chain is None:
            by_axes = derivative(lambda a: self._stated(self.joints(a), positions), axes)
            joints = self.joints(axes)
            by_pose = derivative(lambda p: self._stated(joints, p), positions)[:, :, self.task]
            return -np.linalg.solve(by_pose, by_axes) / self.units
        by_position = derivative(lambda a: self.frames(self.joints(a))[0], axes)[:, self.task]
        if not self.follows_rotation:
            return by_position / self.units
        spin = derivative(lambda a: self.frames(self.joints(a))[1].reshape(-1, 9), axes)
        rotations = self.frames(self.joints(axes))[1]
        spins = np.einsum("nika,njk->nija", spin.reshape(-1, 3, 3, axes.shape[1]), rotations)  # dR times R transposed
        twist = np.stack([spins[:, 2, 1], spins[:, 0, 2], spins[:, 1, 0]], axis=1)
        if self.columns == [2]:  # turns about the x and y of the flange tilt the tool
            twist = np.einsum("nij,nia->nja", rotations[:, :, :2], twist)
        return np.concatenate([by_position, twist[:, 2:] if self.follows_turn else twist], axis=1) / self.units

    def indicators(self, joints: Array) -> Array:
        """The indicator of every branch, positive where its byte is 1."""
        return self.at_joints([b.signs[0] * b.indicator for b in self.mechanism.branches], joints)

    def positive(self, joints: Array) -> Array:
        """The quantities that are positive in this machine."""
        return self.at_joints(list(self.mechanism.positive), joints)

    def limited(self, joints: Array) -> Array:
        """The quantities with limits of their own, in degrees and lengths."""
        values = self.at_joints([q.value for q in self.mechanism.limited], joints)
        return values / np.array([ONE_DEGREE if q.is_angle else 1.0 for q in self.mechanism.limited])

    def _stated(self, joints: Array, positions: Array) -> Array:
        symbols = [*(j.symbol for j in self.mechanism.joints), *POSITION]
        return self._evaluate(self._equations, symbols, np.hstack([joints, positions]))

    def at_joints(self, expressions: Sequence[sp.Expr], joints: Array) -> Array:
        """Expressions in joint values, one a column."""
        return self._evaluate(expressions, [j.symbol for j in self.mechanism.joints], joints)

    def _evaluate(self, expressions: Sequence[sp.Expr], symbols: Sequence[sp.Symbol], values: Array) -> Array:
        names = (*symbols, *(p.symbol for p in self.mechanism.parameters), DEGREE)
        columns = _compiled(tuple(expressions), names)(*values.T, *self.constants, ONE_DEGREE)
        found = [np.broadcast_to(c, (len(values),)) for c in columns]
        return np.stack(found, axis=1) if found else np.zeros((len(values), 0))


def derivative(function: Callable[[Array], Array], at: Array) -> Array:
    """∂ outputs / ∂ inputs of every row, by complex steps."""
    columns = []
    for i in range(at.shape[1]):
        shifted = at.astype(complex)
        shifted[:, i] += 1j * STEP
        columns.append(np.imag(function(shifted)) / STEP)
    return np.stack(columns, axis=2)


@cache
def _compiled(expressions: tuple[sp.Expr, ...], names: tuple[sp.Symbol, ...]) -> Callable[..., list[Array]]:
    return sp.lambdify(names, list(expressions), modules="numpy")


def _elementary(motion: Motion, axis: int, amount: Array) -> Array:
    """A shift along, a turn about, or (where the amount is 1) half a turn about a coordinate axis."""
    frame = np.tile(np.eye(4, dtype=amount.dtype), (len(amount), 1, 1))
    if motion is Motion.SHIFT:
        frame[:, axis, 3] = amount
        return frame
    angle = np.pi * amount if motion is Motion.FLIP else amount
    first, second = [(1, 2), (2, 0), (0, 1)][axis]
    frame[:, first, first] = frame[:, second, second] = np.cos(angle)
    frame[:, second, first] = np.sin(angle)
    frame[:, first, second] = -np.sin(angle)
    return frame
