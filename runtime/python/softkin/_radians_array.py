"""A machine in radians on arrays: the programs of the machine in degrees, with converted angles."""

from __future__ import annotations

from typing import Any

from softkin._array import Codes, Matrix, OrientationPrograms, Programs, Reals, Rotation, Signs, Turns, Vector
from softkin._scalar import DEGREE, RADIAN


class RadianPrograms(OrientationPrograms):
    """The programs of a machine in radians; those that a machine does not have fail."""

    def __init__(self, part: Programs, angles: tuple[bool, ...]) -> None:
        """part: the programs in degrees. angles: which axes are angles."""
        self.part: Any = part
        self.angles = angles
        self.VALUES = part.VALUES + 2 * len(angles)

    def forward(self, axes: Reals) -> tuple[tuple[Vector, Rotation, Reals], Codes]:
        """Forward kinematics."""
        return self.part.forward(self._deg(axes))  # type: ignore[no-any-return]

    def started(self, position: Vector, rotation: Rotation) -> RadianPrograms:
        """These programs, whose forward kinematics starts at other frames."""
        return RadianPrograms(self.part.started(position, rotation), self.angles)

    def branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes of one branch, on their turns."""
        axes, status = self.part.branch(position, rotation, signs, turns, self._deg(reference))
        return self._rad(axes), status

    def every_branch(
        self, position: Vector, rotation: Rotation, branches: int, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes and statuses of every slot."""
        axes, status = self.part.every_branch(position, rotation, branches, turns, self._deg(reference))
        return self._rad(axes), status

    def limits(self, axes: Reals) -> Codes:
        """The statuses of the test of all limits."""
        return self.part.limits(self._deg(axes))  # type: ignore[no-any-return]

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The Jacobian by rows, per radian."""
        return self.part.jacobian(self._deg(axes))  # type: ignore[no-any-return]

    def singularity(self, axes: Reals) -> tuple[Reals, Codes]:
        """The margins, each zero at its singularity."""
        return self.part.singularity(self._deg(axes))  # type: ignore[no-any-return]

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The twist of the frame by rows, per radian."""
        return self.part.twist(self._deg(axes))  # type: ignore[no-any-return]

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the rows of the Jacobian at constant speeds, per radian."""
        return self.part.bias(self._deg(axes), speeds)  # type: ignore[no-any-return]

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the twist at constant speeds, per radian."""
        return self.part.twist_bias(self._deg(axes), speeds)  # type: ignore[no-any-return]

    def projection(self, rotation: Rotation) -> tuple[Rotation, Codes]:
        """The nearest rotation that the flange can have."""
        return self.part.projection(rotation)  # type: ignore[no-any-return]

    def end_point_shift(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> tuple[Vector, Codes]:
        """The vector to the end point of an orientation kinematics."""
        return self.part.end_point_shift(rotation, flange_axis, base_axis)  # type: ignore[no-any-return]

    def _rad(self, axes: Reals) -> Reals:
        return tuple([a * DEGREE if is_angle else a for a, is_angle in zip(axes, self.angles, strict=True)])

    def _deg(self, axes: Reals) -> Reals:
        return tuple([a * RADIAN if is_angle else a for a, is_angle in zip(axes, self.angles, strict=True)])
