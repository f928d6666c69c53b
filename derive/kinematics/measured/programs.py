"""The programs of a machine with deviations.

Its axes have the values at which the axes of the drawing have the same joints: `actual_a1`. There the pose is that of
the true chain, and margins are those of the drawing. The inverse of the drawing is where steps on the true closure
start, and its refusals wait for them. Without deviations every value is that of the drawing, to the last bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.equations.axes import Forward, joint_lets
from derive.equations.named_pose import NamedPose
from derive.ir.constants import DEGREE, PLANE
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program, Require, Statement, Status, rewritten
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import POSITION, ROTATION_ENTRIES, SCALE, flag, real
from derive.kinematics.differential import TWIST_ROWS, chain_entries, entries_of, jacobian_rows
from derive.kinematics.forward import forward_program, orientation_program
from derive.kinematics.lost_digits.doubts import Doubt, meeting
from derive.kinematics.lost_digits.machine import Commanded, Machine
from derive.kinematics.lost_digits.starts import DRAWN
from derive.kinematics.measured.approach import approached
from derive.kinematics.measured.pose import inner_pose, true_pose

DEVIATES = flag("has_deviations")
_LENGTHS, _ANGLES = real("size_of_shifts"), real("size_of_turns")
_RADIANS = {"deg": DEGREE, "1": sp.Integer(3)}
"""What a deviation turns the machine by: a gain that of half a turn."""
_POSE = (*POSITION, *ROTATION_ENTRIES)


@dataclass(frozen=True)
class Measured:
    """The machine as it is, at the values that its axes have."""

    mechanism: Mechanism
    machine: Machine
    """The machine as it is drawn."""
    forward: Forward
    """The pose of the drawing, with the derivation at given axis values."""
    margins: tuple[Let, ...]
    doubts: tuple[Doubt, ...]
    """The refusals of the inverse of the drawing that lost digits explain."""

    @property
    def pose(self) -> NamedPose:
        """The pose of the true chain."""
        return true_pose(self.mechanism)

    def off(self, joint: Joint, word: str) -> sp.Expr:
        """The offset, or the gain, of an axis."""
        name = f"{joint.key}_{word}"
        return next(p.symbol for p in self.mechanism.parameters if p.given_name == name)

    @property
    def at_axes(self) -> tuple[Statement, ...]:
        """The true pose, the margins of the drawing, and what both need."""
        drawn = (_under_other_names(s) for s in (*self.forward.statements, *self.margins))
        ends = ((self.pose.position, self.forward.position), (self.pose.rotation, self.forward.rotation))
        values = [pair for end in ends for pair in zip(*end, strict=True)]
        named = [Let(DRAWN[n], _at_drawn(d)) for n, (_, d) in zip(_POSE, values, strict=True) if d != n]
        chosen = (Let(n, Select(DEVIATES, t, DRAWN[n])) for n, (t, _) in zip(_POSE, values, strict=True))
        return (*self.settled, *drawn, *named, *self.pose.statements, *chosen)

    @property
    def settled(self) -> tuple[Let, ...]:
        """How large its deviations are, and whether it has any."""
        own = {p: sp.Abs(real(p.name)) for p in self.mechanism.parameters if p.deviation is not None}
        lengths = sp.Add(*(value for p, value in own.items() if p.unit == "u"))
        angles = sp.Add(*(value * _RADIANS[p.unit] for p, value in own.items() if p.unit != "u"))
        return Let(_LENGTHS, lengths), Let(_ANGLES, angles), Let(DEVIATES, sp.Gt(_LENGTHS + _ANGLES, 0))

    def entries(self, rows: Sequence[str]) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
        """The Jacobian by the values that the axes have."""
        before, drawn = chain_entries(self.mechanism, rows)
        lets, true = chain_entries(self.mechanism, rows, self.pose.screws)
        own = [Select(DEVIATES, t, _at_drawn(d)) for t, d in zip(true, drawn, strict=True)]
        return (*map(_under_other_names, before), *lets), own

    @property
    def lean(self) -> Machine:
        """The machine with the pose and the Jacobian that steps take."""
        pose = inner_pose(self.mechanism).pose
        at_axes = (*joint_lets(self.mechanism), *pose.statements, *map(Let, _POSE, (*pose.position, *pose.rotation)))
        entries = chain_entries(self.mechanism, self.machine.rows, pose.screws)
        return replace(self.machine, at_axes=at_axes, entries=entries, assignments=())

    def actual(self, joint: Joint, told: sp.Symbol) -> Let:
        """The value that an axis has, by what it tells."""
        value = told + self.off(joint, "gain") * (told - joint.offset) + self.off(joint, "offset")
        return Let(_actual(told), value)

    def commanded(self, joint: Joint) -> Commanded:
        """What an axis tells, by the value that it has."""
        gain, offset = self.off(joint, "gain"), self.off(joint, "offset")
        return Commanded(gain * joint.offset - offset, 1 + gain)

    def at_actual(self, program: Program) -> Program:
        """A program of values that axes have, as one of those that they tell; so for the reference."""
        told = {s: j for j in self.mechanism.joints for s in (j.axis, j.reference) if real(s.name) in program.inputs}
        names = {real(s.name): real(_actual(s).name) for s in told}
        body = (rewritten(s, lambda e: e.xreplace(names)) for s in program.body)
        outputs = [Output(o.name, o.value.xreplace(names)) for o in program.outputs]
        return normalise(program.name, (*(self.actual(j, s) for s, j in told.items()), *body), outputs)

    def jacobian(self, name: str, rows: Sequence[str]) -> Program:
        """The Jacobian, or all rows of the twist."""
        lets, entries = self.entries(rows)
        joints = self.mechanism.joints
        told = [e * (1 + self.off(joints[k % len(joints)], "gain")) for k, e in enumerate(entries)]
        return normalise(name, (*self.at_axes, *lets), entries_of(told, len(joints)))

    def branch(self, drawn: Program) -> Program:
        """The inverse: that of the drawing, then steps on the true closure."""
        late = map(_put_off, drawn.body)
        met = Require(
            sp.Or(sp.Le(_LENGTHS + _ANGLES, 0), DEVIATES), Status.UNREACHABLE, reason=about_machine(Why.TRUE_MACHINE)
        )
        machine = replace(
            self.machine,
            at_axes=self.at_axes,
            entries=self.entries(self.machine.rows),
            commanded={j: self.commanded(j) for j in self.mechanism.joints},
            deviates=DEVIATES,
        )
        branch = normalise(drawn.name, (*self.settled, *late, met), drawn.outputs)
        lean, inner = self.lean, inner_pose(self.mechanism)
        return meeting(machine, branch, self.doubts, lambda search: approached(machine, lean, inner, branch, search))


def measured_programs(measured: Measured, drawn: Sequence[Program]) -> list[Program]:
    """The programs of the true machine. drawn: those of the machine as it is drawn."""
    forward = Forward(measured.at_axes, _POSE[:3], _POSE[3:])
    margins = tuple(s for s in map(_under_other_names, measured.margins) if isinstance(s, Let))
    made = {
        "forward": forward_program(measured.mechanism, forward, margins),
        "orientation": orientation_program(forward),
        "branch": measured.branch(next(p for p in drawn if p.name == "branch")),
        "jacobian": measured.jacobian("jacobian", jacobian_rows(measured.mechanism)),
        "twist": measured.jacobian("twist", TWIST_ROWS),
    }
    programs = [made.get(p.name, p) for p in drawn]
    return [p if p.name == "limits" else measured.at_actual(p) for p in programs]


def _put_off(statement: Statement) -> Statement:
    """A statement of the inverse of the drawing, which refuses no pose of a machine with deviations: what is a little
    out of reach has two solutions beside each other, as if it were as much within reach. A coordinate that no axis
    moves may be where deviations of this size put it.
    """
    if (
        isinstance(statement, Require)
        and statement.reason
        and statement.reason.why in (Why.OUT_OF_PLANE, Why.NOT_MOVED)
    ):
        room = 2 * (_LENGTHS + _ANGLES * (SCALE + sp.Add(*map(sp.Abs, POSITION))))  # a line moves there and back
        wider = {sign * PLANE * SCALE: sign * (PLANE * SCALE + room) for sign in (1, -1)}
        return rewritten(statement, lambda e: e.xreplace(wider))
    if isinstance(statement, Require) and statement.otherwise is not Status.BAD_INPUT:
        return replace(statement, condition=sp.Or(statement.condition, DEVIATES))
    return rewritten(statement, lambda e: e.replace(Root, lambda x: Root(Select(DEVIATES, sp.Abs(x), x))))


def _actual(told: sp.Symbol) -> sp.Symbol:
    return real(f"actual_{told.name}")


def _at_drawn(value: sp.Basic) -> sp.Basic:
    return sp.sympify(value).xreplace(DRAWN)


def _under_other_names(statement: Statement) -> Statement:
    """A statement about the drawing, with its pose under other names."""
    return rewritten(statement, _at_drawn).with_names(lambda name: DRAWN.get(name, name))
