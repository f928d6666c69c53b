"""A coupling on arrays: the programs of its parts run one after the other. `_coupled` has it on plain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from softkin._array import Codes, Matrix, Programs, Reals, Rotation, Signs, Turns, Vector
from softkin._core import TWIST
from softkin._types import Status
from softkin._vectors import moved, on_flange, plus, product, rates, seen_from, transposed, turned

if TYPE_CHECKING:
    from softkin._core import Mechanism
    from softkin._orientation import OrientationKinematics
    from softkin._types import Rotation as OneRotation
    from softkin._types import Vector as OneVector


class CoupledPrograms(Programs):
    """The programs of a coupling."""

    def __init__(
        self,
        position: Mechanism,
        orientation: OrientationKinematics,
        flange: OneRotation | None,
        axis: tuple[OneVector, OneVector],
        tool: tuple[OneVector, OneRotation] | None,
    ) -> None:
        """flange: the rotation of a flange that keeps its orientation; axis: the axis about which a flange turns.

        tool: position and rotation of the tool on a flange that follows the commanded rotation.
        """
        self.parts = position, orientation
        self.tool = tool
        self.first, self.second = position._array_programs(), orientation._array_programs()
        self.count, self.branches, self.periods = len(position.AXES), position.BRANCHES, len(position.PERIOD_AXES)
        self.limited = position.checks_limits, orientation.checks_limits
        self.flange, self.axis = flange, axis
        self.VALUES = self.first.VALUES + self.second.VALUES

    def forward(self, axes: Reals) -> tuple[tuple[Vector, Rotation, Reals], Codes]:
        """The frame of the second part on the frame of the first."""
        (position, flange, margins), status = self.first.forward(axes[: self.count])
        (end, rotation, own), outcome = self.second.forward(axes[self.count :])
        pose = plus(position, turned(flange, end)), product(flange, rotation), margins + own
        return pose, both(status, outcome)

    def branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes of both parts: the orientation is solved first where the flange keeps its own, else the position."""
        first = signs[: self.branches], turns[: self.periods], reference[: self.count]
        second = signs[self.branches :], turns[self.periods :], reference[self.count :]
        if self.flange is not None:
            own, status = self.second.branch(_origin(position), seen_from(self.flange, rotation), *second)
            (end, _, _), outcome = self.second.forward(own)
            place = plus(position, turned(self.flange, end), -1.0)
            axes, found = self.first.branch(place, rotation, *first)
            return axes + own, both(both(status, outcome), found)
        if self.tool is not None:
            end, turn = self.tool
            wanted = product(rotation, transposed(turn))
            nearest, status = self.first.projection(wanted)
            axes, found = self.first.branch(plus(position, turned(nearest, end), -1.0), wanted, *first)
            return axes, both(status, found)
        shift, status = self.second.end_point_shift(rotation, *self.axis)
        axes, outcome = self.first.branch(plus(position, shift, -1.0), rotation, *first)
        (_, flange, _), found = self.first.forward(axes)
        own, last = self.second.branch(_origin(position), seen_from(flange, rotation), *second)
        return axes + own, both(both(status, outcome), both(found, last))

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The Jacobian, which has all six rows of the twist."""
        return self.twist(axes)

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The flange moves the end point as a rigid body, and the orientation axes move it relatively."""
        position, orientation = self.parts
        carrier, status = all_six(position, self.first, axes[: self.count])
        own, outcome = all_six(orientation, self.second, axes[self.count :])
        (_, flange, _), found = self.first.forward(axes[: self.count])
        (end, _, _), last = self.second.forward(axes[self.count :])
        arm = turned(flange, end)
        columns = [moved(column, arm) for column in zip(*carrier, strict=True)]
        columns += [(*turned(flange, c[:3]), *turned(flange, c[3:])) for c in zip(*own, strict=True)]
        matrix = tuple(zip(*columns, strict=True)) if columns else ((),) * len(TWIST)
        return matrix, both(both(status, outcome), both(found, last))

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the end point at constant speeds of the axes: that of the flange, and that on it."""
        position, orientation = self.parts
        first, second, own_speeds = axes[: self.count], axes[self.count :], speeds[self.count :]
        carrier, status = all_six(position, self.first, first)
        own, outcome = all_six(orientation, self.second, second)
        carried, third = bias_of_all_six(position, self.first, first, speeds[: self.count])
        inner, fourth = bias_of_all_six(orientation, self.second, second, own_speeds)
        (_, flange, _), found = self.first.forward(first)
        (end, _, _), last = self.second.forward(second)
        spin = rates(carrier[3:], speeds[: self.count])
        moving = on_flange(carried, spin, flange, end, (own, own_speeds, inner))
        return moving, both(both(both(status, outcome), both(third, fourth)), both(found, last))

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The same: the Jacobian has all six rows."""
        return self.bias(axes, speeds)

    def singularity(self, axes: Reals) -> tuple[Reals, Codes]:
        """The margins of both parts."""
        carrier, status = self.first.singularity(axes[: self.count])
        own, outcome = self.second.singularity(axes[self.count :])
        return carrier + own, both(status, outcome)

    def projection(self, rotation: Rotation) -> tuple[Rotation, Codes]:
        """The nearest rotation of the tool, where the commanded one says the turn of the flange."""
        position, orientation = self.parts
        if self.tool is not None:
            turn = self.tool[1]
            nearest, status = self.first.projection(product(rotation, transposed(turn)))
            return product(nearest, turn), status
        at_zero = position.orientation_image().rotation
        nearest, status = self.second.projection(seen_from(at_zero, rotation))
        return product(at_zero, nearest), status

    def limits(self, axes: Reals) -> Codes:
        """The statuses of the tests of limits, in the parts that test them."""
        status = np.zeros(np.shape(axes[0]) if axes else (), np.uint8)
        if self.limited[0]:
            status = both(status, self.first.limits(axes[: self.count]))
        return both(status, self.second.limits(axes[self.count :])) if self.limited[1] else status


def all_six(mechanism: Mechanism, programs: Programs, axes: Reals) -> tuple[Matrix, Codes]:
    """All six rows of the twist of a mechanism."""
    if not mechanism._turns_unseen():
        rows, status = programs.jacobian(axes)
        known = dict(zip(mechanism.JACOBIAN_ROWS, rows, strict=True))
        return tuple(known.get(row, (0.0,) * len(axes)) for row in TWIST), status
    return programs.twist(axes)


def bias_of_all_six(mechanism: Mechanism, programs: Programs, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
    """The acceleration of all six rows of the twist at constant speeds of the axes."""
    if not mechanism._turns_unseen():
        rows, status = programs.bias(axes, speeds)
        known = dict(zip(mechanism.JACOBIAN_ROWS, rows, strict=True))
        return tuple(known.get(row, 0.0) for row in TWIST), status
    return programs.twist_bias(axes, speeds)


def both(status: Codes, later: Codes) -> Codes:
    """The first of two statuses unless it is OK, else the second."""
    return np.where(status == Status.OK, later, status)


def _origin(position: Vector) -> Vector:
    """A position of zeros in the shape of another one."""
    zero = np.zeros(np.shape(position[0]))
    return zero, zero, zero
