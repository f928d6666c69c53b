"""Lost digits: a closed form may refuse a pose that the machine has; then steps on the closure meet it.

A two-root step near its fold, and a step whose conditioning nearly vanishes, know their angle to a few digits. If a
later step refuses there, this is not final: the branch calls the program of `closure_steps`. If no earlier step is
near its singularity the refusal is final, and the branch does nothing more.

A step that turns one length to another needs both alike. Where they nearly vanish, the rounding of their squares is
large beside them. Lengths that differ there are always lost digits: the steps on the closure decide.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import Conditioning
from derive.ir.constants import BOUNDARY, CONVERGED, DOUBTFUL
from derive.ir.passes import depending_on, normalise
from derive.ir.primitives import Select
from derive.ir.program import Call, Let, Program, Require, Statement, Status
from derive.ir.reason import Why, about_joint
from derive.ir.symbols import BOUND_OF, Flag, cosine, flag, names_in, real, sine
from derive.kinematics.lost_digits.closure_steps import MET, given_name, meet_program, started, varying
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.lost_digits.starts import GOAL, LOST
from derive.work import stage

AWAY, LENGTHS = "away_", f"{LOST}lengths_"
"""The begins of the names of how far two lengths differ, and of the flags that they do, which is always lost digits."""
_EXACTLY = {1 + BOUNDARY / 2: sp.Integer(1), BOUNDARY / 2: sp.Integer(0), CONVERGED: BOUNDARY}
"""A bound without what it allows for rounding."""


@stage("the search for lost digits")
def with_doubts(machine: Machine, statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The derivation with every refusal put off that lost digits of earlier steps may explain."""
    found: list[Statement] = []
    statements = _with_lengths(machine, statements) if machine.has_steps else statements
    for place, s in enumerate(statements):
        may_refuse = machine.has_steps and isinstance(s, Require) and s.otherwise is Status.UNREACHABLE
        doubts = _doubts(machine, statements, place) if may_refuse else []
        if isinstance(s, Require) and doubts:
            is_alone = any(name.name.startswith(AWAY) for name in names_in(s.condition))
            within, lost = flag(f"within_{place}"), flag(f"{LENGTHS if is_alone else LOST}{place}")
            bounds = {n: sp.Integer(1) for n in names_in(s.condition) if n.name.startswith(BOUND_OF)}
            found.append(Let(within, s.condition.xreplace(_EXACTLY | bounds)))
            found.append(Let(lost, sp.Not(within) if is_alone else sp.And(sp.Not(within), sp.Or(*doubts))))
            found.append(replace(s, condition=sp.Or(s.condition, lost)))
        else:
            found.append(s)
    return tuple(found)


def _with_lengths(machine: Machine, statements: Sequence[Statement]) -> list[Statement]:
    """The statements, with a condition behind each step whose two lengths may differ because digits are lost: a step
    behind a refusal that is not final. Behind one two-root step alone both have the same digits. `meeting` leaves the
    condition to the steps on the closure.
    """
    turned = {sine(c.angle): c for c in machine.inverse.derivation.conditionings if c.missed is not None}
    found: list[Statement] = []
    is_doubtful = False
    for place, s in enumerate(statements):
        found.append(s)
        is_doubtful = is_doubtful or (isinstance(s, Require) and bool(_doubts(machine, statements, place)))
        if is_doubtful and isinstance(s, Let) and s.name in turned:
            alike = _alike(turned[s.name])
            if _doubts(machine, [*found, *alike], len(found) + 1):
                found = [*_free_at_zero(found, turned[s.name].angle), *alike]
    return found


def _free_at_zero(statements: Sequence[Statement], angle: sp.Symbol) -> list[Statement]:
    """The statements with the angle free where the other length of its step is zero, too: then cosine and sine would
    both be zero.
    """
    own = {s.name: s.value for s in statements if isinstance(s, Let) and s.name in (cosine(angle), sine(angle))}
    if not all(isinstance(value, Select) for value in own.values()):
        return list(statements)
    square = sp.Add(*[sp.fraction(value.args[1])[0] ** 2 for value in own.values()])
    is_known = sp.Gt(square, 0)
    chosen = {name: Select(sp.And(value.args[0], is_known), *value.args[1:]) for name, value in own.items()}
    return [replace(s, value=chosen[s.name]) if isinstance(s, Let) and s.name in chosen else s for s in statements]


def _alike(step: Conditioning) -> tuple[Let, Require]:
    """By which part of the scale the lengths of a step differ, 0 if they are so large that their squares have the
    digits; and the condition that they are alike.
    """
    assert step.missed is not None
    away = real(f"{AWAY}{step.angle.name}")
    differ = sp.Abs(step.missed) / ((step.value + CONVERGED * step.scale) * step.scale)
    rare = Select(sp.Gt(step.value, DOUBTFUL * step.scale), sp.Integer(0), differ)
    is_alike = sp.Le(away, CONVERGED)
    return Let(away, rare), Require(is_alike, Status.UNREACHABLE, reason=about_joint(step.angle, Why.OUT_OF_REACH))


def _doubts(machine: Machine, statements: Sequence[Statement], place: int) -> list[sp.Basic]:
    """The conditions under which an earlier step, on which a refusal depends, has lost digits of its angle."""
    assignments, conditionings = machine.assignments, machine.inverse.derivation.conditionings
    before, read = statements[:place], statements[place].reads()
    unbound = {name for s in statements[place:] for name in s.bound()}
    signs = {a.determinant.sigma: a.orientation * a.factor for a in assignments}
    roots = [(a.factor, a.determinant, a.determinant.legs) for a in assignments]
    steps = [({s}, (d.value if legs is None else legs.root).xreplace(signs), d.scale) for s, d, legs in roots]
    steps += [({cosine(c.angle), sine(c.angle)}, c.value, c.scale) for c in conditionings]
    return [
        sp.Le(sp.Abs(value), DOUBTFUL * scale)
        for names, value, scale in steps
        if read & {*names, *depending_on(before, names)} and not names_in(value) & unbound
    ]


def meeting(machine: Machine, branch: Program, before: Callable[[Program], Program] = lambda search: search) -> Program:
    """The program of a branch, with steps on the closure before a doubtful refusal; as it is where it has none. On a
    machine with deviations every refusal is doubtful. before: what is tried before these steps, as a program.
    """
    deviates = [] if machine.deviates is None else [machine.deviates]
    flags = [s.name for s in branch.lets() if isinstance(s.name, Flag) and s.name.name.startswith(LOST)] + deviates
    if not flags:
        return branch
    joints = machine.mechanism.joints
    meet = before(meet_program(machine, branch))
    own = {started(j): o.value for j, o in zip(joints, branch.outputs, strict=True)}
    given = {goal: name for name, goal in GOAL.items()} | own
    given |= {given_name(name): name for name in varying(machine, branch)}
    arguments = tuple((n, given[n]) for n in meet.inputs if n in given)
    names = (MET, *(real(f"found_{j.key}") for j in joints))
    note = "if digits were lost, steps on the closure meet the pose"
    call = Call(meet, arguments, names, note, sp.Or(*flags))
    refusals: list[Require] = []
    for s in branch.requires():
        if own_flags := {f: MET for f in flags if f in names_in(s.condition)}:
            refusals.append(replace(s, condition=s.condition.xreplace(own_flags)))
    refusals = _joined(refusals)
    outputs = [replace(o, value=Select(MET, name, o.value)) for o, name in zip(branch.outputs, names[1:], strict=True)]
    lengths = {f for f in flags if f.name.startswith(LENGTHS)}
    body = (s for s in branch.body if not (isinstance(s, Require) and names_in(s.condition) & lengths))
    return normalise(branch.name, (*body, call, *refusals), outputs)


def without_meeting(program: Program) -> Program:
    """The program without steps on the closure: in place of a doubtful refusal it ends with the status OK and without
    an answer.
    """
    call = next((s for s in program.body if isinstance(s, Call) and s.is_rare), None)
    if call is None:
        return program
    flags = names_in(call.wanted)
    given = sorted(flags - set(program.bound()), key=lambda f: f.name)
    body: list[Statement] = [Require(sp.Not(f), Status.OK, "the machine has deviations") for f in given]
    for s in program.body[: program.body.index(call)]:
        own = [f for f in flags if isinstance(s, Require) and f in names_in(s.condition)]
        if isinstance(s, Require) and own:
            body += [Require(sp.Not(f), Status.OK, "digits may be lost") for f in own if f not in given]
            s = replace(s, condition=s.condition.xreplace(dict.fromkeys(own, sp.false)))
        body.append(s)
        if isinstance(s, Let) and s.name in flags and s.name.name.startswith(LENGTHS):
            body.append(Require(sp.Not(s.name), Status.OK, "digits may be lost"))
    own_values = {o: o.value.args[2] for o in program.outputs if isinstance(o.value, Select)}
    return normalise(program.name, body, [replace(o, value=own_values.get(o, o.value)) for o in program.outputs])


def _joined(refusals: Sequence[Require]) -> list[Require]:
    """The refusals, with the conditions on lengths in the first other one: that digits are lost is no other reason."""
    lengths = [r for r in refusals if any(name.name.startswith(AWAY) for name in names_in(r.condition))]
    first, *others = [r for r in refusals if r not in lengths] or lengths[:1]
    return [replace(first, condition=sp.And(first.condition, *(r.condition for r in lengths))), *others]
