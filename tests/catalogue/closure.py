"""The closure equations of a mechanism in plain NumPy, from its description alone.

Nothing here knows a solution: a chain is multiplied out as 4 x 4 matrices, stated equations are evaluated as
they stand. Derivatives are complex steps, exact to rounding. Arrays have one row a pose.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache, cached_property

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import ROTATION, Mechanism, Turning, X, Y, Z
from derive.geometry.frames import Motion
from derive.ir.constants import DEGREE
from tests.orthonormal import swings, turned

Array = NDArray[np.float64]
STEP = 1e-30
ONE_DEGREE = np.pi / 180.0
COLUMNS = {
    Turning.NONE: [],
    Turning.ABOUT_Z: [0, 1, 2],
    Turning.DIRECTION: [2],
    Turning.FULL: [0, 1, 2],
    Turning.PITCH: [2],
    Turning.PITCH_ROLL: [0, 1, 2],
}
"""The columns of the commanded rotation that the task prescribes."""
POSITION = (X.symbol, Y.symbol, Z.symbol)


class Closure:
    """The closure of one machine: a mechanism with its parameters."""

    def __init__(self, mechanism: Mechanism, parameters: Mapping[str, float]) -> None:
        self.mechanism = mechanism
        self.constants = [float(parameters[p.name]) for p in mechanism.parameters]
        self.offsets = np.array([parameters[j.offset.name] for j in mechanism.joints], dtype=float)
        self.units = np.array([ONE_DEGREE if j.in_degrees else 1.0 for j in mechanism.joints])
        self.angles = np.array([j.axis_is_angle for j in mechanism.joints])
        self.turning = np.array([j.is_angle for j in mechanism.joints])
        """Which joints are angles: a cylinder, whose axis is a length, may move one."""
        self.task = ["xyz".index(c) for c in mechanism.task.position]
        self.follows_turn = mechanism.task.turning is Turning.ABOUT_Z
        self.follows_rotation = mechanism.task.turning is not Turning.NONE
        self.columns = COLUMNS[mechanism.task.turning]
        self._formulas = formulas_of(mechanism)

    def joints(self, axes: Array) -> Array:
        """Joint values in radians and lengths: motor = axis - offset, joint = motor + coupling."""
        motors = (axes - self.offsets) * self.units
        coupled = self._formulas.couplings
        joints = motors * self._ratios() if self._formulas.are_geared else motors
        return joints + self._evaluate(coupled, motors) if coupled is not None else joints

    def _ratios(self) -> Array:
        """The turns of every joint per turn of its motor."""
        return self._evaluate(self._formulas.ratios, np.zeros((1, len(self.mechanism.joints))))

    def axes(self, joints: Array) -> Array:
        """Axis values of joint values: couplings come from motors of earlier axes, so motor by motor."""
        motors = np.array(joints)
        for i, coupling in self._formulas.coupled.items():
            motors[:, i] = joints[:, i] - self._evaluate(coupling, motors)[:, 0]
        if self._formulas.are_geared:
            motors = motors / self._ratios()
        return motors / self.units + self.offsets

    def poses(self, axes: Array) -> tuple[Array, Array]:
        """Position and rotation at axis values: of the chain, or what satisfies the stated equations."""
        joints = self.joints(axes)
        if self.mechanism.chain is not None:
            return self.frames(joints)
        positions = np.zeros((len(axes), 3))
        for _ in range(3):  # Newton's method: one step where the position is affine
            by_pose = derivative(lambda p, q: self._stated(q, p), positions, joints)[:, :, self.task]
            steps = np.linalg.solve(by_pose, self._stated(joints, positions)[:, :, None])
            positions[:, self.task] -= steps[:, :, 0]
        return positions, self.turns(joints)

    def turns(self, joints: Array) -> Array:
        """The rotation of a loop's flange: about z by the heading that the joints tell, where they do."""
        if self.mechanism.heading is None:
            return np.tile(np.eye(3, dtype=joints.dtype), (len(joints), 1, 1))
        return turned(2, self.at_joints([self.mechanism.heading], joints)[:, 0])

    def frames(self, joints: Array) -> tuple[Array, Array]:
        """Position and rotation at the end of a chain."""
        assert self.mechanism.chain is not None
        amounts = self._evaluate(self._formulas.amounts, joints)
        rotation = np.zeros((3, 3, len(joints)), dtype=amounts.dtype)  # its columns: one is a place of all rows
        rotation[0, 0] = rotation[1, 1] = rotation[2, 2] = 1.0
        position = np.zeros((3, len(joints)), dtype=amounts.dtype)
        for factor, amount in zip(self.mechanism.chain.factors, amounts.T, strict=True):
            if factor.motion is Motion.SHIFT:
                position += rotation[factor.axis] * amount
            else:
                _turn(rotation, factor.axis, np.pi * amount if factor.motion is Motion.FLIP else amount)
        return np.ascontiguousarray(position.T), np.ascontiguousarray(rotation.transpose(2, 1, 0))

    def residual(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The residual of the closure at a pose: lengths, then entries of the rotation."""
        if self.mechanism.chain is None:
            lengths = self._stated(joints, positions)
            if 2 not in self.task:
                lengths = np.hstack([lengths, positions[:, 2:]])
            return np.hstack([lengths, (rotations - self.turns(joints)).reshape(-1, 9)])
        position, rotation = self.frames(joints)
        return np.hstack([position - positions, (rotation - rotations).reshape(-1, 9)])

    def equations(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The commanded part of the closure, which the inverse has to solve."""
        if self.mechanism.chain is None:
            turned = (rotations - self.turns(joints))[:, :, self.columns]
            return np.hstack([self._stated(joints, positions), turned.reshape(len(turned), 3 * len(self.columns))])
        position, rotation = self.frames(joints)
        if self.mechanism.followed_turns:
            rotations = self.nearest(joints, rotations)
        lengths = (position - positions)[:, self.task]
        apart = (rotation - rotations)[:, :, self.columns]
        return np.hstack([lengths, apart.reshape(len(lengths), 3 * len(self.columns))])

    def nearest(self, joints: Array, rotations: Array) -> Array:
        """The rotations swung, by the smallest turn, until the tool is in the plane in which the pitch moves it."""
        _, rotation = self.frames(joints)
        across = self._about(joints)[0]
        tool = np.array([0.0, 0.0, 1.0])
        if self.mechanism.followed_turns > 1:
            tool = np.einsum("nij,ni->nj", rotation, self._about(joints)[1])[0]
        commanded = rotations @ tool
        seen = commanded - across * np.sum(across * commanded, axis=1)[:, None]
        seen /= np.linalg.norm(seen, axis=1)[:, None]
        return np.asarray(swings(commanded, seen) @ rotations)

    def _about(self, joints: Array) -> list[Array]:
        """The directions of the axes of the pitch and the roll: those about which the last turning joints turn."""
        assert self.mechanism.chain is not None
        factors, symbols = self.mechanism.chain.factors, {j.symbol for j in self.mechanism.solved_joints}
        places = [
            k
            for k, f in enumerate(factors)
            if f.motion is Motion.TURN and f.amount.free_symbols & symbols and sp.expand(f.amount) != 0
        ]
        chosen: list[int] = []
        for k in reversed(places):  # of neighbours about one axis the last one
            if not chosen or factors[chosen[0]].axis != factors[k].axis:
                chosen.insert(0, k)
        amounts = self._evaluate(self._formulas.amounts, joints)
        found = []
        for place in chosen[-self.mechanism.followed_turns :]:
            frame = np.zeros((3, 3, len(joints)), dtype=amounts.dtype)
            frame[0, 0] = frame[1, 1] = frame[2, 2] = 1.0
            for factor, amount in zip(factors[:place], amounts.T[:place], strict=True):
                if factor.motion is not Motion.SHIFT:
                    _turn(frame, factor.axis, np.pi * amount if factor.motion is Motion.FLIP else amount)
            found.append(frame[factors[place].axis].T)
        return found

    def jacobian(self, axes: Array, positions: Array) -> Array:
        """Rows of the task by axes, per radian for an axis in degrees."""
        if self.mechanism.chain is None:
            by_axes = derivative(lambda a, p: self._stated(self.joints(a), p), axes, positions)
            joints = self.joints(axes)
            by_pose = derivative(lambda p, q: self._stated(q, p), positions, joints)[:, :, self.task]
            by_position = -np.linalg.solve(by_pose, by_axes)
            if self.mechanism.heading is None:
                return by_position / self.units
            heading = [self.mechanism.heading]
            by_heading = derivative(lambda a: self.at_joints(heading, self.joints(a)), axes)
            return np.concatenate([by_position, by_heading], axis=1) / self.units
        by_position = derivative(lambda a: self.frames(self.joints(a))[0], axes)[:, self.task]
        if not self.follows_rotation:
            return by_position / self.units
        spin = derivative(lambda a: self.frames(self.joints(a))[1].reshape(-1, 9), axes)
        rotations = self.frames(self.joints(axes))[1]
        spins = np.einsum("nika,njk->nija", spin.reshape(-1, 3, 3, axes.shape[1]), rotations)  # dR times R transposed
        twist = np.stack([spins[:, 2, 1], spins[:, 0, 2], spins[:, 1, 0]], axis=1)
        if self.mechanism.followed_turns:
            twist = np.stack([np.einsum("ni,nia->na", v, twist) for v in self._about(self.joints(axes))], axis=1)
        elif self.columns == [2]:  # turns about the x and y of the flange tilt the tool
            twist = np.einsum("nij,nia->nja", rotations[:, :, :2], twist)
        return np.concatenate([by_position, twist[:, 2:] if self.follows_turn else twist], axis=1) / self.units

    def indicators(self, joints: Array) -> Array:
        """The indicator of every branch, positive where its byte is 1."""
        return self._evaluate(self._formulas.indicators, joints)

    def positive(self, joints: Array) -> Array:
        return self._evaluate(self._formulas.positive, joints)

    def limited(self, joints: Array) -> Array:
        """The quantities with limits of their own, in degrees and lengths."""
        values = self.at_joints([q.value for q in self.mechanism.limited], joints)
        return values / np.array([ONE_DEGREE if q.is_angle else 1.0 for q in self.mechanism.limited])

    def _stated(self, joints: Array, positions: Array) -> Array:
        return self._evaluate(self._formulas.equations, np.hstack([joints, positions]))

    def at_joints(self, expressions: Sequence[sp.Expr], joints: Array) -> Array:
        """Expressions in joint values, one a column."""
        return self._evaluate(self._formulas.at_joints(tuple(expressions)), joints)

    def _evaluate(self, formula: Formula, values: Array) -> Array:
        columns = formula(*values.T, *self.constants, ONE_DEGREE)
        found = np.empty((len(columns), len(values)), dtype=values.dtype)  # its rows: one is a place of all poses
        for place, column in enumerate(columns):
            found[place] = column
        return found.T


Formula = Callable[..., Sequence[Array]]
"""Of values, parameters and one degree in radians."""


class Formulas:
    """The expressions of a description, each made a function of NumPy where it is first asked for."""

    def __init__(self, mechanism: Mechanism) -> None:
        self._mechanism = mechanism
        self._joints = tuple(j.symbol for j in mechanism.joints)
        self._pose = (*self._joints, *POSITION)
        angle = mechanism.heading
        self._turned = {} if angle is None else dict(zip(ROTATION, sp.rot_axis3(-angle), strict=True))
        """Where joints tell the rotation of a loop's flange: its entries, which rods may read."""
        self._constants = (*(p.symbol for p in mechanism.parameters), DEGREE)
        self._made: dict[tuple[tuple[sp.Symbol, ...], tuple[sp.Expr, ...]], Formula] = {}

    def at_joints(self, expressions: tuple[sp.Expr, ...]) -> Formula:
        return self._of(expressions, self._joints)

    def at_pose(self, expressions: tuple[sp.Expr, ...]) -> Formula:
        """Expressions in joint values and the position."""
        return self._of(expressions, self._pose)

    @cached_property
    def amounts(self) -> Formula:
        """What every factor of the chain moves by."""
        assert self._mechanism.chain is not None
        return self.at_joints(tuple(f.amount for f in self._mechanism.chain.factors))

    @cached_property
    def indicators(self) -> Formula:
        """Every branch's, positive where its byte is 1."""
        return self.at_joints(tuple(b.signs[0] * b.indicator for b in self._mechanism.branches))

    @cached_property
    def positive(self) -> Formula:
        return self.at_joints(tuple(self._mechanism.positive))

    @cached_property
    def equations(self) -> Formula:
        """The closure as it is stated, in joint values and the position."""
        return self.at_pose(tuple(self._mechanism.closure))

    @cached_property
    def coupled(self) -> dict[int, Formula]:
        """What every joint that is coupled gets from the motors of others."""
        motors = tuple(j.motor for j in self._mechanism.joints)
        return {i: self._of((j.coupling,), motors) for i, j in enumerate(self._mechanism.joints) if j.coupling != 0}

    @cached_property
    def couplings(self) -> Formula | None:
        """The same of all joints, where any is coupled."""
        motors = tuple(j.motor for j in self._mechanism.joints)
        return self._of(tuple(j.coupling for j in self._mechanism.joints), motors) if self.coupled else None

    @cached_property
    def are_geared(self) -> bool:
        """Whether any joint has a gear of its own."""
        return any(j.ratio != 1 for j in self._mechanism.joints)

    @cached_property
    def ratios(self) -> Formula:
        """The gears of the joints."""
        return self.at_joints(tuple(j.ratio for j in self._mechanism.joints))

    def _of(self, expressions: tuple[sp.Expr, ...], names: tuple[sp.Symbol, ...]) -> Formula:
        if (names, expressions) not in self._made:
            told = [sp.sympify(e).xreplace(self._turned) for e in expressions]
            formula = sp.lambdify((*names, *self._constants), told, modules="numpy", cse=True)
            self._made[names, expressions] = formula
        return self._made[names, expressions]


@cache
def formulas_of(mechanism: Mechanism) -> Formulas:
    return Formulas(mechanism)


def derivative(function: Callable[..., Array], at: Array, *fixed: Array) -> Array:
    """∂ outputs / ∂ inputs of every row, by complex steps in one call; further: values by row."""
    count, width = at.shape
    shifted = np.tile(at.astype(complex), (width, 1, 1))
    for i in range(width):
        shifted[i, :, i] += 1j * STEP
    repeated = [np.tile(values, (width, *(1 for _ in values.shape[1:]))) for values in fixed]
    found = np.imag(function(shifted.reshape(width * count, width), *repeated)) / STEP
    return np.ascontiguousarray(np.moveaxis(found.reshape(width, count, found.shape[1]), 0, 2))


def _turn(rotation: Array, axis: int, angle: Array) -> None:
    """Turn a frame, given by its columns, about one of its axes."""
    first, second = [(1, 2), (2, 0), (0, 1)][axis]
    cosine, sine = np.cos(angle), np.sin(angle)
    along, across = rotation[first].copy(), rotation[second].copy()
    rotation[first] = along * cosine + across * sine
    rotation[second] = across * cosine - along * sine
