"""A serial machine with deviations, on arrays: its inverse asks the one on plain numbers row by row."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from softkin._array import Codes, Matrix, Programs, Reals, Rotation, Signs, Turns, Vector
from softkin._chain import bias, columns
from softkin._chain import passed as chained
from softkin._core import TWIST
from softkin._radians_array import RadianPrograms
from softkin._tools import rows_by_name
from softkin._types import Diagnosis

if TYPE_CHECKING:
    from softkin._calibrated import Calibrated


class CalibratedPrograms(Programs):
    """The programs of a serial machine with deviations."""

    machine: Calibrated

    def __init__(self, machine: Calibrated) -> None:
        """machine: on plain numbers."""
        self.machine, self.nominal = machine, machine.nominal._array_programs()
        self.VALUES = self.nominal.VALUES

    def forward(self, axes: Reals) -> tuple[tuple[Vector, Rotation, Reals], Codes]:
        """The frame of the tool, and the margins of the nominal machine at the same joints."""
        (_, _, margins), status = self.nominal.forward(self.machine._actual(axes))
        (position, rotation), _ = chained(self.machine._true, self.machine._motors(axes), np.cos, np.sin)
        return (position, rotation, margins), status

    def branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> tuple[Reals, Codes]:
        """The axes of one branch."""
        given = np.broadcast_arrays(*position, *(r for row in rotation for r in row), *signs, *turns, *reference)
        shape, rows = given[0].shape, np.stack([g.ravel() for g in given], axis=-1).tolist()
        found, statuses = np.full((len(rows), len(reference)), np.nan), np.zeros(len(rows), np.uint8)
        ends = 12 + len(signs), 12 + len(signs) + len(turns)
        for k, row in enumerate(rows):
            turn = tuple(row[3:6]), tuple(row[6:9]), tuple(row[9:12])
            bytes_ = tuple(map(int, row[12 : ends[1]]))
            axes = self.machine._branch(
                tuple(row[:3]), turn, bytes_[: len(signs)], bytes_[len(signs) :], tuple(row[ends[1] :])
            )
            if isinstance(axes, Diagnosis):
                statuses[k] = axes.status
            else:
                found[k] = axes
        return tuple(column.reshape(shape) for column in found.T), statuses.reshape(shape)

    def limits(self, axes: Reals) -> Codes:
        """The statuses of the test of all limits."""
        return self.nominal.limits(axes)

    def singularity(self, axes: Reals) -> tuple[Reals, Codes]:
        """The margins of the nominal machine at the same joints."""
        return self.nominal.singularity(self.machine._actual(axes))

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The rows of the Jacobian."""
        rows, status = self.twist(axes)
        (_, rotation), _ = chained(self.machine._true, self.machine._motors(axes), np.cos, np.sin)
        return rows_by_name(self.machine.JACOBIAN_ROWS, rows, rotation), status

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The twist of the tool."""
        _, status = self.nominal.forward(self.machine._actual(axes))
        (place, _), lines = chained(self.machine._true, self.machine._motors(axes), np.cos, np.sin)
        found = columns(self.machine._true, lines, place, len(axes))
        scaled = [[gain * entry for entry in column] for gain, column in zip(self.machine._gains, found, strict=True)]
        return tuple(zip(*scaled, strict=True)) if scaled else ((),) * len(TWIST), status

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the rows of the Jacobian at constant speeds of the axes."""
        rows, status = self.twist_bias(axes, speeds)
        (_, rotation), _ = chained(self.machine._true, self.machine._motors(axes), np.cos, np.sin)
        return rows_by_name(self.machine.JACOBIAN_ROWS, rows, rotation), status

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the twist of the tool at constant speeds of the axes."""
        _, status = self.nominal.forward(self.machine._actual(axes))
        (place, _), lines = chained(self.machine._true, self.machine._motors(axes), np.cos, np.sin)
        return bias(self.machine._true, lines, place, self.machine._gained_speeds(speeds)), status


class GainedPrograms(RadianPrograms):
    """The programs of a closed loop with deviations: those of a loop with its dimensions, and the gains of the axes."""

    machine: Calibrated

    def __init__(self, machine: Calibrated, part: Programs) -> None:
        """part: the programs of the loop with its dimensions."""
        super().__init__(part, ())
        self.machine = machine

    def started(self, position: Vector, rotation: Rotation) -> GainedPrograms:
        """These programs, whose forward kinematics starts at other frames."""
        return GainedPrograms(self.machine, self.part.started(position, rotation))

    def limits(self, axes: Reals) -> Codes:
        """The statuses of the test of all limits."""
        return self.part.limits(axes)  # type: ignore[no-any-return]

    def jacobian(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The rows of the Jacobian, by the axes themselves."""
        return self._gained(*super().jacobian(axes))

    def twist(self, axes: Reals) -> tuple[Matrix, Codes]:
        """The rows of the twist, by the axes themselves."""
        return self._gained(*super().twist(axes))

    def bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the rows of the Jacobian at constant speeds, by the axes themselves."""
        return super().bias(axes, self.machine._gained_speeds(speeds))

    def twist_bias(self, axes: Reals, speeds: Reals) -> tuple[Reals, Codes]:
        """The acceleration of the twist at constant speeds, by the axes themselves."""
        return super().twist_bias(axes, self.machine._gained_speeds(speeds))

    def _gained(self, rows: Matrix, status: Codes) -> tuple[Matrix, Codes]:
        gains = self.machine._gains
        return tuple(tuple(g * entry for g, entry in zip(gains, row, strict=True)) for row in rows), status

    def _rad(self, axes: Reals) -> Reals:
        return self.machine._commanded(axes)

    def _deg(self, axes: Reals) -> Reals:
        return self.machine._actual(axes)
