"""Limits as one mapping: the ends of every axis, None if there is none."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, TypeAlias

from softkin._input import parameter_value
from softkin._types import KinematicsError, Parameter, Status

if TYPE_CHECKING:
    from softkin._types import Axis

Ends: TypeAlias = tuple[float | None, float | None]
"""Lower and upper limit in the unit of the axis; None for an end without a limit."""
Limits: TypeAlias = Mapping[str, Ends | None]
"""The ends by the name of the axis, or of another quantity that has limits; None for no limit at all."""
_LOWER, _UPPER = "lower_", "upper_"


def limit_names(keys: tuple[str, ...], axes: tuple[Axis, ...]) -> dict[str, str]:
    """The name in a mapping of limits → the last part of the names of its parameters.

    keys: these last parts, `LIMIT_KEYS` of a class.
    """
    if not keys:  # a coupling: its parts have the limits
        return {}
    return dict(zip((*(axis.name for axis in axes), *keys[len(axes) :]), keys, strict=True))


def given_ends(
    machine: str, names: Mapping[str, str], parameters: tuple[Parameter, ...], given: Any
) -> dict[str, float]:
    """The values of the parameters that a mapping of limits stands for: an end without a limit is infinite.

    names: those of `limit_names`. Raises NOT_INITIALIZED for an unknown name, which is told the known ones, and for
    ends that are no limits.
    """
    if not isinstance(given, Mapping):
        raise _refused(f"{machine}: limits must be a mapping from the names of axes to (lower, upper), not {given!r}")
    by_name = {p.name: p for p in parameters}
    found: dict[str, float] = {}
    for name, ends in given.items():
        if name not in names:
            known = ", ".join(names) or "none"
            raise _refused(f"{machine}: limits of {name!r} are unknown: there are limits of {known}")
        lower, upper = (None, None) if ends is None else _pair(machine, name, ends)
        low, high = (by_name[word + names[name]] for word in (_LOWER, _UPPER))
        least = -inf if lower is None else _end(machine, low, lower)
        most = inf if upper is None else _end(machine, high, upper)
        if not least < most:
            raise _refused(f"{machine}: the limits {ends!r} of {name} are not allowed: lower must be below upper")
        is_free = not (isfinite(least) or isfinite(most))
        found |= {low.name: 0.0, high.name: 0.0} if is_free else {low.name: least, high.name: most}
    return found


def ends_of(names: Mapping[str, str], values: Mapping[str, float]) -> dict[str, Ends | None]:
    """The limits in the values of parameters, by name. names: those of `limit_names`."""
    found: dict[str, Ends | None] = {}
    for name, key in names.items():
        lower, upper = values[_LOWER + key], values[_UPPER + key]
        ends = lower if isfinite(lower) else None, upper if isfinite(upper) else None
        found[name] = ends if abs(lower) + abs(upper) > 0.0 else None
    return found


def _pair(machine: str, name: str, ends: Any) -> tuple[Any, Any]:
    if isinstance(ends, str) or not isinstance(ends, Iterable) or isinstance(ends, Mapping | set | frozenset):
        raise _refused(f"{machine}: the limits of {name} must be a pair (lower, upper) or None, not {ends!r}")
    pair = tuple(ends)
    if len(pair) != 2:
        raise _refused(f"{machine}: the limits of {name} must be a pair (lower, upper) or None, not {ends!r}")
    return pair


def _end(machine: str, parameter: Parameter, value: Any) -> float:
    number = parameter_value(machine, parameter, value)
    if not parameter.allows(number):
        raise _refused(f"{machine}: {parameter.name} = {value!r} is not allowed: it must be {parameter.range}")
    return number


def _refused(message: str) -> KinematicsError:
    return KinematicsError(Status.NOT_INITIALIZED, message)
