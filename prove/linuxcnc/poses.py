"""Poses in LinuxCNC's letters: the frame that they mean, and the way that a program describes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from prove.linuxcnc.machines import LETTERS, Machine, Move, Pose

Reals = NDArray[np.float64]
_POINT = 1e-12
"""The square of a length that is none."""


def frames(machine: Machine, poses: Reals) -> tuple[Reals, Reals]:
    """Positions (N, 3) and rotations (N, 3, 3) of poses (N, 6): X, Y, Z, A, B, C."""
    a, b, c = (np.radians(poses[:, k]) for k in (3, 4, 5))
    positions = poses[:, :3] - [0.0, 0.0, machine.raised]
    if not machine.turns:
        return positions, _about(2, c) @ _about(1, b) @ _about(0, a)
    rotations = np.broadcast_to(np.eye(3), (len(poses), 3, 3))
    degree = np.full_like(a, np.radians(1.0))
    for letter, factor in machine.turns:
        rotations = rotations @ _about(LETTERS.index(letter) % 3, factor * {"A": a, "B": b, "C": c}.get(letter, degree))
    return positions, rotations


def _about(axis: int, angle: Reals) -> Reals:
    """The rotations (N, 3, 3) about X, Y or Z by these angles in radians."""
    rotation = np.zeros((len(angle), 3, 3))
    one, other = (axis + 1) % 3, (axis + 2) % 3
    rotation[:, axis, axis] = 1.0
    rotation[:, one, one] = rotation[:, other, other] = np.cos(angle)
    rotation[:, other, one] = np.sin(angle)
    rotation[:, one, other] = -np.sin(angle)
    return rotation


@dataclass(frozen=True)
class Segment:
    """A line or an arc, in all letters at once."""

    begin: Reals
    """X, Y, Z, A, B, C."""
    end: Reals
    centre: Reals | None = None
    """X and Y of the centre of an arc."""
    sweep: float = 0.0
    """Of an arc, in radians, negative clockwise."""

    def at(self, fractions: Reals) -> Reals:
        """The poses (N, 6) at these fractions (N,) of the way."""
        poses = self.begin + fractions[:, None] * (self.end - self.begin)
        if self.centre is not None:
            out = self.begin[:2] - self.centre
            cosine, sine = np.cos(self.sweep * fractions), np.sin(self.sweep * fractions)
            poses[:, 0] = self.centre[0] + cosine * out[0] - sine * out[1]
            poses[:, 1] = self.centre[1] + sine * out[0] + cosine * out[1]
        return poses

    def nearest(self, positions: Reals) -> Reals:
        """The fractions (N,) of the way at which it is nearest to these positions (N, 3)."""
        if self.centre is not None:
            out, seen = self.begin[:2] - self.centre, positions[:, :2] - self.centre
            turned = np.arctan2(out[0] * seen[:, 1] - out[1] * seen[:, 0], seen @ out)
            middle = 0.5 * self.sweep
            turned = middle + np.mod(turned - middle + np.pi, 2.0 * np.pi) - np.pi
            fraction = turned / self.sweep
        else:
            way = self.end[:3] - self.begin[:3]
            fraction = (positions - self.begin[:3]) @ way / max(float(way @ way), _POINT)
        nearest: Reals = np.clip(fraction, 0.0, 1.0)
        return nearest


def segments(begin: Reals, program: Sequence[Move]) -> list[Segment]:
    """The way that a program describes, from this pose (6,)."""
    way = []
    for move in program:
        end = filled(begin, move.to)
        if move.code == "G2":
            centre = begin[:2] + np.array(move.centre)
            one, other = begin[:2] - centre, end[:2] - centre
            sweep = -np.mod(np.arctan2(one[1] * other[0] - one[0] * other[1], one @ other), 2.0 * np.pi)
            way.append(Segment(begin, end, centre, float(sweep)))
        else:
            way.append(Segment(begin, end))
        begin = end
    return way


def filled(pose: Reals, to: Pose) -> Reals:
    """The pose (6,) with these letters changed."""
    return np.array([to.get(letter, value) for letter, value in zip(LETTERS, pose, strict=True)], dtype=float)
