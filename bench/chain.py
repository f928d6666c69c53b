"""Forward kinematics by the Denavit-Hartenberg table, for many rows: what every answer is judged by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """A standard Denavit-Hartenberg table: lengths in metres, angles in degrees. `zero` is added to
    the joint values.
    """

    name: str
    alpha: tuple[float, ...]
    a: tuple[float, ...]
    d: tuple[float, ...]
    zero: tuple[float, ...]

    def frames(self, axes: Array) -> Array:
        """Poses (N, 4, 4) at axis values (N, 6) in degrees."""
        frames = np.broadcast_to(np.eye(4), (len(axes), 4, 4))
        for k, alpha in enumerate(np.radians(self.alpha)):
            theta = np.radians(axes[:, k] + self.zero[k])
            c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
            link = np.zeros((len(axes), 4, 4))
            link[:, 0] = np.stack([c, -s * ca, s * sa, self.a[k] * c], axis=1)
            link[:, 1] = np.stack([s, c * ca, -c * sa, self.a[k] * s], axis=1)
            link[:, 2, 1:] = sa, ca, self.d[k]
            link[:, 3, 3] = 1.0
            frames = frames @ link
        return frames


KR6_R900 = Table(
    "KUKA KR6 R900 (spherical wrist)",
    alpha=(90.0, 0.0, 90.0, 90.0, -90.0, 0.0),
    a=(0.025, 0.455, 0.035, 0.0, 0.0, 0.0),
    d=(0.400, 0.0, 0.0, 0.420, 0.0, 0.080),
    zero=(0.0, 90.0, 0.0, 0.0, 0.0, 0.0),
)
UR5 = Table(
    "UR5 (three parallel axes)",
    alpha=(90.0, 0.0, 0.0, 90.0, -90.0, 0.0),
    a=(0.0, -0.425, -0.39225, 0.0, 0.0, 0.0),
    d=(0.089159, 0.0, 0.0, 0.10915, 0.09465, 0.0823),
    zero=(0.0,) * 6,
)


def errors(table: Table, axes: Array, poses: Array) -> Array:
    """The largest entry by which the frames at axes (N, 6) miss the poses (N, 4, 4): metres and parts of one."""
    missed: Array = np.abs(table.frames(axes) - poses).max(axis=(1, 2))
    return missed
