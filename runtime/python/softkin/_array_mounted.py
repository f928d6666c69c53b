"""A machine on a base with a tool, on arrays: `_mounted` has it on plain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

import numpy as np

from softkin._array import (
    Codes,
    Matrix,
    Programs,
    Real,
    Reals,
    Rotation,
    Signs,
    StartedPrograms,
    Turns,
    Vector,
    reasonable,
    select,
)
from softkin._array_coupled import all_six, bias_of_all_six, both
from softkin._core import PITCH, TURN, TWIST
from softkin._frame import IDENTITY
from softkin._tools import TILTS, rows_by_name
from softkin._types import Status
from softkin._vectors import (
    at_end,
    moved,
    plus,
    product,
    rates,
    seen_from,
    transposed,
    turned,
    turned_twist,
)

if TYPE_CHECKING:
    from softkin._mounted import Mounted
    from softkin._types import Vector as OneVector


class MountedPrograms(Programs):
    """The programs of a mounted machine."""

    machine: Mounted

    def __init__(self, machine: Mounted, programs: Programs, kind: str, shift: OneVector | None) -> None:
        """programs: those of the bare machine. shift: from the flange to the tool, where it is the same everywhere."""
        self.machine, self.programs, self.kind, self.shift = machine, programs, kind, shift
        self.VALUES = programs.VALUES
        self.base, self.base_rotation = machine.base.position, machine.base.rotation
        self.tool, self.tool_rotation = machine.tool.position, machine.tool.rotation

    def forward(self, axes: Reals) -> tuple[tuple[Vector, Rotation, Reals], Codes]:
        """The frame of the tool."""
        pose, status = self.programs.forward(axes)
        return self._of_flange(*pose), status

    def _of_flange(self, position: Vector, rotation: Rotation, margins: Reals) -> tuple[Vector, Rotation, Reals]:
        place = plus(position, turned(rotation, self.tool))
        turn = product(self.base_rotation, product(rotation, self.tool_rotation))
        return plus(self.base, turned(self.base_rotation, place)), turn, margins

    def _flange(self, position: Vector, rotation: Rotation) -> tuple[Vector, Vector, Rotation, Codes]:
        """The place of the tool, then the commanded frame of the flange, in the frame of the bare machine."""
        x, y, z = turned(transposed(self.base_rotation), plus(position, self.base, -1.0))
        known = reasonable(*position)
        place = select(known, x, np.nan), select(known, y, np.nan), select(known, z, np.nan)
        status = np.zeros((), np.uint8)
        if self.machine.READS_ROTATION:
            rotation = product(seen_from(self.base_rotation, rotation), transposed(self.tool_rotation))
        if self.shift is not None:
            return place, plus(place, self.shift, -1.0), rotation, status
        nearest = rotation
        if self.kind == TURN:
            nearest, status = self.programs.projection(rotation)
        return place, plus(place, turned(nearest, self.tool), -1.0), rotation, status

    def branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes of the bare machine for the frame of the flange."""
        place, at, wanted, refused = self._flange(position, rotation)
        axes, status = self.programs.branch(at, wanted, signs, turns, reference)
        if self.kind != PITCH:
            return axes, both(refused, status)
        return self._iterated(place, wanted, signs, turns, reference, axes, status)

    def _iterated(
        self, place: Vector, wanted: Rotation, signs: Signs, turns: Turns, reference: Reals, axes: Reals, status: Codes
    ) -> tuple[Reals, Codes]:
        """The axes where the tool meets its place, with the rotation that the flange has there."""
        from softkin._mounted import MET, PASSES

        met = status != Status.OK
        for _ in range(PASSES):
            (found, rotation, _), failed = self.programs.forward(axes)
            arm = turned(rotation, self.tool)
            missed = _length(plus(place, plus(found, arm), -1.0))
            met = met | (failed != Status.OK) | (missed <= MET * (_length(place) + _length(arm)))
            status = both(status, failed)
            if np.all(met):
                break
            further, outcome = self.programs.branch(plus(place, arm, -1.0), wanted, signs, turns, reference)
            axes = tuple(np.where(met, old, new) for old, new in zip(axes, further, strict=True))
            status = np.where(met, status, outcome)
            met = met | (status != Status.OK)
        return axes, np.where(met, status, np.uint8(Status.UNREACHABLE))

    def limits(self, axes: Reals) -> Codes:
        """The statuses of the test of all limits."""
        return self.programs.limits(axes)

    def singularity(self, axes: Reals) -> tuple[Reals, Codes]:
        """The margins of the bare machine."""
        return self.programs.singularity(axes)

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The rows of the tool's twist; the rows about axes of the wrist are those of the bare machine."""
        own, status = self.twist(axes)
        bare, outcome = self.programs.jacobian(axes)
        return self._named(axes, own, bare), both(status, outcome)

    def _named(self, axes: Reals, own: Reals, bare: Reals) -> Reals:
        """The rows of the machine, by the twist of the tool and the rows of the bare machine."""
        names = self.machine.JACOBIAN_ROWS
        rotation = self.forward(axes)[0][1] if TILTS[0] in names else IDENTITY
        return rows_by_name(names, own, rotation, zip(self.machine.bare.JACOBIAN_ROWS, bare, strict=True))

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The twist of the tool."""
        rows, status = all_six(self.machine.bare, self.programs, axes)
        (_, flange, _), failed = self.programs.forward(axes)
        arm, base = turned(flange, self.tool), self.base_rotation
        columns = [moved(column, arm) for column in zip(*rows, strict=True)]
        columns = [(*turned(base, c[:3]), *turned(base, c[3:])) for c in columns]
        matrix = tuple(zip(*columns, strict=True)) if columns else ((),) * len(TWIST)
        return matrix, both(status, failed)

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """As `jacobian`: the axes of the tool turn with it, so that they change no turn about them."""
        own, status = self.twist_bias(axes, speeds)
        bare, outcome = self.programs.bias(axes, speeds)
        return self._named(axes, own, bare), both(status, outcome)

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the twist of the tool at constant speeds of the axes."""
        bare = self.machine.bare
        rows, status = all_six(bare, self.programs, axes)
        own, outcome = bias_of_all_six(bare, self.programs, axes, speeds)
        (_, flange, _), failed = self.programs.forward(axes)
        moving = at_end(own, rates(rows[3:], speeds), turned(flange, self.tool))
        return turned_twist(self.base_rotation, moving), both(both(status, outcome), failed)


class StartedMountedPrograms(MountedPrograms, StartedPrograms):
    """The programs of a mounted machine whose forward kinematics iterates."""

    programs: StartedPrograms

    def started(self, position: Vector, rotation: Rotation) -> Self:
        """These programs, whose forward kinematics starts at other frames of the tool."""
        turn = product(seen_from(self.base_rotation, rotation), transposed(self.tool_rotation))
        place = plus(
            turned(transposed(self.base_rotation), plus(position, self.base, -1.0)), turned(turn, self.tool), -1.0
        )
        return type(self)(self.machine, self.programs.started(place, turn), self.kind, self.shift)


def _length(vector: Vector) -> Real:
    return np.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])
