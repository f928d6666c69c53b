"""Reasons in words: where a condition of the inverse does not hold, which axis or leg refuses, why, and what is
missing.

A reason ends in the unit of the missing amount, as in "A1: above its upper limit [deg]". Without a unit the amount is a
number (a margin), or there is none.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import sympy as sp

from derive.equations.rotation_repair import rotation_program
from derive.ir.program import Call, Iterate, Require, Statement, Status, shared
from derive.ir.reason import Kind, OtherTurn, Reason, Subject, Unit
from derive.kinematics.kinematics import Kinematics

NOT_INITIALIZED = "not initialized"
NO_MEANING = "byte {byte} of the configuration means nothing"
OTHER_TURN = "{subject}: this turn{axis} is beyond a limit, name one inside"


@dataclass(frozen=True)
class Check:
    """Conditions that refuse with one reason, and the missing amount where one of them does not hold."""

    conditions: tuple[sp.Basic, ...]
    status: Status
    reason: str
    missing: sp.Expr | None
    """The amount by which one side is short of the other; None if this has no meaning."""
    turns: tuple[tuple[OtherTurn, str], ...] = ()
    """The axes that may be inside on another turn, each with its reason; the first one that is gives reason and
    number."""


@dataclass(frozen=True)
class Reasons:
    """The reasons of one mechanism in words."""

    axes: Mapping[str, str]
    """The name of the axis, by the name of its joint value."""

    def checks(self, requires: Iterable[Require]) -> list[Check]:
        """The checks of requirements, in order: one for each reason with an amount, one for equal reasons without."""
        found: list[Check] = []
        for check in map(self._check, requires):
            if check.missing is None and found and found[-1].reason == check.reason:
                check = replace(check, conditions=(*found.pop().conditions, *check.conditions))
            found.append(check)
        return found

    def _check(self, require: Require) -> Check:
        reason = _given(require)
        conditions = tuple(sp.ordered(sp.And.make_args(require.condition)))
        turns = tuple((turn, self._of_turn(reason, turn)) for turn in reason.turns)
        return Check(conditions, require.otherwise, self.text(reason), reason.amount, turns)

    def loop(self, loop: Iterate) -> str:
        """The reason of a loop that does not end."""
        return self.text(_given(loop))

    def call(self, call: Call) -> tuple[Status, str] | None:
        """The status and the reason of a caller where a shared program refuses; None if it passes on the status."""
        return None if call.refusal is None else (call.refusal[0], self.text(call.refusal[1]))

    def text(self, reason: Reason) -> str:
        """A reason in words, with its unit."""
        return _with_unit(reason.why.of(self.name(reason.subject)), reason.unit)

    def name(self, subject: Subject) -> str:
        """The name of a subject; for a joint, that of its axis."""
        return self.axes.get(subject.name, subject.name) if subject.kind is Kind.JOINT else subject.name

    def _of_turn(self, reason: Reason, turn: OtherTurn) -> str:
        """The reason where an axis is inside on another turn; it names the axis where it is about another subject."""
        subject = self.name(reason.subject)
        axis = "" if subject == turn.name else f" of {turn.name}"
        return _with_unit(OTHER_TURN.format(subject=subject, axis=axis), reason.unit)


def _with_unit(text: str, unit: Unit) -> str:
    return f"{text} [{unit.value}]" if unit.value else text


def _given(statement: Require | Iterate) -> Reason:
    if statement.reason is None:
        raise TypeError(f"a refusal of the inverse gives no reason: {statement}")
    return statement.reason


def reasons_of_rotation() -> Reasons:
    """The reasons to refuse a commanded rotation, which are about no axis."""
    return Reasons({})


def rotation_texts() -> tuple[str, ...]:
    """Every reason to refuse a commanded rotation, in the order of their numbers, which start at 1."""
    return tuple(check.reason for check in reasons_of_rotation().checks(rotation_program().requires()))


def reasons_of(kinematics: Kinematics) -> Reasons:
    """The reasons of a mechanism."""
    programs = (kinematics.setup, kinematics.branch, kinematics.limits)
    without = (replace(p, body=tuple(_unexplained(p.body))) for p in programs)
    if any(p.requires() for p in shared(without)):
        raise TypeError(f"{kinematics.mechanism.name}: the inverse calls a program that gives no reasons")
    return Reasons({j.symbol.name: j.moved_name for j in kinematics.mechanism.joints})


def _unexplained(statements: Iterable[Statement]) -> Iterator[Statement]:
    """The statements without the calls that give their own reasons."""
    for statement in statements:
        if isinstance(statement, Iterate):
            calls = tuple(_unexplained(statement.calls()))
            yield replace(statement, step=tuple(s for s in statement.step if not isinstance(s, Call) or s in calls))
        elif not isinstance(statement, Call) or statement.refusal is None:
            yield statement


def texts(kinematics: Kinematics) -> tuple[str, ...]:
    """Every reason of the inverse and of the limits, once, in the order of their numbers, which start at 1."""
    statements = (*kinematics.branch.body, *kinematics.limits.body)
    return tuple(dict.fromkeys(_texts(statements, reasons_of(kinematics))))


def _texts(statements: Iterable[object], reasons: Reasons) -> Iterator[str]:
    for statement in statements:
        if isinstance(statement, Require):
            for check in reasons.checks([statement]):
                yield from (check.reason, *(why for _, why in check.turns))
        elif isinstance(statement, Iterate):
            yield from _texts(statement.step, reasons)
            if statement.otherwise is not None:
                yield reasons.loop(statement)
        elif isinstance(statement, Call) and (found := reasons.call(statement)):
            yield found[1]


def workspace(kinematics: Kinematics) -> tuple[str, ...]:
    """The bounds of the workspace besides the limits of the axes: the reasons to refuse a valid pose."""
    reasons = reasons_of(kinematics)
    bounds = [_given(s) for s in kinematics.branch.requires() if s.otherwise is Status.UNREACHABLE]
    found: dict[object, list[Reason]] = {}
    for reason in bounds:
        found.setdefault(reason.why if reason.why.is_about_a_subject else reason.subject, []).append(reason)
    return tuple(
        alike[0].why.of(", ".join(dict.fromkeys(reasons.name(reason.subject) for reason in alike)))
        for alike in found.values()
    )
