"""A machine in radians: every call converts its angles and asks the machine in degrees."""

from __future__ import annotations

from abc import ABCMeta
from collections.abc import Iterable, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, cast

from softkin._around import Around
from softkin._configuration import Criterion
from softkin._core import EveryPose, Mechanism, Pose
from softkin._input import reals
from softkin._offset import OffsetKinematics
from softkin._orientation import OrientationKinematics, TotalImage
from softkin._scalar import DEGREE, RADIAN
from softkin._start import IterativeForward
from softkin._twist import TwistChoice
from softkin._types import (
    Axis,
    Configuration,
    Diagnosis,
    FrameLike,
    Matrix,
    Numbers,
    Parameter,
    PlainFrame,
    Reals,
    Rotation,
    Signs,
    Solution,
    Status,
    Turns,
    Vector,
    split_unit,
)

if TYPE_CHECKING:
    from softkin._array import OrientationPrograms

_ROLES = (OffsetKinematics, OrientationKinematics, TwistChoice, IterativeForward)
"""The calls that only some mechanisms have."""
_classes: dict[type[Mechanism], type[Mechanism]] = {}


def in_radians(part: Mechanism) -> Mechanism:
    """The machine in radians, with the calls that it has."""
    cls = type(part)
    if cls not in _classes:
        roles = tuple(role for role in _ROLES if issubclass(cls, role))
        listed = tuple(map(_parameter, cls.PARAMETERS))
        own = {"__slots__": (), "__doc__": f"{cls.__name__} in radians.", "__module__": __name__, "PARAMETERS": listed}
        made_class = ABCMeta(f"{cls.__name__}InRadians", (InRadians, *roles), own)
        _classes[cls] = cast("type[Mechanism]", made_class)
    made: Any = _classes[cls]
    return made(part)  # type: ignore[no-any-return]


def _parameter(given: Parameter) -> Parameter:
    if given.unit != "deg":
        return given
    default = None if given.default is None else given.default * DEGREE
    return replace(given, unit="rad", low=given.low * DEGREE, high=given.high * DEGREE, default=default)


class InRadians(Around):
    """A machine with radians for degrees: its axes, references, offsets and limits, and what `diagnose` says.

    `part` is the machine in degrees. Its calls are those of `part`. A pitch stays per turn, a gear per degree.
    """

    __slots__ = ("__dict__", "_angles", "part")

    PARAMETERS = ()
    part: Mechanism
    _angles: tuple[bool, ...]
    """Whether each axis is in degrees in `part`."""

    def __init__(self, part: Mechanism) -> None:
        """part: the machine in degrees."""
        angles = {p.name for p in part.PARAMETERS if p.unit == "deg"}
        found = {name: v * DEGREE if name in angles else v for name, v in part.parameters.items()}
        self._surround(part, {
            "NAME": part.NAME, "ROLE": part.ROLE, "AXES": tuple(_axis(axis) for axis in part.AXES), "part": part,
            "parameters": MappingProxyType(found), "_angles": tuple(axis.unit == "deg" for axis in part.AXES),
        })  # fmt: skip
        self._seal()

    def in_degrees(self) -> Any:
        """The machine in degrees."""
        return self.part

    def in_radians(self) -> Any:
        """This machine."""
        return self

    def __repr__(self) -> str:
        """The call that makes this mechanism."""
        return f"{self.part!r}.in_radians()"

    def __reduce__(self) -> tuple[Any, ...]:
        """Copying and pickling convert the machine in degrees again."""
        return in_radians, (self.part,)

    def __hash__(self) -> int:
        """A hash by value."""
        return hash((type(self), self.part))

    __eq__ = Mechanism.__eq__

    def changed(self, **parameters: Any) -> Any:
        """The same machine with other values for some parameters, in radians."""
        units = self.part._parameter_units()
        given = {name: value * RADIAN if units.get(name) == "deg" else value for name, value in parameters.items()}
        if given.get("limits"):
            given["limits"] = {name: self._limit_in_degrees(name, ends) for name, ends in given["limits"].items()}
        return self.part.changed(**given).in_radians()

    def _limit_in_degrees(self, name: str, ends: Any) -> Any:
        if ends is None or name not in self.limits or not self._limit_is_angle(name):
            return ends
        return tuple(None if end is None else end * RADIAN for end in ends)

    def _limit_is_angle(self, name: str) -> bool:
        units = {axis.name: axis.unit for axis in self.part.AXES}
        return units.get(name, self.part._parameter_units().get(f"lower_{name}")) == "deg"

    @property
    def limits(self) -> dict[str, Any]:
        """The limits that are given, in radians and lengths: see `Mechanism.limits`."""
        found: dict[str, Any] = {}
        for name, ends in self.part.limits.items():
            is_angle = ends is not None and self._limit_is_angle(name)
            found[name] = tuple(None if e is None else e * DEGREE for e in ends) if is_angle and ends else ends
        return found

    def to_dict(self) -> dict[str, Any]:
        """The machine in degrees as plain data, with the mark `in_radians`."""
        return {**self.part.to_dict(), "in_radians": True}

    def misses(self, axes: Numbers) -> dict[str, float]:
        """The misses of surplus rods, which are lengths."""
        return self.part.misses(self._deg(reals(axes, len(self.AXES), "axes")))

    def _rad(self, axes: Reals) -> Reals:
        return tuple([a * DEGREE if is_angle else a for a, is_angle in zip(axes, self._angles, strict=True)])

    def _deg(self, axes: Reals) -> Reals:
        return tuple([a * RADIAN if is_angle else a for a, is_angle in zip(axes, self._angles, strict=True)])

    def _answer(self, found: Reals | Diagnosis) -> Reals | Diagnosis:
        return _said(found) if isinstance(found, Diagnosis) else self._rad(found)

    def _forward(self, axes: Reals) -> Pose | Status:
        return self.part._forward(self._deg(axes))

    def _every_pose(self, axes: Reals) -> EveryPose:
        return self.part._every_pose(self._deg(axes))

    def _orientation(self, axes: Reals) -> Rotation | Status:
        return self.part._orientation(self._deg(axes))

    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        return self._answer(self.part._branch(position, rotation, signs, turns, self._deg(reference)))

    def branches(self, frame: PlainFrame, reference: Reals | None = None) -> tuple[Reals | None, ...]:
        """Every branch for inner loops: see `Mechanism.branches`."""
        found = self.part.branches(frame, None if reference is None else self._deg(reference))
        return tuple([None if axes is None else self._rad(axes) for axes in found])

    def branch(self, frame: PlainFrame, signs: Signs, reference: Reals | None = None) -> Reals | None:
        """One branch for inner loops: see `Mechanism.branch`."""
        found = self.part.branch(frame, signs, None if reference is None else self._deg(reference))
        return None if found is None else self._rad(found)

    def _every_branch(self, position: Vector, rotation: Rotation, reference: Reals) -> tuple[Reals | int, ...]:
        found = self.part._every_branch(position, rotation, self._deg(reference))
        return tuple([axes if isinstance(axes, int) else self._rad(axes) for axes in found])

    def inverse_all(self, frame: FrameLike, reference: Numbers | None = None) -> Sequence[Solution]:
        """Every branch of the inverse, in fixed slots: see the same call of `part`."""
        if self.part._has_one_solution_a_branch():
            return super().inverse_all(frame, reference)
        near = None if reference is None else self._deg(reals(reference, len(self.AXES), "reference"))
        return tuple(self._solution_in_radians(s) for s in self.part.inverse_all(frame, near))

    def _solution_in_radians(self, found: Solution) -> Solution:
        axes = None if found.axes is None else self._rad(found.axes)
        refusal = None if found.refusal is None else _said(found.refusal)
        others = tuple(self._rad(other) for other in found.others)
        return found._replace(axes=axes, others=others, refusal=refusal)

    def _every_solution(
        self, position: Vector, rotation: Rotation, reference: Reals
    ) -> Iterable[tuple[Signs, Reals | Diagnosis]]:
        for signs, found in self.part._every_solution(position, rotation, self._deg(reference)):
            yield signs, self._answer(found)

    def _has_one_solution_a_branch(self) -> bool:
        return self.part._has_one_solution_a_branch()

    def _limits(self, axes: Reals) -> Diagnosis | None:
        refused = self.part._limits(self._deg(axes))
        return None if refused is None else _said(refused)

    def _ranges(self) -> tuple[tuple[float, float], ...]:
        """The ranges in radians; a wide one stays as wide."""
        found = self.part._ranges()
        is_angle = (*self._angles, *self._are_angles())
        return tuple(
            (a * DEGREE, b * DEGREE) if turns else (a, b) for (a, b), turns in zip(found, is_angle, strict=True)
        )

    def _are_angles(self) -> tuple[bool, ...]:
        """Which of the quantities beside the axes are angles."""
        names = list(self.part.limits)[len(self.AXES) :]
        return tuple(map(self._limit_is_angle, names))

    def _quantities(self, axes: Reals) -> Reals | Status:
        found = self.part._quantities(self._deg(axes))
        if isinstance(found, Status):
            return found
        return tuple(v * DEGREE if turns else v for v, turns in zip(found, self._are_angles(), strict=True))

    def _full_turn(self) -> float:
        return 360.0 * DEGREE

    def _singularity(self, axes: Reals) -> Reals | Status:
        return self.part._singularity(self._deg(axes))

    def _jacobian(self, axes: Reals) -> Matrix | Status:
        return self.part._jacobian(self._deg(axes))

    def _twist(self, axes: Reals) -> Matrix | Status:
        return self.part._twist(self._deg(axes))

    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        return self.part._bias(self._deg(axes), speeds)

    def _twist_bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        return self.part._twist_bias(self._deg(axes), speeds)

    def _turns_unseen(self) -> bool:
        return self.part._turns_unseen()

    def _nearest_flange(self, rotation: Rotation) -> Rotation | Status:
        return self.part._nearest_flange(rotation)

    def _parameter_units(self) -> dict[str, str]:
        return {name: "rad" if unit == "deg" else unit for name, unit in self.part._parameter_units().items()}

    def _written(self, margins: Reals, axes: Reals) -> Configuration:
        return self.part._written(margins, self._deg(axes))

    def _turn_sizes(self) -> Reals:
        return tuple([RADIAN * size for size in self.part._turn_sizes()])

    def _periods(self, axes: Reals) -> Configuration:
        return self.part._periods(self._deg(axes))

    @property
    def _criteria(self) -> tuple[Criterion, ...]:
        return tuple(
            c._replace(tie=c.tie * DEGREE**2) if any(self._angles[i] for i in c.axes) else c
            for c in self.part._criteria
        )

    def _offset_branch(
        self, point: Vector, offset: Vector, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        part: Any = self.part
        return self._answer(part._offset_branch(point, offset, signs, turns, self._deg(reference)))

    def _offset_margins(self, axes: Reals, offset: Vector) -> Reals | Status:
        part: Any = self.part
        return part._offset_margins(self._deg(axes), offset)  # type: ignore[no-any-return]

    def _projection(self, rotation: Rotation) -> Rotation | Status:
        part: Any = self.part
        return part._projection(rotation)  # type: ignore[no-any-return]

    def _started(self, position: Vector, rotation: Rotation) -> Self:
        return type(self)(self.part._started(position, rotation))

    def _compatible(self, flange_axis: Vector) -> Status:
        part: Any = self.part
        return part._compatible(flange_axis)  # type: ignore[no-any-return]

    def _end_point_shift(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> Vector | Status:
        part: Any = self.part
        return part._end_point_shift(rotation, flange_axis, base_axis)  # type: ignore[no-any-return]

    def _total_image(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> TotalImage | Status:
        part: Any = self.part
        return part._total_image(rotation, flange_axis, base_axis)  # type: ignore[no-any-return]

    def _array_programs(self) -> OrientationPrograms:
        """The programs on arrays, which convert the angles."""
        from softkin._radians_array import RadianPrograms

        return RadianPrograms(self.part._array_programs(), self._angles)


def _axis(axis: Axis) -> Axis:
    return replace(axis, unit="rad") if axis.unit == "deg" else axis


def _said(refused: Diagnosis) -> Diagnosis:
    """A reason whose amount is in radians."""
    text, unit = split_unit(refused.reason)
    return refused._replace(reason=f"{text} [rad]", missing=refused.missing * DEGREE) if unit == "deg" else refused
