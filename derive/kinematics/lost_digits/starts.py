"""Where the steps on the closure start: the attempts, and the closed form with nearly free angles turned."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.equations.axes import reference_value
from derive.ir.constants import (
    COST_OF_A_STALL,
    DOUBTFUL,
    FREE_ANGLE,
    LATTICE,
    NEARLY_FREE,
    PASSES,
    REFINED,
    SCANNED,
    STALLED,
)
from derive.ir.passes import needed_for
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Program
from derive.ir.symbols import POSITION, ROTATION_ENTRIES, called, count, flag, real

GOAL = {name: real(f"goal_{name.name}") for name in (*POSITION, *ROTATION_ENTRIES)}
"""The names of the commanded pose in this program."""
LEFT, ATTEMPT, BEFORE = count("passes_left"), count("attempt"), real("error_before")
ANOTHER, MIRRORS, IS_MET = flag("another"), flag("mirrors"), flag("pose_is_met")
LEFT_NOW = count("passes_left_now")
TURN, BESIDE = real("turn_of_attempt"), real("turn_beside")
AGAIN = flag("from_the_met_pose")
ENDS = flag("no_start_is_left")
FREE, FREE_TURN = real("free_angle"), real("free_turn")
LEFT_OVER = real("error_left")
NEAREST, NEAREST_TURN = real("least_error_left"), real("nearest_turn")
NEAREST_NOW, NEAREST_TURN_NOW = real("least_error_left_now"), real("nearest_turn_now")
STEP = sp.Rational(360, SCANNED)
"""How far (degrees) free angles are turned from one attempt of the scan to the next."""
SCAN_ENDS = SCANNED + REFINED + 2
"""The attempts: 0 from the given start, 1 with nearly free angles at the reference, then one of the scan each, some
beside the nearest, ever closer, and this one from the nearest of all.
"""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def tried(joint: Joint) -> sp.Symbol:
    """The axis value at which a pass is."""
    return real(f"tried_{joint.key}")


def next_attempt(following: sp.Symbol) -> tuple[Let, ...]:
    """Whether another start is taken, which one, and what is free there."""
    nearer = flag("is_nearer")
    far = Select(refines(following), BESIDE, _ZERO)
    free = Select(sp.Gt(following, 0), Select(sp.Gt(following, SCANNED + 1), NEARLY_FREE, DOUBTFUL), FREE_ANGLE)
    cost = Select(sp.Gt(real("error"), STALLED * BEFORE), sp.Integer(COST_OF_A_STALL), _ONE)
    return (
        Let(ANOTHER, sp.Le(LEFT, 0)),
        Let(LEFT_NOW, LEFT - cost),
        Let(following, ATTEMPT + Select(ANOTHER, _ONE, _ZERO)),
        Let(AGAIN, sp.And(MIRRORS, sp.Gt(LEFT, PASSES // 2)), "what is nearly free is known now"),
        Let(FREE, Select(AGAIN, DOUBTFUL, free)),
        Let(nearer, sp.And(is_scan(ATTEMPT), sp.Lt(LEFT_OVER, NEAREST))),
        Let(NEAREST_NOW, Select(nearer, LEFT_OVER, NEAREST)),
        Let(NEAREST_TURN_NOW, Select(nearer, TURN, NEAREST_TURN)),
        Let(
            FREE_TURN,
            Select(sp.Gt(following, SCANNED + 1), NEAREST_TURN_NOW + far, STEP * ToReal(following - 1)),
            "how far free angles are turned",
        ),
    )


def ending(closed: Sequence[Let]) -> Let:
    """The flag that ends all attempts: another start is wanted, but no angle is nearly free, so that it is the same."""
    tests = {test for let in closed for test in let.value.atoms(sp.StrictGreaterThan, sp.LessThan)}
    known = [sp.Gt(test.lhs, test.rhs) for test in tests if test.rhs.has(FREE)]
    return Let(ENDS, sp.And(ANOTHER, *known))


def is_scan(attempt: sp.Symbol) -> sp.Basic:
    """Whether an attempt is one of the scan: its start is rated, and no step is taken."""
    return sp.And(sp.Gt(attempt, 1), sp.Lt(attempt, SCAN_ENDS))


def refines(attempt: sp.Symbol) -> sp.Basic:
    """Whether an attempt is one beside the nearest of the scan."""
    return sp.And(sp.Gt(attempt, SCANNED + 1), sp.Lt(attempt, SCAN_ENDS))


def closed_form(mechanism: Mechanism, branch: Program) -> tuple[list[Let], dict[Joint, sp.Expr]]:
    """The closed form of a start under names of its own, and the axis values in it."""
    lets = [s for s in needed_for(branch.lets(), [o.value for o in branch.outputs]) if isinstance(s, Let)]
    names = {let.name: called(f"closed_{let.name.name}", let.name) for let in lets} | GOAL
    names |= {FREE_ANGLE: FREE}
    turned = {
        reference_value(j): {j.reference: Select(AGAIN, tried(j), j.reference + pow(LATTICE, k, SCANNED) * FREE_TURN)}
        for k, j in enumerate(mechanism.joints)
        if j.is_angle
    }
    found = [
        Let(names[let.name], let.value.xreplace(turned.get(let.name, {})).xreplace(names), let.note) for let in lets
    ]
    starts = {j: o.value.xreplace(names) for j, o in zip(mechanism.joints, branch.outputs, strict=True)}
    return found, starts
