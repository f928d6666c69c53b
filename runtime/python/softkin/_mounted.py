"""A machine on a base, with a tool at its flange.

Its inverse commands the flange of the bare machine: `_tools` says which tools it can carry.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import hypot, nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, cast

from softkin._answer import answer, refusing
from softkin._around import Around
from softkin._configuration import AUTOMATIC, slots
from softkin._constants import EXACT
from softkin._core import PITCH, TURN, TWIST, EveryPose, Image, Mechanism, Pose
from softkin._frame import IDENTITY, ORIGIN, Frame
from softkin._scalar import reasonable
from softkin._search import SearchedInverse
from softkin._start import IterativeForward
from softkin._tools import check_tool, known_shift, rows_by_name, rows_of
from softkin._types import (
    Diagnosis,
    FrameLike,
    KinematicsError,
    Matrix,
    Numbers,
    Reals,
    Rotation,
    Signs,
    Solution,
    Status,
    Turns,
    Vector,
)
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
    from softkin._array import Programs, StartedPrograms

PASSES = 50
"""The passes of the iteration for a flange that follows the pitch; each one takes the rotation of the flange from the
pass before."""
MET = EXACT
"""The position is met where it is missed by at most this share of the distances in the sum."""
PLAIN = Frame(ORIGIN)
NOWHERE: Vector = (nan, nan, nan)
NOT_MET = "no rotation of the flange meets the position with this tool"


class Mounted(Around):
    """A machine on a base, with a tool at its flange: what `Mechanism.with_base` and `Mechanism.with_tool` return.

    It has the axes, the configuration, the limits and the singularities of the bare machine. Its frames are those of
    the tool, in the coordinates in which the base is given. A rotation that the flange cannot take is projected as the
    bare machine does; the position of the tool is met or refused.
    The Jacobian has the rows of the bare machine, unless the base or the tool turns these into others: then all six.
    Parameters, `project` and the offset interface are those of the bare machine: `bare.parameters`, `bare.project`.
    """

    NAME = "Mounted"
    PARAMETERS = ()

    bare: Mechanism
    """The machine without base and tool."""
    base: Frame
    tool: Frame

    def __init__(self, bare: Mechanism, base: Frame, tool: Frame) -> None:
        """Mount a machine: see `mounted`. base, tool: with rotations that are exact to all digits."""
        own = "" if base == PLAIN else " on a base"
        own += "" if tool == PLAIN else " with a tool"
        self._surround(bare, {
            "NAME": bare.NAME + own, "JACOBIAN_ROWS": rows_of(bare, base, tool), "parameters": MappingProxyType({}),
            "bare": bare, "base": base, "tool": tool,
            "_kind": bare._follows(), "_shift": known_shift(bare, tool.position),
        })  # fmt: skip
        self._seal()

    def __repr__(self) -> str:
        """The calls that make this mechanism."""
        base = "" if self.base == PLAIN else f".with_base({self.base!r})"
        return f"{self.bare!r}{base}" + ("" if self.tool == PLAIN else f".with_tool({self.tool!r})")

    def __hash__(self) -> int:
        """The hash of machine, base and tool."""
        return hash((self.bare, self.base, self.tool))

    __eq__ = Mechanism.__eq__

    def __reduce__(self) -> tuple[Callable[..., Mechanism], tuple[Mechanism, Frame, Frame]]:
        """Copying and pickling mount the machine again."""
        return mounted, (self.bare, self.base, self.tool)

    def changed(self, **parameters: Any) -> Self:
        """A copy with other parameters of the bare machine, or with another `base=` or `tool=`."""
        base, tool = parameters.pop("base", self.base), parameters.pop("tool", self.tool)
        return cast("Self", mounted(self.bare.changed(**parameters), base, tool))

    def to_dict(self) -> dict[str, Any]:
        """The bare machine, the base and the tool as plain data."""
        return {
            "mechanism": "Mounted",
            "bare": self.bare.to_dict(),
            "base": _plain(self.base),
            "tool": _plain(self.tool),
        }

    @classmethod
    def from_dict(cls, given: Mapping[str, Any]) -> Self:
        """The machine of `to_dict`; a base or a tool that is missing is none.

        Raises NOT_INITIALIZED for other data, BAD_INPUT for what is no frame, INVALID_COUPLING for an impossible tool.
        """
        values = dict(given)
        is_radian = values.pop("in_radians", False)
        is_known = values.pop("mechanism", "Mounted") == "Mounted" and set(values) <= {"bare", "base", "tool"}
        if not (is_known and isinstance(values.get("bare"), Mapping)):
            raise KinematicsError(Status.NOT_INITIALIZED, "Mounted: the entries must be bare, base and tool")
        bare = Mechanism.from_dict(values["bare"])
        made = mounted(bare, _frame(values.get("base", PLAIN)), _frame(values.get("tool", PLAIN)))
        return cast("Self", made.in_radians() if is_radian else made)

    @property
    def deviations(self) -> Mapping[str, float]:
        """The deviations of the bare machine: those of base and tool stand behind its base and in front of its tool."""
        return self.bare.deviations

    def _has_one_solution_a_branch(self) -> bool:
        return self.bare._has_one_solution_a_branch()

    def _singularity(self, axes: Reals) -> Reals | Status:
        return self.bare._singularity(axes)

    def _follows(self) -> str:
        return self._kind

    def _forward(self, axes: Reals) -> Pose | Status:
        return self._of_flange(self.bare._forward(axes))

    def _every_pose(self, axes: Reals) -> EveryPose:
        found = [(self._of_flange(pose), is_other) for pose, is_other in self.bare._every_pose(axes)]
        return tuple((pose, is_other) for pose, is_other in found if not isinstance(pose, Status))

    def _of_flange(self, pose: Pose | Status) -> Pose | Status:
        """The pose of the tool, by that of the flange."""
        if isinstance(pose, Status):
            return pose
        position, rotation, margins = pose
        base, tool = self.base, self.tool
        place = plus(position, turned(rotation, tool.position))
        turn = product(base.rotation, product(rotation, tool.rotation))
        return plus(base.position, turned(base.rotation, place)), turn, margins

    @refusing
    def _orientation(self, axes: Reals) -> Rotation | Status:
        return product(self.base.rotation, product(answer(self.bare._orientation(axes)), self.tool.rotation))

    def _seen_from_base(self, position: Vector, rotation: Rotation) -> tuple[Vector, Rotation]:
        """The position of the tool and the rotation of the flange, in the frame of the bare machine.

        A position that is NaN or too large is not changed by the base, so that it is refused.
        """
        place = NOWHERE
        if reasonable(*position):
            place = turned(transposed(self.base.rotation), plus(position, self.base.position, -1.0))
        if not self.READS_ROTATION:
            return place, IDENTITY
        return place, product(seen_from(self.base.rotation, rotation), transposed(self.tool.rotation))

    def _flange(self, place: Vector, rotation: Rotation) -> tuple[Vector, Rotation]:
        """The commanded frame of the flange, for the place of the tool; all in the frame of the bare machine."""
        if self._shift is not None:
            return plus(place, self._shift, -1.0), rotation
        nearest = self.bare._nearest_flange(rotation) if self._kind == TURN else rotation
        if isinstance(nearest, Status):
            return place, rotation  # the bare machine refuses the rotation and gives the reason
        return plus(place, turned(nearest, self.tool.position), -1.0), rotation

    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis:
        """The axes of the bare machine for the frame of the flange."""
        place, wanted = self._seen_from_base(position, rotation)
        at, wanted = self._flange(place, wanted)
        axes = self.bare._branch(at, wanted, signs, turns, reference)
        for _ in range(PASSES if self._kind == PITCH else 0):
            if isinstance(axes, Diagnosis):
                return axes
            pose = self.bare._forward(axes)
            if isinstance(pose, Status):
                return Diagnosis(pose, NOT_MET, 0.0)
            arm = turned(pose[1], self.tool.position)
            if hypot(*plus(place, plus(pose[0], arm), -1.0)) <= MET * (hypot(*place) + hypot(*arm)):
                return axes
            axes = self.bare._branch(plus(place, arm, -1.0), wanted, signs, turns, reference)
        return Diagnosis(Status.UNREACHABLE, NOT_MET, 0.0) if self._kind == PITCH else axes

    def _every_branch(self, position: Vector, rotation: Rotation, reference: Reals) -> tuple[Reals | int, ...]:
        if self._kind == PITCH:
            return super()._every_branch(position, rotation, reference)
        return self.bare._every_branch(*self._flange(*self._seen_from_base(position, rotation)), reference)

    def _every_solution(
        self, position: Vector, rotation: Rotation, reference: Reals
    ) -> Iterable[tuple[Signs, Reals | Diagnosis]]:
        if self._kind == PITCH:
            return super()._every_solution(position, rotation, reference)
        return self.bare._every_solution(*self._flange(*self._seen_from_base(position, rotation)), reference)

    def inverse_all(self, frame: FrameLike, reference: Numbers | None = None) -> Sequence[Solution]:
        """Every branch of the inverse, in fixed slots: see `inverse_all` of the bare machine."""
        if not isinstance(self.bare, SearchedInverse):
            return super().inverse_all(frame, reference)
        position, rows = self._pose(frame)
        near, rotation = self._near(reference), self._made(rows)
        if isinstance(rotation, Diagnosis):
            return tuple(self._solution(slot, rotation) for slot in slots((AUTOMATIC,) * self.BRANCHES))
        return self.bare.inverse_all(self._flange(*self._seen_from_base(position, rotation)), near)

    @refusing
    def _jacobian(self, axes: Reals) -> Matrix | Status:
        """The rows of the tool's twist; the rows about axes of the wrist are those of the bare machine."""
        own, rotation = answer(self._twist(axes)), answer(self._orientation(axes))
        bare = zip(self.bare.JACOBIAN_ROWS, answer(self.bare._jacobian(axes)), strict=True)
        return rows_by_name(self.JACOBIAN_ROWS, own, rotation, bare)

    @refusing
    def _twist(self, axes: Reals) -> Matrix | Status:
        rows, flange = answer(self.bare._twist(axes)), answer(self.bare._orientation(axes))
        arm, base = turned(flange, self.tool.position), self.base.rotation
        columns = [moved(column, arm) for column in zip(*rows, strict=True)]
        columns = [(*turned(base, c[:3]), *turned(base, c[3:])) for c in columns]
        return tuple(zip(*columns, strict=True)) if columns else ((),) * len(TWIST)

    @refusing
    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        """As `_jacobian`: the axes of the tool turn with it, so that they change no turn about them."""
        own, rotation = answer(self._twist_bias(axes, speeds)), answer(self._orientation(axes))
        bare = zip(self.bare.JACOBIAN_ROWS, answer(self.bare._bias(axes, speeds)), strict=True)
        return rows_by_name(self.JACOBIAN_ROWS, own, rotation, bare)

    @refusing
    def _twist_bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        rows, flange = answer(self.bare._twist(axes)), answer(self.bare._orientation(axes))
        arm = turned(flange, self.tool.position)
        moving = at_end(answer(self.bare._twist_bias(axes, speeds)), rates(rows[3:], speeds), arm)
        return turned_twist(self.base.rotation, moving)

    @refusing
    def _image(self) -> Image | Status:
        rotation, base_axis, flange_axis = answer(self.bare._image())
        total = product(self.base.rotation, product(rotation, self.tool.rotation))
        return total, turned(self.base.rotation, base_axis), turned(transposed(self.tool.rotation), flange_axis)

    def _array_programs(self) -> Programs:
        """The programs on arrays, which run those of the bare machine."""
        from softkin._array_mounted import MountedPrograms

        return MountedPrograms(self, self.bare._array_programs(), self._kind, self._shift)

    _kind: str
    _shift: Vector | None
    """The vector from the flange to the tool in the frame of the bare machine, where it is the same for all frames."""


class StartedMounted(Mounted, IterativeForward):
    """A mounted machine whose forward kinematics iterates."""

    PARAMETERS = ()

    def _started(self, position: Vector, rotation: Rotation) -> Self:
        start = self.base.inverse() @ (position, rotation) @ self.tool.inverse()
        return type(self)(self.bare._started(start.position, start.rotation), self.base, self.tool)

    def _array_programs(self) -> StartedPrograms:
        """The programs on arrays, which run those of the bare machine."""
        from softkin._array_mounted import StartedMountedPrograms

        assert isinstance(self.bare, IterativeForward)
        return StartedMountedPrograms(self, self.bare._array_programs(), self._kind, self._shift)


def mounted(robot: Mechanism, base: FrameLike = PLAIN, tool: FrameLike = PLAIN) -> Mounted:
    """The machine on a base and with a tool, beyond those that it has; refuses a tool that it cannot carry.

    A machine in radians is mounted in degrees: the result is in radians.
    """
    in_degrees = robot.in_degrees()
    if in_degrees is not robot:
        return in_degrees.with_base(base).with_tool(tool).in_radians()
    stand, carried = Frame.of(base), Frame.of(tool)
    if isinstance(robot, Mounted):
        stand, carried = stand @ robot.base, robot.tool @ carried
        robot = robot.bare
    check_tool(robot, carried)
    return (StartedMounted if isinstance(robot, IterativeForward) else Mounted)(robot, stand, carried)


def _plain(frame: Frame) -> dict[str, Any]:
    """A frame as plain data."""
    return {"position": list(frame.position), "rotation": [list(row) for row in frame.rotation]}


def _frame(given: Any) -> Frame:
    """The frame of plain data, or of any form that the calls take."""
    if not isinstance(given, Mapping):
        return Frame.of(given)
    if set(given) != {"position", "rotation"}:
        raise KinematicsError(Status.NOT_INITIALIZED, "Mounted: the entries of a frame must be position and rotation")
    return Frame.of((given["position"], given["rotation"]))
