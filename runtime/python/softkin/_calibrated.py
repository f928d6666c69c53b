"""A machine as it is: its drawing, and small deviations from it that were measured.

Of a serial machine the true chain is met by steps of its own Jacobian; `_meeting` has them. A closed loop has other
dimensions, and stands on another base with another tool: its inverse stays closed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import pi
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, cast

from softkin._around import Around
from softkin._chain import bias, columns, passed, true_chain
from softkin._core import TWIST, Mechanism, Pose
from softkin._deviations import are_inputs, checked, units_of
from softkin._frame import Frame
from softkin._meeting import Meeting
from softkin._mounted import PLAIN, Mounted
from softkin._scalar import DEGREE, reasonable
from softkin._start import IterativeForward
from softkin._tools import rows_by_name
from softkin._types import (
    Diagnosis,
    FrameLike,
    KinematicsError,
    Matrix,
    Reals,
    Rotation,
    Signs,
    Status,
    Turns,
    Vector,
)

if TYPE_CHECKING:
    from softkin._array import Programs


class Calibrated(Around):
    """A machine with deviations from its drawing: what `Mechanism.calibrated` returns.

    Axes, configuration, turns and limits are those of the nominal machine; frames, Jacobian and axis values are those
    of the true one. Margins are those of the nominal machine at the joints that the true one has.
    Parameters are those of the nominal machine: `nominal.parameters`.
    """

    NAME = "Calibrated"
    PARAMETERS = ()

    nominal: Mechanism
    """The machine as it is drawn, on its base and with its tool."""
    _deviations: Mapping[str, float]
    """Those that are not zero."""
    _zeros: Reals

    def __init__(self, nominal: Mechanism, deviations: Mapping[str, float]) -> None:
        """Calibrate a machine in degrees: see `calibrated`. deviations: checked, none of them zero."""
        bare = bare_of(nominal)
        own = {
            "NAME": f"{nominal.NAME} as measured", "parameters": MappingProxyType({}), "nominal": nominal,
            "_deviations": MappingProxyType(dict(deviations)), "_zeros": bare._axis_zeros(),
        }  # fmt: skip
        self._surround(nominal, own)
        keys = [axis.name.lower().replace(" ", "_") for axis in self.AXES]
        self._gains = tuple(1.0 + deviations.get(f"{key}_gain", 0.0) for key in keys)
        self._offsets = tuple(deviations.get(f"{key}_offset", 0.0) for key in keys)
        self._build()
        self._seal()

    def _build(self) -> None:
        bare, (base, tool) = bare_of(self.nominal), ends_of(self.nominal)
        self._true = true_chain(bare, self._deviations, base, tool)
        self._units = tuple(DEGREE if axis.unit == "deg" else 1.0 for axis in self.AXES)
        self._meeting = Meeting(self, self._true, base.rotation, bare.JACOBIAN_ROWS)

    def _size(self, reach: float) -> float:
        """The sum of all deviations, in radians and shares of the reach; of a gain it is that of half a turn."""
        sizes, units = {"deg": DEGREE, "u": 1.0 / reach, "1": pi}, units_of(bare_of(self.nominal))
        return sum(abs(value) * sizes[units[name]] for name, value in self._deviations.items())

    @property
    def deviations(self) -> Mapping[str, float]:
        """All deviations by name: see `Mechanism.deviations`."""
        return MappingProxyType({**self.nominal.deviations, **self._deviations})

    def __repr__(self) -> str:
        """The call that makes this mechanism."""
        return f"{self.nominal!r}.calibrated({dict(self._deviations)!r})"

    def __hash__(self) -> int:
        """The hash of machine and deviations."""
        return hash((self.nominal, tuple(self._deviations.items())))

    __eq__ = Mechanism.__eq__

    def __reduce__(self) -> tuple[Callable[..., Mechanism], tuple[Mechanism, dict[str, float]]]:
        """Copying and pickling calibrate the machine again."""
        return calibrated, (self.nominal, dict(self._deviations))

    def changed(self, **parameters: Any) -> Self:
        """The same deviations of a nominal machine with other parameters."""
        return cast("Self", calibrated(self.nominal.changed(**parameters), self._deviations))

    def to_dict(self) -> dict[str, Any]:
        """The nominal machine, and the deviations that are not zero, as plain data."""
        return {
            "mechanism": "Calibrated", "nominal": self.nominal.to_dict(), "deviations": dict(self._deviations)
        }  # fmt: skip

    @classmethod
    def from_dict(cls, given: Mapping[str, Any]) -> Self:
        """The machine of `to_dict`. Raises NOT_INITIALIZED for other data."""
        values = dict(given)
        is_radian = values.pop("in_radians", False)
        is_known = values.pop("mechanism", "Calibrated") == "Calibrated" and set(values) == {"nominal", "deviations"}
        if not (is_known and isinstance(values["nominal"], Mapping)):
            raise KinematicsError(Status.NOT_INITIALIZED, "Calibrated: the entries must be nominal and deviations")
        made = Mechanism.from_dict(values["nominal"]).calibrated(values["deviations"])
        return cast("Self", made.in_radians() if is_radian else made)

    def _nearest_flange(self, rotation: Rotation) -> Rotation | Status:
        return self.nominal._nearest_flange(rotation)

    def _axis_zeros(self) -> Reals:
        return self._zeros

    def _actual(self, axes: Reals) -> Reals:
        """The axis values at which the nominal machine would have the joints that this one has."""
        known = zip(axes, self._zeros, self._gains, self._offsets, strict=True)
        return tuple([zero + (axis - zero) * gain + offset for axis, zero, gain, offset in known])

    def _commanded(self, actual: Reals) -> Reals:
        """The inverse of `_actual`."""
        known = zip(actual, self._zeros, self._gains, self._offsets, strict=True)
        return tuple([zero + (axis - zero - offset) / gain for axis, zero, gain, offset in known])

    def _motors(self, axes: Reals) -> Reals:
        """The motor values in radians and lengths."""
        known = zip(self._actual(axes), self._zeros, self._units, strict=True)
        return tuple([(axis - zero) * unit for axis, zero, unit in known])

    def _forward(self, axes: Reals) -> Pose | Status:
        if not reasonable(*axes):
            return Status.BAD_INPUT
        pose = self.nominal._forward(self._actual(axes))
        return pose if isinstance(pose, Status) else (*passed(self._true, self._motors(axes))[0], pose[2])

    def _orientation(self, axes: Reals) -> Rotation | Status:
        return passed(self._true, self._motors(axes))[0][1] if reasonable(*axes) else Status.BAD_INPUT

    def _singularity(self, axes: Reals) -> Reals | Status:
        return self.nominal._singularity(self._actual(axes))

    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        return self._meeting.branch((position, rotation), signs, turns, reference)

    def _jacobian(self, axes: Reals) -> Matrix | Status:
        rows, rotation = self._twist(axes), self._orientation(axes)
        if isinstance(rows, Status) or isinstance(rotation, Status):
            return Status.BAD_INPUT
        return rows_by_name(self.JACOBIAN_ROWS, rows, rotation)

    def _twist(self, axes: Reals) -> Matrix | Status:
        if not reasonable(*axes):
            return Status.BAD_INPUT
        (place, _), lines = passed(self._true, self._motors(axes))
        found = columns(self._true, lines, place, len(axes))
        scaled = [[gain * entry for entry in column] for gain, column in zip(self._gains, found, strict=True)]
        return tuple(zip(*scaled, strict=True)) if scaled else ((),) * len(TWIST)

    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        rows, rotation = self._twist_bias(axes, speeds), self._orientation(axes)
        if isinstance(rows, Status) or isinstance(rotation, Status):
            return Status.BAD_INPUT
        return rows_by_name(self.JACOBIAN_ROWS, rows, rotation)

    def _twist_bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        if not reasonable(*axes):
            return Status.BAD_INPUT
        (place, _), lines = passed(self._true, self._motors(axes))
        return bias(self._true, lines, place, self._gained_speeds(speeds))

    def _gained_speeds(self, speeds: Reals) -> Reals:
        """The speeds of the actual axes."""
        return tuple([gain * speed for gain, speed in zip(self._gains, speeds, strict=True)])

    def with_tool(self, tool: FrameLike) -> Mounted:
        """This machine with a tool at its flange, in front of which its deviation stands: see `Mechanism.with_tool`."""
        return cast("Mounted", calibrated(self.nominal.with_tool(tool), self._deviations))

    def with_base(self, base: FrameLike) -> Mounted:
        """This machine on a base, behind which its deviation stands: see `Mechanism.with_base`."""
        return cast("Mounted", calibrated(self.nominal.with_base(base), self._deviations))

    def _array_programs(self) -> Programs:
        """The programs on arrays; the inverse computes row by row."""
        from softkin._array_calibrated import CalibratedPrograms

        return CalibratedPrograms(self)


def calibrated(robot: Mechanism, deviations: Mapping[str, float]) -> Mechanism:
    """The machine with deviations, instead of those of these names that it has. Without any it is the nominal one."""
    in_degrees = robot.in_degrees()
    if in_degrees is not robot:
        return calibrated(in_degrees, deviations).in_radians()
    nominal, before = (robot.nominal, robot._deviations) if isinstance(robot, Calibrated) else (robot, {})
    if are_inputs(bare_of(nominal)):
        checked(bare_of(nominal), deviations)
        return nominal.changed(**deviations)
    found = checked(bare_of(nominal), {**before, **deviations} if isinstance(deviations, Mapping) else deviations)
    if not found:
        return nominal
    if bare_of(nominal)._chain() is not None:
        return Calibrated(nominal, found)
    from softkin._calibrated_loop import CalibratedLoop, StartedLoop

    return (StartedLoop if isinstance(nominal, IterativeForward) else CalibratedLoop)(nominal, found)


def bare_of(nominal: Mechanism) -> Mechanism:
    """The machine without base and tool."""
    return nominal.bare if isinstance(nominal, Mounted) else nominal


def ends_of(nominal: Mechanism) -> tuple[Frame, Frame]:
    """Its base and its tool."""
    return (nominal.base, nominal.tool) if isinstance(nominal, Mounted) else (PLAIN, PLAIN)
