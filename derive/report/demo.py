"""A demonstration: a line that the nominal machine can follow from one end to the other, in two configurations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from derive.ir.interpret import Array
from derive.ir.program import Status
from derive.kinematics.kinematics import Bytes, Kinematics, Reals
from derive.kinematics.sampling import sample_axes, size_of
from derive.report.reference_calls import Machine, are_inside, branches_at, fitted, forward, margins

_SAMPLES, _SEED, _TRIED = 400, 4, 40
"""The poses that are sampled, and how many of the most regular ones are tried as a beginning."""
_SHARES = (0.4, 0.2, 0.1)
"""The lengths of a line as shares of the size of the machine, the first that is possible is taken."""
_POINTS = 21
_ANGLE = 30.0
"""The angles of the orientation are multiples of this, in degrees."""
_STEP = 10.0
"""No axis may turn by more degrees, or shift by more percent of the size of the machine, between two points."""


@dataclass(frozen=True)
class Demo:
    """Two ends of a line with one orientation, in the first name of every branch."""

    start: Reals
    end: Reals
    angles: Reals
    """Their orientation as turns about Z, the new Y and the new Z, in degrees."""
    other: Bytes | None
    """The branch bytes in which a chain can follow it, too; a loop would have to be taken apart for others."""
    unit: float
    """A power of ten, of which 30 to 300 are the size of the machine: the ends are whole multiples of it."""


def demo_of(machine: Machine) -> Demo | None:
    """The demonstration of a machine; None if no line was found."""
    size = size_of(machine.kinematics.mechanism, machine.values)
    grid = 10.0 ** (np.floor(np.log10(size / 3.0)) - 1)
    for axes in _regular(machine):
        status, frame, _ = forward(machine, axes)
        if status is Status.OK:
            start = np.round(np.array(frame[:3]) / grid) * grid
            angles = _turns(np.array(frame[3:]).reshape(3, 3)) if machine.kinematics.reads_rotation else np.zeros(3)
            angles = np.round(angles / _ANGLE) * _ANGLE
            for end in _ends(machine.kinematics, start, size, grid):
                path = _Path(machine, np.linspace(start, end, _POINTS), rotation_of(angles), size)
                count = len(machine.kinematics.branches)
                if path.is_followed((1,) * count):
                    return Demo(_numbers(start), _numbers(end), _numbers(angles), path.other(count), float(grid))
    return None


def _numbers(values: Array) -> Reals:
    return tuple(float(value) for value in np.round(values, 9) + 0.0)  # without a negative zero


def _regular(machine: Machine) -> Iterator[Reals]:
    """Sampled axis values, the most regular pose first."""
    mechanism = machine.kinematics.mechanism
    drawn = sample_axes(mechanism, dict(machine.values), _SAMPLES, _SEED)
    rows = fitted(machine, [tuple(row) for row in np.stack([drawn[j.axis.name] for j in mechanism.joints], 1).tolist()])
    least = np.nan_to_num(np.min(np.abs(margins(machine, rows)), axis=0), nan=-1.0)
    return (rows[k] for k in np.argsort(-least, kind="stable")[:_TRIED])


def _ends(kinematics: Kinematics, start: Array, size: float, grid: float) -> Iterator[Array]:
    """Ends of lines along the commanded coordinates, in both directions, the longest first."""
    for share in _SHARES:
        length = max(np.round(share * size / grid), 1.0) * grid
        for coordinate in kinematics.mechanism.task.position:
            for sign in (1.0, -1.0):
                yield start + sign * length * np.eye(3)["xyz".index(coordinate)]


@dataclass(frozen=True)
class _Path:
    machine: Machine
    points: Array
    rotation: Array
    size: float

    def is_followed(self, chosen: Bytes) -> bool:
        """Whether the machine can follow it in this configuration, inside its limits, without a leap of an axis."""
        joints, frames = self.machine.kinematics.mechanism.joints, [(*p, *self.rotation.flat) for p in self.points]
        nowhere = (0.0,) * len(joints)
        solved, statuses = branches_at(self.machine, frames, [chosen] * len(frames), [nowhere] * len(frames))
        if any(status is not Status.OK for status in statuses):
            return False
        rows = np.array(solved)
        scale = np.array([1.0 if joint.axis_is_angle else self.size / 100.0 for joint in joints])
        inside = are_inside(self.machine, {joint.axis.name: rows[:, k] for k, joint in enumerate(joints)})
        return bool(np.all(inside)) and float(np.max(np.abs(np.diff(rows, axis=0)) / scale)) <= _STEP

    def other(self, count: int) -> Bytes | None:
        """Another configuration in which a chain can follow it, with the last possible branch exchanged alone."""
        if self.machine.kinematics.mechanism.chain is None:
            return None
        choices = (tuple(2 if branch == k else 1 for branch in range(count)) for k in reversed(range(count)))
        return next(filter(self.is_followed, choices), None)


def rotation_of(angles: Array) -> Array:
    """The rotation of turns about Z, the new Y and the new Z, in degrees."""
    a, b, c = np.radians(angles)
    tilted = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    return np.asarray(_about_z(a) @ tilted @ _about_z(c))


def _about_z(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def _turns(rotation: Array) -> Array:
    """The turns of a rotation; where the second is 0 or 180 degrees, the first is 0."""
    across = np.hypot(rotation[0, 2], rotation[1, 2])
    if across < 1e-6:
        turn = np.arctan2(rotation[1, 0], rotation[1, 1])
        return np.degrees([0.0, np.arctan2(across, rotation[2, 2]), turn])
    return np.degrees(
        [
            np.arctan2(rotation[1, 2], rotation[0, 2]),
            np.arctan2(across, rotation[2, 2]),
            np.arctan2(rotation[2, 1], -rotation[2, 0]),
        ]
    )
