"""The steps of the base block around the programs of a block: it checks the inputs, reads the turns, chooses among
solutions, and tests the limits of the axes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.expression import is_size_test
from derive.ir.passes import with_inputs
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Program, Require, Statement, Status, rewritten
from derive.ir.symbols import flag, real
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Freedom, Kinematics
from derive.report.reasons import Check, reasons_of, texts

_POSITION = frozenset("xyz")
_POINT = frozenset(f"point_{axis}" for axis in "xyz")


@dataclass(frozen=True)
class Command:
    """The parts of a command that the inverse reads."""

    reads_position: bool
    reads_rotation: bool
    references: frozenset[int]
    """The axes whose reference it reads."""
    compared: frozenset[int]
    """The axes by whose distance from the reference it chooses among solutions."""


@kept_by_identity(10)
def command_of(kinematics: Kinematics) -> Command:
    """The parts of a command that the base block checks or reads before a branch is solved."""
    joints = kinematics.mechanism.joints
    known = _checked_first(kinematics)
    read = {symbol.name for symbol in kinematics.branch.reads()}
    return Command(
        reads_position=known >= _POSITION,
        reads_rotation=any(f"r{row}{column}" in read for row in (1, 2, 3) for column in (1, 2, 3)),
        references=frozenset(k for k, joint in enumerate(joints) if joint.reference.name in known),
        compared=frozenset(k for k, joint in enumerate(joints) if joint in kinematics.distance_joints),
    )


def commanded(key: str) -> sp.Symbol:
    """The value to which an axis is nearest, as the base block finds it for the commanded turn."""
    return real(f"commanded_{key}")


@kept_by_identity(10)
def branch_of(kinematics: Kinematics) -> Program:
    """The program of one branch without the steps of the base block."""
    return _solving(kinematics.branch, kinematics)


@kept_by_identity(10)
def offset_branch_of(kinematics: Kinematics) -> Program | None:
    """The program of one branch for a tool offset; None if the mechanism has none, or needs none."""
    offset = _offset_of(kinematics)
    return None if offset is None else _solving(offset, kinematics)


def keeps_orientation(kinematics: Kinematics) -> bool:
    """Whether the flange has a constant orientation: its position then is that of the tool's point less the offset."""
    return kinematics.freedom is Freedom.ZERO


def _offset_of(kinematics: Kinematics) -> Program | None:
    return None if keeps_orientation(kinematics) else kinematics.offset_branch


def _solving(program: Program, kinematics: Kinematics) -> Program:
    known = _checked_first(kinematics)
    known |= _POINT if kinematics.offset_branch is program and known >= _POSITION else frozenset()
    left = _without(program, known)
    return with_inputs(replace(left, body=tuple(_without_turns(left.body, kinematics))))


def without_axes(program: Program | None, kinematics: Kinematics) -> Program | None:
    """A program of axis values, and of their speeds, without the checks of its inputs, which the base block does."""
    if program is None:
        return None
    known = frozenset(s.name for joint in kinematics.mechanism.joints for s in (joint.axis, joint.speed))
    return _without(program, known | _POINT)


def from_home(program: Program | None, kinematics: Kinematics) -> Program | None:
    """A program of axis values that begins at the home pose, without the checks of a start: Initialize does them."""
    left = without_axes(program, kinematics)
    if left is None or not kinematics.starts:
        return left
    body = (s for s in left.body if not (isinstance(s, Require) and s.otherwise is Status.BAD_INPUT))
    return with_inputs(replace(left, body=tuple(body)))


def _without(program: Program, known: frozenset[str]) -> Program:
    """The program without its first conditions on inputs that are known to be numbers."""
    first = checks(program)
    left = (_unchecked(require, known) for require in first)
    return with_inputs(replace(program, body=(*(r for r in left if r is not None), *program.body[len(first) :])))


def checks(program: Program) -> tuple[Require, ...]:
    """The first conditions of a program, that its inputs are numbers."""
    sizes = (isinstance(s, Require) and all(map(is_size_test, sp.And.make_args(s.condition))) for s in program.body)
    count = next((place for place, is_size in enumerate(sizes) if not is_size), len(program.body))
    return tuple(s for s in program.body[:count] if isinstance(s, Require))


def _checked_first(kinematics: Kinematics) -> frozenset[str]:
    """The inputs that every branch checks, and that the base block checks instead."""
    branches = [p for p in (kinematics.branch, _offset_of(kinematics)) if p is not None]
    known = frozenset.intersection(*(frozenset(_names(checks(p))) for p in branches))
    return known if known >= _POSITION else known - _POSITION


def _names(requires: tuple[Require, ...]) -> Iterator[str]:
    return (symbol.name for require in requires for symbol in require.condition.free_symbols)


def _unchecked(require: Require, known: frozenset[str]) -> Require | None:
    """The condition without its parts on inputs that are known to be numbers; None if nothing is left."""
    parts = [p for p in sp.And.make_args(require.condition) if {s.name for s in p.free_symbols} - known]
    return replace(require, condition=sp.And(*parts)) if parts else None


def _without_turns(body: Sequence[Statement], kinematics: Kinematics) -> Iterator[Statement]:
    """The statements with the values that the base block finds for the turns of axes."""
    joints = {f"near_{joint.key}": joint for joint in kinematics.period_joints}
    opened = {f"open_{key}" for key in (joint.key for joint in kinematics.period_joints)}
    values = {s.name.name: s.value for s in body if isinstance(s, Let)}
    table: dict[sp.Basic, sp.Basic] = {}
    left_out: set[str] = set()
    for near, joint in joints.items():
        number = 360 * ToReal(Select(sp.Gt(joint.turn, 0), joint.turn - 1, joint.turn))
        plain = Select(flag(f"single_{joint.key}"), real(f"mid_{joint.key}"), joint.reference)
        open_value = f"open_{joint.key}"
        if values.get(open_value) == plain and near in values:
            table[real(near)] = commanded(joint.key)
            left_out |= {near, open_value} & (opened | joints.keys())
        else:
            table[number] = commanded(joint.key)
    for statement in body:
        if not (isinstance(statement, Let) and statement.name.name in left_out):
            yield rewritten(statement, lambda e: e.xreplace(table))


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
