"""The test of the limits. If it refuses, it states which axes may be inside their limits on another turn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Joint, Limited, Mechanism
from derive.equations.axes import joint_lets
from derive.equations.trigonometry import named_trigonometry
from derive.ir.constants import DEGREE
from derive.ir.passes import normalise
from derive.ir.program import Let, Program, Require, Statement, Status
from derive.ir.reason import OtherTurn, Reason, Unit, Why, about, about_joint
from derive.ir.symbols import compared, real


def limits_program(mechanism: Mechanism) -> Program:
    """The test of every axis, those with several turns first, then of every quantity with limits, each widened by a
    tolerance.
    """
    turns = _other_turns(mechanism)
    body: list[Statement] = []
    for joint in sorted(mechanism.joints, key=lambda j: not j.multi_turn):  # a wrong turn is refused first
        unit = _unit(joint.in_degrees)
        below = about_joint(joint.symbol, Why.BELOW, unit=unit)
        if joint.loops:  # its value is that of the joint that it moves
            below = about(joint.name, Why.BELOW, unit=unit)
        reason = replace(below, turns=turns.get(joint.key, ()))
        body += _inside(joint.key, joint.axis, reason, f"limits of {joint.name}")
    if mechanism.limited:
        body += joint_lets(mechanism)
    for quantity in mechanism.limited:
        lets, (value,) = named_trigonometry(mechanism, [quantity.value / (DEGREE if quantity.is_angle else 1)])
        name = value_of(quantity)
        reason = replace(
            about(quantity.meaning, Why.BELOW, unit=_unit(quantity.is_angle)), turns=turns.get(quantity.name, ())
        )
        body += [*lets, Let(name, value, quantity.meaning)]
        body += _inside(quantity.name, name, reason, f"limits of {quantity.meaning}")
    return normalise("limits", body, [])


def _inside(key: str, value: sp.Symbol, reason: Reason, note: str) -> tuple[Require, Require]:
    """The conditions for the lower and for the upper end, each with its own reason and amount."""
    (lowest,), (highest,) = _ends(key)
    below, above = (
        replace(reason, why=Why.BELOW, amount=lowest - value),
        replace(reason, why=Why.ABOVE, amount=value - highest),
    )
    return (
        Require(compared(sp.Ge, value, lowest), Status.UNREACHABLE, note, below),
        Require(compared(sp.Le, value, highest), Status.UNREACHABLE, note, above),
    )


def _unit(is_angle: bool) -> Unit:
    return Unit.ANGLE if is_angle else Unit.LENGTH


def value_of(quantity: Limited) -> sp.Symbol:
    """The name of a quantity's value in programs."""
    return real(f"value_{quantity.name}")


def _other_turns(mechanism: Mechanism) -> dict[str, tuple[OtherTurn, ...]]:
    """For the key of an axis or a quantity: the axes whose turn its limits may refuse, the last axis first."""
    found = {j.key: (_other_turn(j),) for j in mechanism.period_joints}
    return found | {q.name: tuple(_of_quantity(q, mechanism)) for q in mechanism.limited if q.is_angle}


def _other_turn(joint: Joint) -> OtherTurn:
    """The axis and its limits, in degrees of its joint."""
    (lowest,), (highest,) = _ends(joint.key)
    return OtherTurn(joint.name, joint.turns * joint.axis, (joint.turns * lowest,), (joint.turns * highest,))


def _of_quantity(quantity: Limited, mechanism: Mechanism) -> Iterator[OtherTurn]:
    """The axes that change a quantity by one turn per turn, with their own limits and those of the quantity."""
    value = value_of(quantity)
    low, high = _ends(quantity.name)
    for joint in reversed(mechanism.joints):
        slope = sp.diff(quantity.value, joint.symbol)
        if not joint.multi_turn or joint.is_geared or slope not in (1, -1) or _moves_others(joint, quantity, mechanism):
            continue
        down, up = (low[0] - value, high[0] - value) if slope == 1 else (value - high[0], value - low[0])
        lowest, highest = _ends(joint.key)
        yield OtherTurn(joint.name, joint.axis, (*lowest, joint.axis + down), (*highest, joint.axis + up))


def _moves_others(joint: Joint, quantity: Limited, mechanism: Mechanism) -> bool:
    """Whether another joint of a quantity is geared to this axis."""
    return any(j.coupling.has(joint.motor) for j in mechanism.joints if j.symbol in quantity.value.free_symbols)


def _ends(key: str) -> tuple[tuple[sp.Expr], tuple[sp.Expr]]:
    return (real(f"lowest_{key}"),), (real(f"highest_{key}"),)
