"""The closure of loops that turn their platform, with the pose as unknown.

Nothing here knows a derived formula: Newton's method on the stated equations, with derivatives by complex steps, finds
the pose from the home pose and the joints from many starts.
"""

from collections.abc import Mapping, Sequence
from functools import cache, cached_property

import numpy as np
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import ROTATION, Mechanism, Turning
from derive.ir.constants import DEGREE
from tests.catalogue.closure import POSITION, Array, Closure, Formula, derivative
from tests.mechanisms import has_free_twist
from tests.orthonormal import turned

SHIFT, TURN = 0.2, 0.35
"""The largest distance of poses from home, in reaches and radians."""
PASSES = 40
CLOSED = 1e-11
"""Of the reach: what is left of a rod's length where the loop closes."""
STARTS = 60
AGAIN = 12
"""How often joints start elsewhere where a positive quantity is not."""
STILL = 1e-15
QUARTERS = (0.0, np.pi / 2.0, np.pi)


class TurningClosure(Closure):
    """The closure of a loop that turns its platform, in position and rotation."""

    def __init__(self, mechanism: Mechanism, parameters: Mapping[str, float]) -> None:
        super().__init__(mechanism, parameters)
        self._fixed = [g.equation for g in mechanism.fixed_guides]
        self._equations = [*mechanism.closure, *self._fixed, *(r.equation / r.length for r in mechanism.rods)]
        self._indicators = [b.signs[0] * b.indicator for b in mechanism.branches]
        self.axes_of_turn = [2] if mechanism.task.turning is Turning.ABOUT_Z else [0, 1, 2]
        width = len(mechanism.home) - len(self.axes_of_turn)
        self.task = ["xyz".index(c) for c in mechanism.motion.position[:width]]
        home = self._values(mechanism.home, [], np.zeros((1, 0)))[0]
        self.home_position = np.zeros(3)
        self.home_position[self.task] = home[:width]
        self.home_rotation = np.eye(3)
        for axis, angle in zip(self.axes_of_turn, home[width:], strict=True):
            self.home_rotation = turned(axis, np.array([angle]))[0] @ self.home_rotation
        told = [f"home_{b.name}_{b.names[1]}" for b in mechanism.branches]
        self._at_home = np.array([-1.0 if parameters.get(flag) else 1.0 for flag in told])
        points = [*self._ends()[0], *self._ends()[1]]
        arms = np.array(points[len(points) // 2 :])
        self.reach = float(np.sqrt(((arms - arms.mean(axis=0)) ** 2).sum(axis=1).mean()))
        self.reach = max(self.reach + float(np.mean(self._sizes())), 1e-9)
        self.is_free = has_free_twist(mechanism)
        self._equations += [self.reach * self._twist()] if self.is_free else []
        self.at_home = self._home_determinant()
        self._mode, self.at_home = np.sign(self.at_home), abs(self.at_home)

    def poses(self, axes: Array) -> tuple[Array, Array]:
        """The pose to which Newton's method leads from home; not a number where that is none of this machine."""
        joints = self.joints(axes)
        home = np.tile(self.home_position, (len(axes), 1)), np.tile(self.home_rotation, (len(axes), 1, 1))
        positions, rotations, good = self.ends(joints, *home)
        good &= self.side(joints, positions, rotations) > 0
        good &= (self.positive_at(joints, positions, rotations) > 0).all(axis=1)
        positions[~good], rotations[~good] = np.nan, np.nan
        return positions, rotations

    def ends(self, joints: Array, positions: Array, rotations: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Where Newton's method leads from poses, and whether the loop closes there."""
        positions, rotations = positions.copy(), rotations.copy()
        moving = np.arange(len(joints))
        for _ in range(PASSES):
            state = joints[moving], positions[moving], rotations[moving]
            step = (np.linalg.pinv(self.by_pose(*state)) @ self._stated(*state)[:, :, None])[:, :, 0]
            self._move(state[1], state[2], -_limited(step, len(self.task), self.reach))
            positions[moving], rotations[moving] = state[1:]
            moving = moving[np.abs(step).max(axis=1) > STILL * self.reach]
            if not len(moving):
                break
        left = np.abs(self._stated(joints, positions, rotations)).max(axis=1)
        return positions, rotations, left < CLOSED * self.reach

    def joints_at(self, positions: Array, rotations: Array, rng: Generator) -> tuple[Array, NDArray[np.bool_]]:
        """Joint values at poses, on any branch, and whether they close the loop."""
        joints = self._newton(self._anywhere(len(positions), rng), positions, rotations)
        for _ in range(AGAIN if self.mechanism.positive else 0):
            negative = self.positive_at(joints, positions, rotations) <= 0
            again = negative.astype(float) @ self._touched > 0
            if not again.any():
                break
            joints = np.where(again, self._anywhere(len(positions), rng), joints)
            joints = self._newton(joints, positions, rotations)
        closed = np.abs(self._stated(joints, positions, rotations)).max(axis=1) < CLOSED * self.reach
        closed &= (self.positive_at(joints, positions, rotations) > 0).all(axis=1)
        return np.where(self.angles, (joints + np.pi) % (2 * np.pi) - np.pi, joints), closed

    def _anywhere(self, count: int, rng: Generator) -> Array:
        size = np.where(self.angles, np.pi, 3.0 * self.reach)
        return rng.uniform(-1.0, 1.0, (count, len(size))) * size

    def _newton(self, joints: Array, positions: Array, rotations: Array) -> Array:
        joints, longest = joints.copy(), np.where(self.angles, 1.0, self.reach)
        moving = np.arange(len(joints))
        for _ in range(PASSES):
            there = positions[moving], rotations[moving]
            slopes = derivative(self._stated, joints[moving], *there)
            step = np.linalg.pinv(slopes) @ self._stated(joints[moving], *there)[:, :, None]
            step = np.clip(step[:, :, 0], -longest, longest)
            joints[moving] -= step
            moving = moving[(np.abs(step) > STILL * longest).any(axis=1)]
            if not len(moving):
                break
        return joints

    @cached_property
    def _touched(self) -> Array:
        """Which joints (columns) the positive quantities (rows) depend on."""
        own = [j.symbol for j in self.mechanism.joints]
        return np.array([[float(s in v.free_symbols) for s in own] for v in self.mechanism.positive])

    def around_home(self, count: int, rng: Generator, size: float = 1.0) -> tuple[Array, Array]:
        twist = rng.uniform(-1.0, 1.0, (count, len(self.task) + len(self.axes_of_turn))) * size
        twist *= [SHIFT * self.reach] * len(self.task) + [TURN] * len(self.axes_of_turn)
        positions, rotations = np.tile(self.home_position, (count, 1)), np.tile(self.home_rotation, (count, 1, 1))
        self._move(positions, rotations, twist)
        return positions, self.reachable(rotations)

    def by_pose(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """A = ∂Φ/∂pose: equations by the rows of the twist."""

        def moved(twist: Array, joints: Array, positions: Array, rotations: Array) -> Array:
            there = positions.astype(complex)
            turned = rotations.astype(complex)
            self._move(there, turned, twist)
            return self._stated(joints, there, turned)

        width = len(self.task) + len(self.axes_of_turn)
        return derivative(moved, np.zeros((len(joints), width)), joints, positions, rotations)

    def side(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """det A, positive in the assembly mode of this machine, with moments per reach."""
        scale = self.reach ** len(self.axes_of_turn)
        return self._mode * np.linalg.det(self.by_pose(joints, positions, rotations)) / scale

    def residual(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The residual of the closure at a pose: lengths, then what the rotation is away from one that it can have."""
        lengths = np.hstack([self._stated(joints, positions, rotations), np.delete(positions, self.task, axis=1)])
        return np.hstack([lengths, (rotations - self.reachable(rotations)).reshape(-1, 9)])

    def equations(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The commanded part of the closure, at the nearest rotation that the platform can have."""
        return self._stated(joints, positions, self.reachable(rotations))

    def reachable(self, rotations: Array) -> Array:
        """The nearest rotation that the platform can have."""
        if len(self.axes_of_turn) == 3:
            left, _, right = np.linalg.svd(rotations)
            return self._twisted(np.asarray(left @ right))
        along, across = rotations[:, 0, 0] + rotations[:, 1, 1], rotations[:, 1, 0] - rotations[:, 0, 1]
        return turned(2, np.arctan2(across, along))

    def _twist(self) -> sp.Expr:
        """Zero where a platform whose twist is free has that of the least turn from home."""
        x, y = (sp.Matrix(self.home_rotation[:, k]) for k in (0, 1))
        return y.dot(ROTATION.col(0)) - x.dot(ROTATION.col(1))

    def _twisted(self, rotations: Array) -> Array:
        """The rotations turned about the tool until the plane holds, its slope with the sign at home; where the twist
        is free, to the least turn from home.
        """
        if self.is_free:
            seen = self.home_rotation.T @ rotations
            return rotations @ turned(2, np.arctan2(seen[:, 0, 1] - seen[:, 1, 0], seen[:, 0, 0] + seen[:, 1, 1]))
        if not self._fixed:
            return rotations
        assert not self.task and len(self._fixed) == 1
        ahead, across, back = (self._off(rotations @ turned(2, np.full(len(rotations), u))) for u in QUARTERS)
        middle = (ahead + back) / 2.0
        a, b = ahead - middle, across - middle
        slope = self._off(self.home_rotation @ turned(2, np.array([np.pi / 2.0])))
        swing = np.arccos(np.clip(-middle / np.hypot(a, b), -1.0, 1.0)) * -np.sign(slope)
        return np.asarray(rotations @ turned(2, np.arctan2(b, a) + swing))

    def _off(self, rotations: Array) -> Array:
        """How far the fixed plane is missed."""
        nothing = np.zeros((len(rotations), len(self.mechanism.joints)))
        return self.at(self._fixed, nothing, np.tile(self.home_position, (len(rotations), 1)), rotations)[:, 0]

    def jacobian(self, axes: Array, positions: Array) -> Array:
        """Rows of the task by axes, per radian for an axis in degrees, at the poses of these axes."""
        rotations = self.poses(axes)[1]
        by_axes = derivative(lambda a, p, r: self._stated(self.joints(a), p, r), axes, positions, rotations)
        twist = -np.linalg.solve(self.by_pose(self.joints(axes), positions, rotations), by_axes) / self.units
        if self.columns != [2]:
            return twist
        width = len(self.task)  # turns about the x and y of the flange tilt the tool
        tilt = np.einsum("nij,nia->nja", rotations[:, :, :2], twist[:, width:])
        return np.concatenate([twist[:, :width], tilt], axis=1)

    def indicators(self, joints: Array) -> Array:
        """The indicator of every branch at a pose, positive where its byte is 1."""
        return self.at(self._indicators, joints, *self.poses(self.axes(joints)))

    def indicators_at(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """The same at any joint values and pose."""
        return self.at(self._indicators, joints, positions, rotations)

    def positive(self, joints: Array) -> Array:
        """The quantities of joints alone that are positive in this machine."""
        own = {j.symbol for j in self.mechanism.joints}
        return self.at_joints([v for v in self.mechanism.positive if v.free_symbols <= own], joints)

    def positive_at(self, joints: Array, positions: Array, rotations: Array) -> Array:
        """All quantities that are positive in this machine."""
        return self.at(list(self.mechanism.positive), joints, positions, rotations)

    def room(self, joints: Array, positions: Array) -> Array:
        """There are no bounds."""
        return np.ones(len(joints))

    def at(self, expressions: Sequence[sp.Expr], joints: Array, positions: Array, rotations: Array) -> Array:
        """Expressions of the description in joints and pose: a column each."""
        symbols = [*(j.symbol for j in self.mechanism.joints), *POSITION, *ROTATION]
        return self._values(expressions, symbols, np.hstack([joints, positions, rotations.reshape(-1, 9)]))

    def _values(self, expressions: Sequence[sp.Expr], symbols: Sequence[sp.Symbol], values: Array) -> Array:
        names = (*symbols, *(p.symbol for p in self.mechanism.parameters), DEGREE)
        return self._evaluate(_compiled(tuple(expressions), names), values)

    def _stated(self, joints: Array, positions: Array, rotations: Array) -> Array:  # type: ignore[override]
        return self.at(self._equations, joints, positions, rotations)

    def _move(self, positions: Array, rotations: Array, twist: Array) -> None:
        positions[:, self.task] += twist[:, : len(self.task)]
        for k, axis in enumerate(self.axes_of_turn):
            rotations[:] = turned(axis, twist[:, len(self.task) + k]) @ rotations

    def _ends(self) -> tuple[Array, Array]:
        ends = [[*r.plate, *[sp.Integer(0)] * (3 - len(r.plate))] for r in self.mechanism.rods]
        where = np.zeros((1, len(self.mechanism.joints))), self.home_position[None], self.home_rotation[None]
        found = self.at([e for end in ends for e in end], *where)[0].reshape(-1, 3)
        return found, found

    def _sizes(self) -> Array:
        """The lengths of the rods at home, where they are no joints; else the distances of their ends."""
        joints = {j.symbol for j in self.mechanism.joints}
        sizes = []
        where = np.zeros((1, len(joints))), self.home_position[None], self.home_rotation[None]
        for r in self.mechanism.rods:
            apart = sp.sqrt(sp.Add(*[(p - b) ** 2 for p, b in zip(r.plate, r.base, strict=True)]))
            value = apart if r.length.free_symbols & joints else r.length
            sizes.append(float(self.at([value], *where)[0, 0]))
        return np.array(sizes)

    def _home_determinant(self) -> float:
        self._mode = 1.0
        where = np.tile(self.home_position, (STARTS * 8, 1)), np.tile(self.home_rotation, (STARTS * 8, 1, 1))
        joints, closed = self.joints_at(*where, np.random.default_rng(3))
        closed &= (self.at(self._indicators, joints, *where) * self._at_home > 0).all(axis=1)
        found = self.side(joints, *where)[closed]
        assert len(found) and np.ptp(found) < 1e-6 * np.abs(found).max(), self.mechanism.name
        return float(found[0])


def _limited(step: Array, width: int, reach: float) -> Array:
    """A step of at most half the reach and half a radian."""
    sizes = np.abs(step) / np.where(np.arange(step.shape[1]) < width, 0.5 * reach, 0.5)
    return np.asarray(step / np.maximum(1.0, sizes.max(axis=1))[:, None])


@cache
def _compiled(expressions: tuple[sp.Expr, ...], names: tuple[sp.Symbol, ...]) -> Formula:
    """Expressions as a function of NumPy arrays."""
    formula: Formula = sp.lambdify(names, list(expressions), modules="numpy", cse=True)
    return formula
