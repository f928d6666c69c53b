"""A closed loop as it is: other dimensions, another base, another tool. Its inverse stays in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from softkin._calibrated import Calibrated, bare_of, ends_of
from softkin._chain import true_ends
from softkin._core import EveryPose, Mechanism, Pose
from softkin._frame import Frame
from softkin._mounted import mounted
from softkin._start import IterativeForward
from softkin._types import Diagnosis, Matrix, Reals, Rotation, Signs, Status, Turns, Vector

if TYPE_CHECKING:
    from softkin._array import OrientationPrograms


class CalibratedLoop(Calibrated):
    """A closed loop with deviations: a machine with other parameters, on another base and with another tool."""

    PARAMETERS = ()

    part: Mechanism
    """That machine. The gains of the axes are not in it."""

    def _build(self) -> None:
        bare, off = bare_of(self.nominal), self._deviations
        changed = {name: bare.parameters[name] + off[name] for name in off if name in bare.parameters}
        keys = zip(bare.LIMIT_KEYS, self._offsets, self._zeros, strict=False)
        changed |= {f"offset_{key}": zero - offset for key, offset, zero in keys if offset}
        (base, tool), (of_base, of_tool) = ends_of(self.nominal), true_ends(off)
        self._offsets = (0.0,) * len(self.AXES)  # they are in the part
        self.part = mounted(bare.changed(**changed), base @ Frame(*of_base), Frame(*of_tool) @ tool)
        self.JACOBIAN_ROWS = self.part.JACOBIAN_ROWS

    def _limits(self, axes: Reals) -> Diagnosis | None:
        return self.part._beyond_limits(axes)

    def _quantities(self, axes: Reals) -> Reals | Status:
        return self.part._quantities(axes)

    def _forward(self, axes: Reals) -> Pose | Status:
        return self.part._forward(self._actual(axes))

    def _every_pose(self, axes: Reals) -> EveryPose:
        return self.part._every_pose(self._actual(axes))

    def _orientation(self, axes: Reals) -> Rotation | Status:
        return self.part._orientation(self._actual(axes))

    def _singularity(self, axes: Reals) -> Reals | Status:
        return self.part._singularity(self._actual(axes))

    def _jacobian(self, axes: Reals) -> Matrix | Status:
        return self._gained(self.part._jacobian(self._actual(axes)))

    def _twist(self, axes: Reals) -> Matrix | Status:
        return self._gained(self.part._twist(self._actual(axes)))

    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        return self.part._bias(self._actual(axes), self._gained_speeds(speeds))

    def _twist_bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        return self.part._twist_bias(self._actual(axes), self._gained_speeds(speeds))

    def _gained(self, rows: Matrix | Status) -> Matrix | Status:
        """The rows of a Jacobian by the axes themselves."""
        if isinstance(rows, Status):
            return rows
        return tuple(tuple(gain * entry for gain, entry in zip(self._gains, row, strict=True)) for row in rows)

    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        found = self.part._branch(position, rotation, signs, turns, self._actual(reference))
        return found if isinstance(found, Diagnosis) else self._commanded(found)

    def _array_programs(self) -> OrientationPrograms:
        """The programs on arrays, which are in closed form."""
        from softkin._array_calibrated import GainedPrograms

        return GainedPrograms(self, self.part._array_programs())


class StartedLoop(CalibratedLoop, IterativeForward):
    """A closed loop with deviations whose forward kinematics iterates."""

    PARAMETERS = ()

    def _started(self, position: Vector, rotation: Rotation) -> Self:
        found = object.__new__(type(self))
        known = {**vars(self), "_kept": (frozenset(), {}), "part": self.part._started(position, rotation)}
        for name in ("parameters", "checks_limits"):
            known[name] = getattr(self, name)
        for name, value in known.items():
            object.__setattr__(found, name, value)
        return found

    if TYPE_CHECKING:

        def _array_programs(self) -> Any: ...
