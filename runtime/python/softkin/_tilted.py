"""The axis values at which the tool is along the normal of a plane, where the turning axes alone move."""

from __future__ import annotations

from softkin._configuration import AUTOMATIC, slots
from softkin._core import DIRECTION, Mechanism
from softkin._types import Diagnosis, FrameLike, KinematicsError, Numbers, Reals, Solution, Status

_ALONG = 1e-9
"""The sine of the angle between the tool and the normal is at most this."""


def tilted_plane(robot: Mechanism, plane: FrameLike, reference: Numbers) -> tuple[Solution, ...]:
    """See `Mechanism.tilted_plane`."""
    near = robot._near(reference)
    rotation = robot._used("tilted_plane", robot._pose(plane)[1])
    if robot._follows() != DIRECTION:
        raise _refused(robot, "its task is not the direction of a tool")
    position = robot.forward(near)[0].position
    turns, found = (0,) * len(robot.PERIOD_AXES), []
    for slot in slots((AUTOMATIC,) * robot.BRANCHES):
        axes = robot._branch(position, rotation, slot[1], turns, near)
        if not isinstance(axes, Diagnosis):
            axes = tuple([a if axis.kind != "linear" else r for axis, a, r in zip(robot.AXES, axes, near, strict=True)])
            if not _is_along(robot.orientation(axes), rotation):
                raise _refused(robot, "its sliding axes turn the tool, too")
            axes = robot._beyond_limits(axes) or axes
        found.append(robot._solution(slot, axes))
    return tuple(found)


def _is_along(rotation: tuple[Reals, ...], plane: tuple[Reals, ...]) -> bool:
    return all(abs(own[2] - wanted[2]) <= _ALONG for own, wanted in zip(rotation, plane, strict=True))


def _refused(robot: Mechanism, why: str) -> KinematicsError:
    message = f"{robot.NAME}.tilted_plane: {why}: ask inverse_all for the axes at a frame"
    return KinematicsError(Status.IMPOSSIBLE, message)
