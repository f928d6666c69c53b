"""What to say where a condition of the inverse does not hold: the axis or leg that refused, why, and how much is missing.

A reason ends in the unit of what is missing, as in "A1: above its upper limit [deg]". Without one it is a number (a margin),
or there is nothing to measure.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce

import sympy as sp
from sympy.core.relational import GreaterThan, LessThan, Relational, StrictGreaterThan

from derive.description.dimensions import Role
from derive.equations.rotation_repair import rotation_program
from derive.ir.constants import (
    DEGREE,
)
from derive.ir.primitives import (
    Atan2,
    Root,
    Select,
)
from derive.ir.program import (
    Iterate,
    Let,
    Require,
    Status,
    shared,
)
from derive.ir.symbols import (
    SCALE,
)
from derive.kinematics.kinematics import Kinematics
from derive.report.other_turns import OtherTurn, other_turns

NOT_INITIALIZED = "not initialized"
NO_MEANING = "byte {byte} of the configuration means nothing"
_LENGTH, _ANGLE = "u", "deg"
_TURN = ": this turn{axis} is beyond a limit, name one inside"
_NOTHING = sp.Integer(0)


@dataclass(frozen=True)
class Check:
    """Conditions that refuse with one reason, and what is missing where one of them does not hold."""

    conditions: tuple[sp.Basic, ...]
    status: Status
    reason: str
    missing: sp.Expr
    """How much one side is short of the other; zero where that means nothing."""
    turns: tuple[tuple[OtherTurn, str], ...] = ()
    """What may be inside on another turn, with the reason where it is: the first that is gives reason and number."""


@dataclass(frozen=True)
class Missing:
    """How much is missing, in which unit (empty for a number), and what to add to the reason."""

    amount: sp.Expr
    unit: str = ""
    side: str = ""


@dataclass(frozen=True)
class Reasons:
    """What is known of the names in the inverse and in the limits of one mechanism."""

    axes: Mapping[str, str]
    """The name of the axis, by the name of its joint value."""
    limits: Mapping[str, str]
    """The units of the limits, by the names of the constants."""
    lengths: frozenset[str]
    """The parameters that are lengths, and the scale of the machine."""
    definitions: Mapping[sp.Symbol, sp.Expr]
    turns: Mapping[str, tuple[OtherTurn, ...]] = field(default_factory=dict)
    """The axes whose turn may be at fault, by the names of the constants."""

    def checks(self, requires: Iterable[Require]) -> list[Check]:
        """What requirements ask, in a fixed order: one check for every reason that has an amount, one for others alike."""
        found: list[Check] = []
        for check in (c for require in requires for c in self._checks(require)):
            if check.missing == 0 and found and found[-1].reason == check.reason:
                check = replace(check, conditions=(*found.pop().conditions, *check.conditions))
            found.append(check)
        return found

    def _checks(self, require: Require) -> Iterator[Check]:
        if require.otherwise is Status.BAD_INPUT:
            yield _input_check(require)
            return
        for part in sp.ordered(sp.And.make_args(require.condition)):
            missing = self._missing(part)
            turns = tuple(self._turns(require.note, part, missing))
            yield Check((part,), require.otherwise, self._reason(require.note, missing), missing.amount, turns)

    def loop(self, loop: Iterate) -> str:
        """Why a loop that was never left refuses."""
        return self._reason(loop.note, Missing(_NOTHING))

    def _turns(self, note: str, part: sp.Basic, missing: Missing) -> Iterator[tuple[OtherTurn, str]]:
        """The axes that may be inside on another turn, where a limit refuses, and what to say then."""
        name = part.rhs.name if isinstance(part, Relational) and part.rhs.is_Symbol else ""
        for turn in self.turns.get(name, ()):
            yield turn, self._reason(note, replace(missing, side=_TURN.format(axis=turn.of(note))))

    def _reason(self, note: str, missing: Missing) -> str:
        subject, colon, rest = note.removeprefix("limits of ").partition(":")
        subject = self.axes.get(subject, subject)
        return f"{subject}{colon}{rest}{missing.side}" + (f" [{missing.unit}]" if missing.unit else "")

    def _missing(self, part: sp.Basic) -> Missing:
        part = _told(part)
        if not isinstance(part, Relational) or _is_flag(part):
            return Missing(_NOTHING)
        more = isinstance(part, GreaterThan | StrictGreaterThan)
        short = part.rhs - part.lhs if more else part.lhs - part.rhs
        if part.rhs.is_Symbol and part.rhs.name in self.limits:
            side = ": below its lower limit" if more else ": above its upper limit"
            return Missing(short, self.limits[part.rhs.name], side)
        length = self._short_length(self.definitions.get(part.lhs, _NOTHING))
        if length is not None:
            return Missing(length, _LENGTH)
        bound = self.definitions.get(part.rhs, _NOTHING)
        if bound.has(sp.cos):
            return Missing((_of_cosine(part.lhs) - _of_cosine(part.rhs)) / DEGREE, _ANGLE)
        if bound.has(sp.sin):
            return Missing((_of_sine(part.lhs) - _of_sine(part.rhs)) / DEGREE, _ANGLE, ": beyond its largest angle")
        if _is_tolerance(part):
            names = {s.name for s in part.rhs.free_symbols}
            return Missing(_NOTHING) if more else Missing(short, _LENGTH if names and names <= self.lengths else "")
        return Missing(short)

    def _short_length(self, radicand: sp.Expr) -> sp.Expr | None:
        """Of a radicand that is negative, how much the lengths in it are short; None where they do not stand in it as lengths.

        In a product of lengths, (l1 + l2 - r)(l1 + l2 + r)(l1 - l2 + r)(l2 + r - l1) or (r - l)(r + l), it is the factor of
        least size, whatever signs the lengths have. Where a length occurs as its square alone, as the rod l in
        l^2 - x^2 - y^2, it would have to be so much longer or shorter.
        """
        radicand = self._written_out(radicand)
        sums = [f for f in sp.Mul.make_args(radicand) if f.is_Add]
        if not sums:
            return None
        if radicand.could_extract_minus_sign() and radicand.is_Mul:
            sums[0] = -sums[0]
        if all(t.as_coeff_Mul()[1].is_Symbol for f in sums for t in f.args):
            whole = sp.Add(*sums) / 2
            return sp.Add(*[sp.Abs(f) / 2 for f in sums]) - whole.xreplace({s: sp.Abs(s) for s in self._signed(whole)})
        for rod in sorted({s for f in sums for s in f.free_symbols if s.name in self.lengths}, key=str):
            signs = [sp.expand(f).coeff(rod, 2) for f in sums]
            if all(s in (1, -1) and not sp.expand(f - s * rod**2).has(rod) for s, f in zip(signs, sums, strict=True)):
                below = [-f if len(sums) == 1 else _below_zero(f) for f in sums]
                needed = sp.Add(rod**2, *[s * b for s, b in zip(signs, below, strict=True)])
                return sp.Abs(Root(needed) - rod)
        return None

    def _written_out(self, radicand: sp.Expr) -> sp.Expr:
        """The radicand with its factors, and then with the names that are products in them."""
        table = {s: self.definitions[s] for s in sp.Mul.make_args(radicand) if s in self.definitions}
        if not table or not all(v.is_Mul or v.is_Add for v in table.values()):
            return radicand
        radicand = radicand.xreplace(table)
        return radicand.xreplace({s: v for s in radicand.free_symbols if (v := self.definitions.get(s, s)).is_Mul})

    def _signed(self, value: sp.Expr) -> set[sp.Symbol]:
        """The names in it of what may be negative."""
        known = {s for s in value.free_symbols if isinstance(self.definitions.get(s), Root | Select)}
        return {s for s in value.free_symbols - known if s.name not in self.lengths}


def reasons_of_rotation() -> Reasons:
    """What the reasons to refuse a commanded rotation need to know: nothing of the mechanism."""
    return Reasons({}, {}, frozenset(), {})


def rotation_texts() -> tuple[str, ...]:
    """Every reason to refuse a commanded rotation: the place, from 1, is the number of the reason."""
    return tuple(check.reason for check in reasons_of_rotation().checks(rotation_program().requires()))


def reasons_of(kinematics: Kinematics) -> Reasons:
    """What the reasons of a mechanism need to know."""
    programs = (kinematics.setup, kinematics.branch, kinematics.limits)
    if any(p.requires() for p in shared(programs)):
        raise TypeError(f"{kinematics.mechanism.name}: the inverse calls a program that gives no reasons")
    limits = {p.name.replace("lower_", "lowest_", 1): p.unit for p in kinematics.parameters if p.name.startswith("lower_")}
    limits |= {p.name.replace("upper_", "highest_", 1): p.unit for p in kinematics.parameters if p.name.startswith("upper_")}
    return Reasons(
        {j.symbol.name: j.name for j in kinematics.mechanism.joints},
        limits,
        frozenset({SCALE.name} | {p.name for p in kinematics.parameters if p.role is Role.LENGTH}),
        {s.name: s.value for p in programs for s in p.body if isinstance(s, Let)},
        other_turns(kinematics.mechanism),
    )


def texts(kinematics: Kinematics) -> tuple[str, ...]:
    """Every reason of the inverse and of the limits, once, in order: the place, from 1, is the number of the reason."""
    reasons = reasons_of(kinematics)
    found: list[str] = []
    for statement in (*kinematics.branch.body, *kinematics.limits.body):
        if isinstance(statement, Require):
            found += [text for c in reasons.checks([statement]) for text in (c.reason, *(why for _, why in c.turns))]
        elif isinstance(statement, Iterate):
            found.append(reasons.loop(statement))
    return tuple(dict.fromkeys(found))


def workspace(kinematics: Kinematics) -> tuple[str, ...]:
    """What bounds the workspace besides the limits of the axes: the reasons to refuse a pose that is one."""
    reasons = reasons_of(kinematics)
    bounds = (s for s in kinematics.branch.body if isinstance(s, Require) and s.otherwise is Status.UNREACHABLE)
    found: dict[str, list[str]] = {}
    for subject, _, why in (c.reason.partition(" [")[0].rpartition(": ") for s in bounds for c in reasons.checks([s])):
        found.setdefault(why, []).append(subject)
    return tuple(f"{', '.join(dict.fromkeys(who))}: {why}".removeprefix(": ") for why, who in found.items())


def _input_check(require: Require) -> Check:
    """Where the condition bounds errors that have names, the largest of them is told; else it is said what should be given."""
    parts = tuple(sp.ordered(sp.And.make_args(require.condition)))
    errors = [p.lhs for p in parts if isinstance(p, LessThan) and p.lhs.is_Symbol]
    if len(errors) < len(parts):
        return Check(parts, require.otherwise, f"not given: {require.note}", _NOTHING)
    return Check(parts, require.otherwise, require.note, _largest(errors))


def _largest(values: Sequence[sp.Expr]) -> sp.Expr:
    first, *others = values
    return reduce(lambda most, value: Select(sp.Gt(value, most), value, most), others, first)


def _told(part: sp.Basic) -> sp.Basic:
    """Of alternatives that all fail, the one that is no flag."""
    return next((p for p in sp.ordered(part.args) if not _is_flag(p)), part) if isinstance(part, sp.Or) else part


def _is_flag(part: sp.Basic) -> bool:
    """Whether it asks which of two cases it is: 0 or 1, or a sign."""
    return isinstance(part, Relational) and part.lhs.is_Symbol and part.rhs in (0, sp.Rational(1, 2))


def _is_tolerance(part: Relational) -> bool:
    """Whether a length is compared with a small part of another, or a number with a small one."""
    return bool(abs(part.rhs.as_coeff_Mul()[0]) < sp.Float("1e-5")) and not part.rhs.is_zero


def _below_zero(value: sp.Expr) -> sp.Expr:
    """How far a value is below zero; zero where it is not."""
    return (sp.Abs(value) - value) / 2


def _of_cosine(value: sp.Expr) -> sp.Expr:
    return Atan2(Root(1 - value**2), value)


def _of_sine(value: sp.Expr) -> sp.Expr:
    return Atan2(value, Root(1 - value**2))
