"""A machine as the Python package has it, and by how much what LinuxCNC did differs from that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import softkin
from numpy.typing import NDArray

from prove.linuxcnc.machines import LETTERS, Machine, Stand
from prove.linuxcnc.poses import Reals, Segment, frames, segments
from prove.linuxcnc.session import Stage

Rows = NDArray[np.int64]


@dataclass(frozen=True)
class Twin:
    """A machine of the package with the same parameters and limits."""

    machine: Machine

    @cached_property
    def robot(self) -> Any:
        """The machine: of which class, its name in the catalogue says."""
        limits = dict(self.machine.limits) or None
        sizes = dict(self.machine.sizes)
        if self.machine.tool is not None:
            sizes[self.machine.tool[0]] += self.machine.raised
        return softkin.catalogue()[self.machine.mechanism](**sizes, limits=limits)

    @property
    def raised(self) -> Reals:
        """What LinuxCNC adds to the pose (6,) of a program for the tool."""
        return np.array([0.0, 0.0, self.machine.raised, 0.0, 0.0, 0.0])

    def pose(self, joints: Sequence[float]) -> Reals:
        """The pose (6,) at these joint values: X, Y, Z, A, B, C."""
        frame, _ = self.robot.forward(joints)
        (x, y, _), (x2, y2, _), (x3, y3, z3) = frame.rotation
        turned = np.degrees([np.arctan2(y3, z3), np.arctan2(-x3, np.hypot(x, x2)), np.arctan2(x2, x)])
        if self.machine.turns:
            named = dict(zip((axis.name for axis in self.robot.AXES), joints, strict=True))
            turned = np.array([named.get(letter, 0.0) for letter in "ABC"])
        return np.concatenate([frame.position, turned]) + self.raised

    def home(self) -> dict[str, float]:
        """The pose of the joints' home, by letter."""
        return dict(zip(LETTERS, self.pose(self.machine.first.joints).tolist(), strict=True))

    def branches(self, stand: Stand) -> tuple[int, ...]:
        """The bytes of the configuration of a stand that are no turns."""
        return tuple(self.robot.forward(stand.joints)[1][: self.robot.BRANCHES])

    def inverse_differs(self, stage: Stage, stand: Stand, rows: Rows) -> tuple[float, int]:
        """The greatest difference of a joint, and how many poses the package refuses.

        Each of these rows is asked in the configuration of the stand, near the joints of the row before.
        """
        positions, rotations = frames(self.machine, stage.poses[rows])
        branches = self.branches(stand)
        turns = len(self.robot.CONFIGURATION) - len(branches)
        axes, statuses = self.robot.inverse_batch(
            positions, rotations, (*branches, *(turns * (0,))), stage.joints[np.maximum(rows - 1, 0)]
        )
        return greatest(axes - stage.joints[rows]), int(np.count_nonzero(statuses))

    def speeds_differ(self, stage: Stage, rows: Rows) -> float:
        """The greatest difference of a joint's speed from that by the Jacobian, as a part of the greatest speed.

        Each of these rows stands between two in which the same program moves.
        """
        sides = [frames(self.machine, stage.poses[rows + side]) for side in (-1, 1)]
        moved, turn = sides[1][0] - sides[0][0], sides[1][1] @ sides[0][1].transpose(0, 2, 1)
        turned = np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]])
        tilted = np.einsum("nij,in->jn", frames(self.machine, stage.poses[rows])[1], turned)
        names = ("x", "y", "z", "turn x", "turn y", "turn z", "tilt x", "tilt y")
        known = dict(zip(names, (*moved.T, *0.5 * turned, *0.5 * tilted[:2]), strict=True))
        twist = np.stack([known[row] for row in self.robot.JACOBIAN_ROWS], axis=1)
        jacobians, _ = self.robot.jacobian_batch(stage.joints[rows])
        by_jacobian = np.linalg.solve(jacobians, twist[:, :, None])[:, :, 0]
        by_jacobian *= [180.0 / np.pi if axis.unit == "deg" else 1.0 for axis in self.robot.AXES]
        seen = stage.joints[rows + 1] - stage.joints[rows - 1]
        return greatest(seen - by_jacobian) / greatest(seen)

    def forward_differs(self, stage: Stage, rows: Rows) -> tuple[float, int]:
        """The greatest difference of a pose (of a rotation: degrees), and how many the package cannot assemble.

        In these rows joints move one by one: LinuxCNC computes the pose of the row before.
        """
        positions, rotations, _, statuses = self.robot.forward_batch(stage.joints[rows - 1])
        at, turned = frames(self.machine, stage.poses[rows])
        return max(greatest(at - positions), _degrees(turned - rotations)), int(np.count_nonzero(statuses))

    def way_differs(self, stage: Stage, stand: Stand) -> tuple[float, float]:
        """How far the motors leave the way of a program, and by how much they miss the worst end of its lines."""
        way = segments(self.pose(stand.joints) - self.raised, stand.program)
        positions, rotations, _, _ = self.robot.forward_batch(stage.motors)
        away = np.stack([self._away(part, positions, rotations) for part in way])
        missed = [self._away(Segment(part.end, part.end), positions, rotations).min() for part in way]
        return greatest(away.min(axis=0)), greatest(np.array(missed))

    def _away(self, part: Segment, positions: Reals, rotations: Reals) -> Reals:
        """The distance (N,) of frames from a segment: millimetres, or the degrees of the rotation there."""
        at, turned = frames(self.machine, part.at(part.nearest(positions)) + self.raised)
        away: Reals = np.abs(at - positions).max(axis=1)
        if not self.robot.READS_ROTATION:
            return away
        degrees: Reals = np.degrees(np.abs(turned - rotations).max(axis=(1, 2)))
        return np.maximum(away, degrees)

    def leaves_branches(self, stage: Stage, stand: Stand) -> bool:
        """Whether a row of the stage is in another configuration than the stand."""
        seen = self.robot.forward_batch(stage.joints)[2][:, : self.robot.BRANCHES]
        return bool((seen != np.array(self.branches(stand))).any())


def greatest(differences: Reals) -> float:
    """The greatest absolute value: NaN where one is no number, or where there is none."""
    return float(np.abs(differences).max()) if differences.size else float("nan")


def _degrees(rotations: Reals) -> float:
    """The greatest entry of a difference of rotations, as an angle."""
    return float(np.degrees(greatest(rotations)))
