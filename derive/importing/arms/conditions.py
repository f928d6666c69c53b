"""How much each axis moves what a task commands, beyond what the other axes do: the conditioning of a task."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, Line, moved
from derive.importing.robot import Array

_SAMPLES = 12


@dataclass(frozen=True)
class Motions:
    """Jacobians of the tip at some joint values (samples x 6 x axes, lengths over the size), its rotations there, and
    the directions of the last turns (samples x 3): of the last one, and of the last one that is not parallel to it.
    """

    jacobians: Array
    rotations: Array
    last: Array
    before: Array

    def rank(self, rows: slice = slice(0, 6), axes: Sequence[int] | None = None, least: float = 1e-7) -> int:
        """The rank of some rows at a general position; singular values below the least one count as zero."""
        chosen = self.jacobians[:, rows] if axes is None else self.jacobians[:, rows][:, :, list(axes)]
        return int(max(np.linalg.matrix_rank(j, tol=least) for j in chosen))

    def least(self, axes: Sequence[int]) -> float:
        """The least singular value with some axes, the mean of all samples."""
        return float(np.mean([np.linalg.svd(j[:, list(axes)], compute_uv=False)[-1] for j in self.jacobians]))

    def span(self, rows: slice) -> Array:
        """Directions (rows) that the motions of all samples span."""
        every = np.concatenate(list(self.jacobians[:, rows]), axis=1)
        left, sizes, _ = np.linalg.svd(every)
        return np.asarray(left[:, : int(np.sum(sizes > 1e-7))].T)

    def of(self, axes: Sequence[int]) -> Motions:
        """The motions of some axes alone."""
        return Motions(self.jacobians[:, :, list(axes)], self.rotations, self.last, self.before)

    def own_shares(self, position: str, turning: str, facing: int) -> Array:
        """For each axis the median of what it alone moves of the commanded quantities, in sizes and radians."""
        shares = []
        for k, jacobian in enumerate(self.jacobians):
            seen = {
                "NONE": np.zeros((0, 3)),
                "ABOUT_Z": np.eye(3)[2:],
                "DIRECTION": np.delete(self.rotations[k].T, facing, 0),
                "PITCH": self.last[k : k + 1],
                "PITCH_ROLL": np.array([self.before[k], self.last[k]]),
                "FULL": np.eye(3),
            }[turning]
            rows = jacobian[["xyz".index(c) for c in position]]
            shares.append(_distances(np.concatenate([rows, seen @ jacobian[3:]])))
        return np.asarray(np.median(shares, axis=0))


def _distances(columns: Array) -> Array:
    """The distance of each column from the span of the others; zero if the columns are dependent."""
    if np.linalg.matrix_rank(columns, tol=1e-9) < columns.shape[1]:
        return np.zeros(columns.shape[1])
    return np.asarray(1.0 / np.linalg.norm(np.linalg.pinv(columns), axis=1))


def motions(arm: Arm, count: int) -> Motions:
    """Jacobians at general joint values, which are always the same."""
    rng = np.random.default_rng(5)
    found: list[tuple[Array, Array, Array, Array]] = []
    for _ in range(_SAMPLES):
        values = rng.uniform(0.3, 1.2, count) * rng.choice([-1.0, 1.0], count)
        in_units = np.array([v * _unit(arm, k) for k, v in enumerate(values)])
        found.append(_jacobian(arm, in_units))
    jacobians, rotations, last, before = (np.array(some) for some in zip(*found, strict=True))
    return Motions(jacobians, rotations, last, before)


def _unit(arm: Arm, axis: int) -> float:
    """The size of a slide's values; 1 for an angle."""
    kinds = [line.kind for line in arm.lines for k, _ in line.drives if k == axis]
    return arm.size if Kind.LINEAR in kinds else 1.0


def _jacobian(arm: Arm, values: Array) -> tuple[Array, Array, Array, Array]:
    frame = np.eye(4)
    columns: list[tuple[Line, Array, Array]] = []
    for line in arm.lines:
        columns.append((line, frame[:3, :3] @ line.direction, (frame @ np.append(line.point, 1.0))[:3]))
        frame = frame @ moved(line, float(sum(values[k] * m for k, m in line.drives)))
    tip = (frame @ arm.tip)[:3, 3]
    size = arm.size
    jacobian = np.zeros((6, len(values)))
    for line, direction, point in columns:
        for axis, multiplier in line.drives:
            if line.kind is Kind.LINEAR:
                jacobian[:3, axis] += multiplier * direction * _unit(arm, axis) / size
            else:
                unit = multiplier * _unit(arm, axis)
                jacobian[:3, axis] += unit * np.cross(direction, tip - point) / size
                jacobian[3:, axis] += unit * direction
    turns = [direction for line, direction, _ in columns if line.kind is Kind.ROTARY] or [np.zeros(3)]
    others = [t for t in turns if np.linalg.norm(np.cross(t, turns[-1])) > 1e-6] or [np.zeros(3)]
    return jacobian, (frame @ arm.tip)[:3, :3], turns[-1], others[-1]
