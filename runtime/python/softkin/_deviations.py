"""The deviations of a machine from its drawing, by name: which there are, and their units."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import TYPE_CHECKING

from softkin._chain import joints_of
from softkin._input import suggestion
from softkin._types import KinematicsError, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

ENDS = ("tool", "base")
"""What has three shifts and three turns."""
_DIMENSIONS = ("length", "signed length", "distance", "angle")
"""The kinds of parameters whose deviations a closed loop has."""
_NO_DIMENSIONS = ("home_", "max_", "min_")
"""How the names of those begin that say where an iteration starts, and what is refused."""


def units_of(robot: Mechanism) -> dict[str, str]:
    """The unit of every deviation of a bare machine: `deg`, `u` (the user's length unit) or `1`."""
    links = robot._chain()
    found: dict[str, str] = {}
    if links is None:
        others = {f"{word}_{key}" for key in robot.LIMIT_KEYS for word in ("offset", "lower", "upper")}
        own = (p for p in robot.PARAMETERS if p.kind in _DIMENSIONS and p.name not in others)
        found |= {p.name: p.unit for p in own if not p.name.startswith(_NO_DIMENSIONS)}
    for joint in joints_of(links or (), robot.AXES):
        found |= {f"{joint.name}_tilt_x": "deg", f"{joint.name}_tilt_y": "deg"}
        found |= {f"{joint.name}_shift_x": "u", f"{joint.name}_shift_y": "u"} if joint.turns else {}
    for end in ENDS:
        found |= {f"{end}_{k}": "u" for k in "xyz"} | {f"{end}_{k}": "deg" for k in "abc"}
    found |= {f"{axis.name.lower()}_offset": axis.unit for axis in robot.AXES}
    return found | {f"{axis.name.lower()}_gain": "1" for axis in robot.AXES}


def are_inputs(robot: Mechanism) -> bool:
    """Whether a bare machine was derived with its deviations as inputs."""
    return robot._chain() is not None and units_of(robot).keys() <= {p.name for p in robot.PARAMETERS}


def checked(robot: Mechanism, given: Mapping[str, float]) -> dict[str, float]:
    """The deviations that are not zero, in the order of `units_of`.

    Raises NOT_INITIALIZED for an unknown name, with the one that was perhaps meant, and for what is no finite number.
    """
    if not isinstance(given, Mapping):
        raise _refused(robot, f"must be a mapping from names to numbers, not {given!r}")
    units = units_of(robot)
    for name, value in given.items():
        if name not in units:
            raise _refused(robot, f"have no {name!r}: {suggestion(str(name), units)}")
        if isinstance(value, bool) or not _is_number(value):
            raise _refused(robot, f"must be finite numbers, and {name} is {value!r}")
    return {name: float(given[name]) for name in units if given.get(name)}


def _is_number(value: object) -> bool:
    try:
        return isfinite(value)  # type: ignore[arg-type]
    except (TypeError, OverflowError):
        return False


def _refused(robot: Mechanism, message: str) -> KinematicsError:
    return KinematicsError(Status.NOT_INITIALIZED, f"{robot.NAME}: deviations {message}")
