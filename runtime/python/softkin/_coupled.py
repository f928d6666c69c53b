"""A position kinematics coupled with an orientation kinematics, as one mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, TypeAlias, TypeVar

from softkin._answer import answer, refusing
from softkin._configuration import Criterion
from softkin._constants import TIE
from softkin._core import SEVERAL_AXES, TURN, TWIST, EveryPose, Image, Mechanism, Pose
from softkin._ends import Ends
from softkin._orientation import OrientationKinematics, turning_axis
from softkin._twist import TwistChoice
from softkin._types import (
    Axis,
    Configuration,
    ConfigurationByte,
    ConfigurationLike,
    Diagnosis,
    KinematicsError,
    Matrix,
    Reals,
    Rotation,
    Signs,
    Status,
    Turns,
    Vector,
)
from softkin._vectors import moved, on_flange, plus, product, rates, seen_from, transposed, turned

if TYPE_CHECKING:
    from softkin._array import Programs
    from softkin._chain import Link

_Choice: TypeAlias = tuple[Signs, Turns, Reals]
"""Signs of the branches, turns and reference of one part."""
_Named = TypeVar("_Named", Axis, ConfigurationByte)
_Found = TypeVar("_Found")
_ORIGIN: Vector = (0.0, 0.0, 0.0)


class Coupled(Mechanism):
    """A position kinematics with an orientation kinematics at its flange.

    Axes: those of the position kinematics, then those of the orientation kinematics; the bytes of the configuration
    likewise. An axis or a byte of the second part with a name that the first part has is called `orientation <name>`.
    An automatic choice counts the rotary axes of both; if they tie, and only linear axes distinguish the branches of
    the position kinematics, it counts these.
    The position is reached or refused; of the rotation, the tool direction comes before the twist.
    Limits and parameters are those of the parts, `position_part` and `orientation_part`. The Jacobian has all six rows.
    """

    NAME = "Coupled"
    PARAMETERS = ()
    JACOBIAN_ROWS = TWIST
    ROLE = "complete"

    def __init__(self, position: Mechanism, orientation: OrientationKinematics) -> None:
        """Couple two mechanisms.

        Raises INVALID_COUPLING for any other pair, and where a commanded frame does not determine the axes: where the
        position axes turn the flange, the end point on the flange must not depend on these axes.
        """
        _check(position, orientation)
        self.NAME = f"Coupled({position.NAME}, {orientation.NAME})"
        self.position_part, self.orientation_part = position, orientation
        self.parameters = MappingProxyType({})
        self.checks_limits = position.checks_limits or orientation.checks_limits
        carrying = position.orientation_image()
        self._axis = turning_axis(carrying)
        self._flange = carrying.rotation if carrying.freedom == "zero" else None
        self._tool = _tool_of(orientation) if _commands_the_flange(position, orientation) else None
        total = orientation.image_on(carrying)
        self.FREEDOM = total.freedom
        self._orientations: Image = total.rotation, total.base_axis, total.flange_axis
        self._describe(position, orientation)
        self._seal()

    def _describe(self, first: Mechanism, second: Mechanism) -> None:
        """Set the axes, the bytes and the margins of both parts."""
        self._count = count = len(first.AXES)
        self.AXES = first.AXES + _distinct(second.AXES, first.AXES)
        self.CONFIGURATION = first.CONFIGURATION + _distinct(second.CONFIGURATION, first.CONFIGURATION)
        self.DEFAULT_CONFIGURATION = first.DEFAULT_CONFIGURATION + second.DEFAULT_CONFIGURATION
        taken = first.MARGINS
        self.MARGINS = taken + tuple(f"orientation_{m}" if m in taken else m for m in second.MARGINS)
        self.READS_ROTATION = first.READS_ROTATION or second.READS_ROTATION
        self.BRANCHES = first.BRANCHES + second.BRANCHES
        self.HELD = first.HELD + tuple(count + i for i in second.HELD)
        self.PERIOD_AXES = first.PERIOD_AXES + tuple(count + i for i in second.PERIOD_AXES)
        angles = tuple(i for i, axis in enumerate(self.AXES) if axis.unit != "u")
        seen = set(first.DISTANCE_AXES) & set(angles) or not first.BRANCHES
        self.DISTANCE_AXES = angles if seen and angles else (*first.DISTANCE_AXES, *angles)
        rotary = (Criterion(angles, TIE * (first._full_turn() / 360.0) ** 2),) if angles else ()
        self._nearest_by = rotary if seen and angles else (*rotary, *first._criteria)

    @property
    def _criteria(self) -> tuple[Criterion, ...]:
        return self._nearest_by

    def __repr__(self) -> str:
        """The call that makes this mechanism."""
        return f"Coupled({self.position_part!r}, {self.orientation_part!r})"

    def _keywords(self) -> dict[str, Any]:
        return {"position": self.position_part, "orientation": self.orientation_part}

    def __hash__(self) -> int:
        """A hash by value."""
        return hash((type(self), self.position_part, self.orientation_part))

    __eq__ = Mechanism.__eq__

    @property
    def limits(self) -> dict[str, Ends | None]:
        """The limits of both parts: those of the axes, then those of other quantities."""
        first, second = self.position_part, self.orientation_part
        own = {
            axis.name: second.limits[name.name]
            for axis, name in zip(self.AXES[self._count :], second.AXES, strict=True)
        }
        return {axis.name: first.limits[axis.name] for axis in first.AXES} | own | first.limits

    def changed(self, **parameters: Any) -> Self:
        """A coupling of this kind with other parts: `position=` and `orientation=`."""
        made: Self = super().changed(**parameters)
        return made

    def in_degrees(self) -> Self:
        """The same coupling of the parts in degrees."""
        first, second = self.position_part.in_degrees(), self.orientation_part.in_degrees()
        return self if first is self.position_part else type(self)(first, second)

    def in_radians(self) -> Self:
        """The same coupling in radians: see `Mechanism.in_radians`."""
        return super().in_radians() if self.in_degrees() is self else self

    def _full_turn(self) -> float:
        return self.position_part._full_turn()

    def _chain(self) -> tuple[Link, ...] | None:
        first, second = self.position_part._chain(), self.orientation_part._chain()
        if first is None or second is None:
            return None
        return (*first, *(k._replace(motors=tuple((i + self._count, share) for i, share in k.motors)) for k in second))

    def _axis_zeros(self) -> Reals:
        return self.position_part._axis_zeros() + self.orientation_part._axis_zeros()

    def to_dict(self) -> dict[str, Any]:
        """Both parts as plain data."""
        parts = self.position_part.to_dict(), self.orientation_part.to_dict()
        return {"mechanism": "Coupled", "position": parts[0], "orientation": parts[1]}

    @classmethod
    def from_dict(cls, given: Mapping[str, Any]) -> Self:
        """The coupling of `to_dict`. Raises NOT_INITIALIZED for other data, INVALID_COUPLING for an impossible pair."""
        values = dict(given)
        is_radian = values.pop("in_radians", False)
        if values.pop("mechanism", "Coupled") != "Coupled" or set(values) != {"position", "orientation"}:
            raise KinematicsError(Status.NOT_INITIALIZED, "Coupled: the entries must be position and orientation")
        for part in ("position", "orientation"):
            if not isinstance(values[part], Mapping):
                raise KinematicsError(Status.NOT_INITIALIZED, f"Coupled: {part} must be the dictionary of a machine")
        position = Mechanism.from_dict(values["position"])
        orientation = OrientationKinematics.from_dict(values["orientation"])
        made = cls(position, orientation)
        return made.in_radians() if is_radian else made

    @property
    def _branch_bytes(self) -> list[int]:
        return [i for i, byte in enumerate(self.CONFIGURATION) if byte.kind == "branch"]

    @property
    def _period_bytes(self) -> list[int]:
        return [i for i, byte in enumerate(self.CONFIGURATION) if byte.kind == "period"]

    def _read(self, configuration: ConfigurationLike | None) -> tuple[Configuration, Turns]:
        """The branch bytes and the commanded turns of both parts."""
        found = self._bytes(configuration)
        return tuple(found[i] for i in self._branch_bytes), tuple(found[i] for i in self._period_bytes)

    def _joined(self, branches: Configuration, periods: Configuration) -> Configuration:
        first, turning = self.position_part.BRANCHES, len(self.position_part.PERIOD_AXES)
        return branches[:first] + periods[:turning] + branches[first:] + periods[turning:]

    def _turn_sizes(self) -> Reals:
        return self.position_part._turn_sizes() + self.orientation_part._turn_sizes()

    def _periods(self, axes: Reals) -> Configuration:
        return self.position_part._periods(axes[: self._count]) + self.orientation_part._periods(axes[self._count :])

    def _written(self, margins: Reals, axes: Reals) -> Configuration:
        """The configuration of a pose: the bytes of the first part, then those of the second."""
        first, second, cut = self.position_part, self.orientation_part, self.position_part.BRANCHES
        carrier_bytes = first._written(margins[:cut], axes[: self._count])
        return carrier_bytes + second._written(margins[cut:], axes[self._count :])

    @refusing
    def _forward(self, axes: Reals) -> Pose | Status:
        carrier = answer(self.position_part._forward(axes[: self._count]))
        return _on(carrier, answer(self.orientation_part._forward(axes[self._count :])))

    def _every_pose(self, axes: Reals) -> EveryPose:
        carriers = self.position_part._every_pose(axes[: self._count])
        every = self.orientation_part._every_pose(axes[self._count :])
        return tuple((_on(carrier, own), one or other) for carrier, one in carriers for own, other in every)

    @refusing
    def _orientation(self, axes: Reals) -> Rotation | Status:
        flange = answer(self.position_part._orientation(axes[: self._count]))
        return product(flange, answer(self.orientation_part._orientation(axes[self._count :])))

    @refusing
    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        """The axes of both parts: those that reach the position, and those that orient the tool on the flange."""
        first, second = self.position_part, self.orientation_part
        carrier, wrist = self._split(signs, turns, reference)
        if self._flange is not None:  # it keeps its orientation: first the orientation axes, then the position axes
            own = self._of(second, second._branch(_ORIGIN, seen_from(self._flange, rotation), *wrist))
            shift = turned(self._flange, self._of(second, second._forward(own))[0])
            return self._of(first, first._branch(plus(position, shift, -1.0), rotation, *carrier)) + own
        if self._tool is not None:  # the commanded rotation determines how the position axes turn the flange
            wanted = product(rotation, transposed(self._tool[1]))
            flange = first._nearest_flange(wanted)
            shift = _ORIGIN if isinstance(flange, Status) else turned(flange, self._tool[0])  # refused below
            return self._of(first, first._branch(plus(position, shift, -1.0), wanted, *carrier))
        shift = self._of(second, second._end_point_shift(rotation, *self._axis))
        axes = self._of(first, first._branch(plus(position, shift, -1.0), rotation, *carrier))
        flange = self._of(second, first._orientation(axes))
        return axes + self._of(second, second._branch(_ORIGIN, seen_from(flange, rotation), *wrist))

    def _of(self, part: Mechanism, found: _Found | Diagnosis | Status) -> _Found:
        """What a part answers; a reason has the name of the part that refuses."""
        if isinstance(found, Status):
            return answer(Diagnosis(found, f"{self.orientation_part.NAME}: its end point", 0.0))
        return answer(_named(part, found) if isinstance(found, Diagnosis) else found)

    def _split(self, signs: Signs, turns: Turns, reference: Reals) -> tuple[_Choice, _Choice]:
        """The signs, the turns and the reference of each part."""
        first, cut = self.position_part, len(self.position_part.PERIOD_AXES)
        carrier = signs[: first.BRANCHES], turns[:cut], reference[: self._count]
        return carrier, (signs[first.BRANCHES :], turns[cut:], reference[self._count :])

    def _follows(self) -> str:
        """The orientation part follows the rotation; without axes it is a tool on the flange of the position part."""
        position, orientation = self.position_part, self.orientation_part
        if self.FREEDOM == "zero" or not orientation.AXES:
            return position._follows()
        follows = orientation._follows()
        return SEVERAL_AXES if follows == TURN and self.FREEDOM == "three" else follows

    @refusing
    def _nearest_flange(self, rotation: Rotation) -> Rotation | Status:
        """The nearest rotation of the tool, where the commanded rotation determines the turn of the flange."""
        if self._tool is not None:
            _, turn = self._tool
            return product(answer(self.position_part._nearest_flange(product(rotation, transposed(turn)))), turn)
        at_zero = self.position_part.orientation_image().rotation
        return product(at_zero, answer(self.orientation_part._nearest_flange(seen_from(at_zero, rotation))))

    def _limits(self, axes: Reals) -> Diagnosis | None:
        parts = (self.position_part, axes[: self._count]), (self.orientation_part, axes[self._count :])
        for part, own in parts:
            refused = part._beyond_limits(own)
            if refused is not None:
                return _named(part, refused)
        return None

    def _parameter_units(self) -> dict[str, str]:
        return self.orientation_part._parameter_units() | self.position_part._parameter_units()

    def _ranges(self) -> tuple[tuple[float, float], ...]:
        """The ranges of all axes, then of all other quantities."""
        first, second = self.position_part._ranges(), self.orientation_part._ranges()
        cut, count = self._count, len(self.orientation_part.AXES)
        return first[:cut] + second[:count] + first[cut:] + second[count:]

    @refusing
    def _quantities(self, axes: Reals) -> Reals | Status:
        first = answer(self.position_part._quantities(axes[: self._count]))
        return first + answer(self.orientation_part._quantities(axes[self._count :]))

    def _has_one_solution_a_branch(self) -> bool:
        return self.position_part._has_one_solution_a_branch() and self.orientation_part._has_one_solution_a_branch()

    @refusing
    def _singularity(self, axes: Reals) -> Reals | Status:
        carrier = answer(self.position_part._singularity(axes[: self._count]))
        return carrier + answer(self.orientation_part._singularity(axes[self._count :]))

    @refusing
    def _jacobian(self, axes: Reals) -> Matrix | Status:
        """The Jacobian: the flange moves the end point as a rigid body, and the orientation axes move it relatively."""
        first, second = axes[: self._count], axes[self._count :]
        carrier, own = answer(self.position_part._twist(first)), answer(self.orientation_part._twist(second))
        flange, end = answer(self.position_part._orientation(first)), answer(self.orientation_part._forward(second))
        arm = turned(flange, end[0])
        columns = [moved(column, arm) for column in zip(*carrier, strict=True)]
        columns += [(*turned(flange, c[:3]), *turned(flange, c[3:])) for c in zip(*own, strict=True)]
        return tuple(zip(*columns, strict=True)) if columns else ((),) * len(TWIST)

    @refusing
    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        """The acceleration of the end point at constant speeds of the axes: that of the flange, and that on it."""
        first, second = axes[: self._count], axes[self._count :]
        own_speeds = speeds[self._count :]
        carrier, own = answer(self.position_part._twist(first)), answer(self.orientation_part._twist(second))
        flange, end = answer(self.position_part._orientation(first)), answer(self.orientation_part._forward(second))
        carried = answer(self.position_part._twist_bias(first, speeds[: self._count]))
        inner = answer(self.orientation_part._twist_bias(second, own_speeds))
        return on_flange(carried, rates(carrier[3:], speeds[: self._count]), flange, end[0], (own, own_speeds, inner))

    def _image(self) -> Image | Status:
        return self._orientations

    def _array_programs(self) -> Programs:
        """The programs on arrays, which run those of both parts one after the other."""
        from softkin._array_coupled import CoupledPrograms

        return CoupledPrograms(self.position_part, self.orientation_part, self._flange, self._axis, self._tool)


def _check(position: Mechanism, orientation: Mechanism) -> None:
    """Refuse any other pair, and a pair whose axes a commanded frame does not determine."""
    for place, part, role in (("first", position, "position"), ("second", orientation, "orientation")):
        found = part.ROLE if isinstance(part, Mechanism) else None
        if found != role:
            name = f"{part.NAME} is {_a(found)} kinematics" if found else f"{part!r} is no mechanism"
            raise _refused(f"the {place} part must be {_a(role)} kinematics, but {name}")
    assert isinstance(orientation, OrientationKinematics)
    if position._full_turn() != orientation._full_turn():
        raise _refused(f"{position!r} and {orientation!r} must have the same unit of angles")
    if isinstance(position, TwistChoice) and orientation.AXES:
        raise _refused(f"{position.NAME} follows the turn of the tool itself: {orientation.NAME} may have no axes")
    image = position.orientation_image()
    if not _commands_the_flange(position, orientation) and not orientation.is_compatible(image):
        how = "about one axis" if image.freedom == "one" else "freely"
        raise _refused(
            f"the axes of {position.NAME} turn its flange {how}, and a commanded frame does not determine where "
            f"{orientation!r} then has its end point: only shifts along the axis of that turn, and those whose "
            "direction the commanded rotation tells, may be there; all others must be 0"
        )


def _commands_the_flange(position: Mechanism, orientation: OrientationKinematics) -> bool:
    """Whether the commanded rotation determines how the position axes turn the flange: then any tool is allowed."""
    return position._follows() == TURN and not orientation.AXES


def _tool_of(orientation: OrientationKinematics) -> tuple[Vector, Rotation]:
    """Position and rotation of an orientation kinematics without axes."""
    pose = orientation._forward(())
    if isinstance(pose, Status):
        raise _refused(f"{orientation.NAME} has no end point: {pose.meaning}")
    position, rotation, _ = pose
    return position, rotation


def _a(role: str) -> str:
    """A role with its article."""
    return f"{'an' if role[0] in 'aeiou' else 'a'} {role}"


def _on(carrier: Pose, own: Pose) -> Pose:
    """The pose at the flange of another one."""
    position, flange, margins = carrier
    return plus(position, turned(flange, own[0])), product(flange, own[1]), margins + own[2]


def _named(part: Mechanism, refused: Diagnosis) -> Diagnosis:
    """The reason with the name of the part that refuses."""
    return refused._replace(reason=f"{part.NAME}: {refused.reason}")


def _refused(message: str) -> KinematicsError:
    return KinematicsError(Status.INVALID_COUPLING, f"Coupled: {message}")


def _distinct(own: tuple[_Named, ...], others: tuple[_Named, ...]) -> tuple[_Named, ...]:
    """The axes or bytes of the second part, with names that the first part does not have."""
    taken = {other.name for other in others}
    return tuple(replace(one, name=f"orientation {one.name}") if one.name in taken else one for one in own)
