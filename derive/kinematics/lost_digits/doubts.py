"""Lost digits: a closed form may refuse a pose that the machine has; then steps on the closure meet it.

A two-root step near its fold, and a step whose conditioning nearly vanishes, know their angle to a few digits. If a
later step refuses there, this is not final: the branch calls the program of `closure_steps`. If no earlier step is
near its singularity the refusal is final, and the branch does nothing more.

A step that turns one length to another needs both alike. Where they nearly vanish, the rounding of their squares is
large beside them. Lengths that differ there are always lost digits: the steps on the closure decide.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import sympy as sp
from sympy.core.relational import Relational

from derive.equations.problem import Conditioning
from derive.ir.constants import BOUNDARY, CONVERGED, DOUBTFUL
from derive.ir.passes import depending_on, normalise
from derive.ir.primitives import Select, larger
from derive.ir.program import Call, Let, Program, Require, Statement, Status
from derive.ir.reason import Why, about_joint
from derive.ir.symbols import BOUND_OF, cosine, flag, names_in, real, sine
from derive.kinematics.lost_digits.closure_steps import MET, given_name, meet_program, started, varying
from derive.kinematics.lost_digits.machine import Machine
from derive.kinematics.lost_digits.starts import GOAL
from derive.work import stage

_EXACTLY = {1 + BOUNDARY / 2: sp.Integer(1), BOUNDARY / 2: sp.Integer(0), CONVERGED: BOUNDARY}
"""A bound without what it allows for rounding."""
_WORDS = re.compile(r"[a-z0-9]+")


@dataclass(frozen=True)
class Doubt:
    """A refusal that is put off: the flag that its value exceeds its bound, which lost digits explain."""

    flag: sp.Symbol
    lengths_differ: bool
    """Whether the value is the difference of two lengths: they differ for no other reason."""


@stage("the search for lost digits")
def with_doubts(machine: Machine, statements: Sequence[Statement]) -> tuple[tuple[Statement, ...], tuple[Doubt, ...]]:
    """The derivation with every refusal put off that lost digits of earlier steps may explain, and these doubts."""
    if not machine.has_steps:
        return tuple(statements), ()
    found: list[Statement] = []
    put_off: list[Doubt] = []
    statements, alike = _with_lengths(machine, statements)
    for place, s in enumerate(statements):
        may_refuse = isinstance(s, Require) and s.otherwise is Status.UNREACHABLE
        doubts = _doubts(machine, statements, place) if may_refuse else []
        if isinstance(s, Require) and doubts:
            own = Doubt(_lost(s, put_off), s in alike)
            bounds = {n: sp.Integer(1) for n in names_in(s.condition) if n.name.startswith(BOUND_OF)}
            within = s.condition.xreplace(_EXACTLY | bounds)
            if not isinstance(within, Relational):
                name = flag(f"no_{own.flag.name}")
                found.append(Let(name, within))
                within = name
            beyond = sp.Not(within)
            found.append(Let(own.flag, beyond if own.lengths_differ else sp.And(beyond, sp.Or(*doubts))))
            found.append(replace(s, condition=sp.Or(s.condition, own.flag)))
            put_off.append(own)
        else:
            found.append(s)
    return tuple(found), tuple(put_off)


def _lost(refusal: Require, earlier: Sequence[Doubt]) -> sp.Symbol:
    """The flag for a refusal, by what is at fault."""
    assert refusal.reason is not None
    wish = f"lost_digits_{'_'.join(_WORDS.findall(refusal.reason.subject.name))}"
    taken = {d.flag for d in earlier}
    return next(f for f in map(flag, (wish, *(f"{wish}_{k}" for k, _ in enumerate(earlier, 2)))) if f not in taken)


def _with_lengths(machine: Machine, statements: Sequence[Statement]) -> tuple[list[Statement], list[Require]]:
    """The statements, with a condition behind each step whose two lengths may differ because digits are lost: a step
    behind a refusal that is not final; and these conditions. Behind one two-root step alone both lengths have the same
    digits. `meeting` leaves the conditions to the steps on the closure.
    """
    turned = {sine(c.angle): c for c in machine.inverse.derivation.conditionings if c.missed is not None}
    found: list[Statement] = []
    added: list[Require] = []
    is_doubtful = False
    for place, s in enumerate(statements):
        found.append(s)
        is_doubtful = is_doubtful or (isinstance(s, Require) and bool(_doubts(machine, statements, place)))
        if is_doubtful and isinstance(s, Let) and s.name in turned:
            alike = _alike(turned[s.name])
            if _doubts(machine, [*found, *alike], len(found) + 1):
                found = [*_free_at_zero(found, turned[s.name].angle), *alike]
                added.append(alike[1])
    return found, added


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
    away = real(f"length_difference_{step.angle.name}")
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


def meeting(
    machine: Machine,
    branch: Program,
    doubts: Sequence[Doubt],
    before: Callable[[Program], Program] = lambda search: search,
) -> Program:
    """The program of a branch, with steps on the closure before a doubtful refusal; as it is where it has none. On a
    machine with deviations every refusal is doubtful. before: what is tried before these steps, as a program.
    """
    bound = {s.name for s in branch.lets()}
    met = {d.flag: MET for d in doubts if d.flag in bound}
    met |= {} if machine.deviates is None else {machine.deviates: MET}
    if not met:
        return branch
    joints = machine.mechanism.joints
    meet = before(meet_program(machine, branch))
    own = {started(j): o.value for j, o in zip(joints, branch.outputs, strict=True)}
    given = {goal: name for name, goal in GOAL.items()} | own
    given |= {given_name(name): name for name in varying(machine, branch)}
    arguments = tuple((n, given[n]) for n in meet.inputs if n in given)
    names = (MET, *(real(f"found_{j.key}") for j in joints))
    note = "if digits were lost, steps on the closure meet the pose"
    call = Call(meet, arguments, names, note, sp.Or(*met))
    refusals: dict[bool, list[Require]] = {True: [], False: []}
    lengths = {d.flag for d in doubts if d.lengths_differ}
    for s in branch.requires():
        if (read := names_in(s.condition)) & met.keys():
            refusals[bool(read & lengths)].append(replace(s, condition=s.condition.xreplace(met)))
    outputs = [replace(o, value=Select(MET, name, o.value)) for o, name in zip(branch.outputs, names[1:], strict=True)]
    body = (s for s in branch.body if not (isinstance(s, Require) and names_in(s.condition) & lengths))
    return normalise(branch.name, (*body, call, *_joined(refusals[True], refusals[False])), outputs)


def without_meeting(program: Program) -> Program:
    """The program without steps on the closure: in place of a doubtful refusal it ends with the status OK and without
    an answer.
    """
    call = next((s for s in program.body if isinstance(s, Call) and s.is_rare), None)
    if call is None:
        return program
    flags = names_in(call.wanted)
    given = sorted(flags - set(program.bound()), key=lambda f: f.name)
    before = program.body[: program.body.index(call)]
    refused = {name for s in before if isinstance(s, Require) for name in names_in(s.condition)}
    body: list[Statement] = [Require(sp.Not(f), Status.OK, "the machine has deviations") for f in given]
    for s in before:
        own = [f for f in flags if isinstance(s, Require) and f in names_in(s.condition)]
        if isinstance(s, Require) and own:
            body += [Require(sp.Not(f), Status.OK, "digits may be lost") for f in own if f not in given]
            s = replace(s, condition=s.condition.xreplace(dict.fromkeys(own, sp.false)))
        body.append(s)
        if isinstance(s, Let) and s.name in flags - refused:
            body.append(Require(sp.Not(s.name), Status.OK, "digits may be lost"))
    own_values = {o: o.value.args[2] for o in program.outputs if isinstance(o.value, Select)}
    return normalise(program.name, body, [replace(o, value=own_values.get(o, o.value)) for o in program.outputs])


def _joined(lengths: Sequence[Require], refusals: Sequence[Require]) -> list[Require]:
    """The refusals, with the conditions on lengths in the first other one: that digits are lost is no other reason.
    If these conditions alone do not hold, nothing is missing but digits: the amount is 0.
    """
    if not lengths:
        return list(refusals)
    first, *others = refusals or lengths[:1]
    reason, condition = first.reason, sp.And(first.condition, *(r.condition for r in lengths))
    if reason is not None and reason.amount is not None:
        reason = replace(reason, amount=larger(reason.amount, sp.Integer(0)))
    return [replace(first, condition=condition, reason=reason), *others]
