"""A root of an arm with a spherical wrist: its position is improved before the wrist follows it.

Near a double root the position of a trial has half of its digits. Where the wrist is singular, too, it cannot correct
the rotation for every small motion of the joints in front of it: Newton's method on the whole closure would stall.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Task, Turning
from derive.equations.closures.fixed_names import fixed_lets
from derive.geometry.frames import Chain, Factor
from derive.ir.passes import depending_on, needed_lets
from derive.ir.program import Let, Statement, rewritten
from derive.ir.symbols import COORDINATE_NAMES, cosine, real, sine
from derive.kinematics.scan.derivations import Scanned, named_apart
from derive.kinematics.scan.programs import GOAL, Trial, newton, solved_value, with_goal

_TRIED, _BEGUN, _PLACED = "_tried", "_begun", "_placed"


def with_position_first(both: Scanned, trial: Trial) -> tuple[Statement, ...]:
    """The statements of a trial, with Newton's method on the position between those for it and those for the wrist."""
    mechanism, wrist = both.mechanism, both.trial.derivation.wrist
    front = tuple(j for j in mechanism.solved_joints if j.symbol not in wrist)
    moved = {s for factor in both.trial.closure.links for s in factor.amount.free_symbols}
    if not wrist or mechanism.held_joints or not {j.symbol for j in front} <= moved:
        return trial.statements
    own = {name for joint in front for name in _names(joint)}
    dependent = depending_on(trial.statements, own)
    first = needed_lets(trial.statements, own)
    begun = {let.name: _called(let.name, _BEGUN) for let in first if let.name in own or let.name in dependent}
    before = [Let(begun.get(s.name, s.name), s.value.xreplace(begun), s.note) for s in first]
    placed = [let for joint in front for let in _placed(joint)]
    behind = [s for s in trial.statements if s.name not in own and (s.name in dependent or s not in first)]
    return (*before, *_target(both), *_improved(both, front, begun), *placed, *behind)


def _names(joint: Joint) -> tuple[sp.Symbol, ...]:
    """The names that a trial binds for a joint."""
    names = (cosine(joint.symbol), sine(joint.symbol)) if joint.is_angle else (joint.symbol,)
    return tuple(_called(name, _TRIED) for name in names)


def _called(name: sp.Symbol, ending: str) -> sp.Symbol:
    return real(f"{name.name.removesuffix(_TRIED)}{ending}")


def _placed(joint: Joint) -> Iterable[Let]:
    """The result of Newton's method for a joint, bound to the joint's names in the trial."""
    value = real(f"{joint.symbol.name}{_PLACED}")
    values = (sp.cos(value), sp.sin(value)) if joint.is_angle else (value,)
    return (Let(name, v) for name, v in zip(_names(joint), values, strict=True))


def _target(both: Scanned) -> tuple[Let, ...]:
    """The point that the joints in front of the wrist bring to where the pose has it.

    Cosines of fixed angles stand in it as such: the loops of the program bind their names for themselves.
    """
    target = both.trial.closure.target
    fixed = {let.name: let.value for let in fixed_lets(both.mechanism)}
    lets = fixed | {let.name: let.value.xreplace(fixed) for let in target.lets}
    point = (sp.sympify(value).xreplace(lets) for value in target.point)
    named = (Let(real(f"{c}{_PLACED}_at"), value) for c, value in zip(COORDINATE_NAMES, point, strict=True))
    return tuple(s for s in with_goal(tuple(named)) if isinstance(s, Let))


def _improved(both: Scanned, front: tuple[Joint, ...], begun: dict[sp.Symbol, sp.Symbol]) -> tuple[Statement, ...]:
    """Newton's method on the position of the point."""
    mechanism = _front(both.mechanism, both.trial.closure.links, front)
    loop, _ = newton(mechanism, [solved_value(mechanism, j.symbol).xreplace(begun) for j in front])
    loop = replace(loop, note="Newton's method on the position in front of the wrist")
    goals = {GOAL[real(c)]: real(f"{c}{_PLACED}_at") for c in COORDINATE_NAMES}
    return tuple(rewritten(s, lambda e: e.xreplace(goals)) for s in named_apart((loop,), _PLACED.removeprefix("_")))


def _front(mechanism: Mechanism, links: tuple[Factor, ...], joints: tuple[Joint, ...]) -> Mechanism:
    """The machine up to its wrist, as a mechanism that positions a point."""
    return replace(
        mechanism,
        chain=Chain(links),
        joints=joints,
        task=Task("xyz", Turning.NONE),
        branches=(),
        search=None,
        limited=(),
        constraints=(),
        periods=None,
        offset_interface=False,
    )
