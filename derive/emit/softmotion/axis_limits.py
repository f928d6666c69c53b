"""The blocks that test no limits but those of their axes: the base block tests these for them."""

from __future__ import annotations

from collections.abc import Iterator

from derive.ir.program import Require
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.report.reasons import Check, reasons_of, texts


@kept_by_identity(10)
def limit_reasons(kinematics: Kinematics) -> tuple[int, ...]:
    """The number of the reason "below its lower limit" of every axis, in the order of the axes; empty if a block
    tests other limits, too.

    The numbers of an axis follow one another: "below", then "another turn" if the axis has turns, then "above". Axes
    are tested in the order of their numbers.
    """
    numbers: dict[str, int] = {}
    body = kinematics.limits.body
    for lower, upper in zip(body[::2], body[1::2], strict=False):
        found = _of_axis(kinematics, lower, upper)
        if found is None:
            return ()
        numbers[found[0]] = found[1]
    names = [joint.axis.name for joint in kinematics.mechanism.joints]
    is_all = len(body) == 2 * len(names) and numbers.keys() == set(names)
    if not is_all or list(numbers.values()) != sorted(numbers.values()):
        return ()
    return tuple(numbers[name] for name in names)


def _of_axis(kinematics: Kinematics, lower: object, upper: object) -> tuple[str, int] | None:
    """The axis whose limits two conditions test, and nothing else, with the number of the first reason."""
    if not (isinstance(lower, Require) and isinstance(upper, Require)):
        return None
    checks = reasons_of(kinematics).checks([lower, upper])
    joints = [j for j in kinematics.mechanism.joints if j.axis in lower.condition.free_symbols]
    if len(joints) != 1 or len(checks) != 2:
        return None
    (joint,) = joints
    ends = [
        {s.name for s in check.conditions[0].free_symbols} == {joint.axis.name, f"{end}_{joint.key}"}
        for check, end in zip(checks, ("lowest", "highest"), strict=True)
    ]
    numbers = list(_numbers(kinematics, checks))
    in_a_row = numbers == list(range(numbers[0], numbers[0] + 2 + joint.multi_turn))
    of_itself = all(turn.axis == joint.axis for check in checks for turn, _ in check.turns)
    return (joint.axis.name, numbers[0]) if all(ends) and in_a_row and of_itself else None


def _numbers(kinematics: Kinematics, checks: list[Check]) -> Iterator[int]:
    known = texts(kinematics)
    below, above = checks
    for text in (below.reason, *(why for _, why in below.turns), above.reason):
        yield known.index(text) + 1
