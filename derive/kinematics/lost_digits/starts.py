"""Where the steps on the closure start: the attempts, and the closed form with nearly free angles turned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.equations.axes import reference_value
from derive.ir.constants import (
    DOUBTFUL,
    FREE_ANGLE,
    HARDLY_NEARER,
    LATTICE,
    NEAR,
    NEARLY_FREE,
    REFINED,
    SCANNED,
    STALLS,
    STARTS,
)
from derive.ir.passes import needed_for
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Program
from derive.ir.symbols import POSITION, ROTATION_ENTRIES, called, count, flag, real

GOAL = {name: real(f"goal_{name.name}") for name in (*POSITION, *ROTATION_ENTRIES)}
"""The names of the commanded pose in this program."""
DRAWN = {name: real(f"drawn_{name.name}") for name in GOAL}
"""The pose that a machine with deviations would have as it is drawn."""
ASKED = {name: real(f"asked_{name.name}") for name in GOAL}
"""The pose of which its closed form is asked: if steps meet the goal on another branch, that of the drawing there."""
LEFT, ATTEMPT, LEAST = count("stalls_left"), count("attempt"), real("least_error")
ANOTHER, MIRRORS, IS_MET = flag("another"), flag("mirrors"), flag("pose_is_met")
LEFT_NOW = count("stalls_left_now")
TURN, BESIDE = real("turn_of_attempt"), real("turn_beside")
AGAIN = flag("from_the_met_pose")
ENDS, SCANS = flag("no_start_is_left"), flag("scans")
FREE, FREE_TURN = real("free_angle"), real("free_turn")
LEFT_OVER = real("error_left")
NEAREST, NEAREST_TURN = real("least_error_left"), real("nearest_turn")
NEAREST_NOW, NEAREST_TURN_NOW = real("least_error_left_now"), real("nearest_turn_now")
STEP = sp.Rational(360, SCANNED)
"""How far (degrees) free angles are turned from one attempt of the scan to the next."""
AROUND = sp.Float(360 / STARTS)
"""The same from one of the starts all around the circle to the next: a number, which costs no division."""
REFINING_BEGINS = SCANNED + 2
SCAN_ENDS = REFINING_BEGINS + REFINED
LAST = SCAN_ENDS + STARTS
"""The attempts: 0 from the given start, 1 with nearly free angles at the reference, then one of the scan each, some
beside the nearest, ever closer, and one from the nearest of all. The scan turns angles that hardly move the pose, which
steps do not find. Then steps are taken with nearly free angles all around the circle: where an angle is free next to
one value alone of another, one step does not tell how near a start is.
"""
OFTEN_FREE = sp.Float("0.1")
"""The conditioning at which the closed form of a drawing tells little of an angle of a machine with deviations."""
BEYOND = real("beyond_the_start")
"""How far, from where the steps ended, an attempt starts beyond what the closed form gives: they ended beside a fold.
"""
MOVES = 6
"""The attempts before these of a machine with deviations, whose drawing is asked for a pose that is moved."""
_ZERO, _ONE = sp.Integer(0), sp.Integer(1)


def tried(joint: Joint) -> sp.Symbol:
    """The axis value at which a pass is."""
    return real(f"tried_{joint.key}")


def next_attempt(following: sp.Symbol, deviates: bool) -> tuple[Let, ...]:
    """Whether another start is taken, which one, and what is free there."""
    nearer = flag("is_nearer")
    is_refined, is_around = sp.Ge(following, REFINING_BEGINS), sp.Gt(following, SCAN_ENDS)
    is_scanned = sp.And(sp.Gt(following, 1), sp.Le(following, SCAN_ENDS))
    far_from_free, nearer_free = (OFTEN_FREE, OFTEN_FREE) if deviates else (DOUBTFUL, NEARLY_FREE)
    free = Select(sp.Gt(following, 0), Select(is_scanned, nearer_free, far_from_free), FREE_ANGLE)
    stalls = sp.Or(MIRRORS, sp.Gt(real("error"), HARDLY_NEARER * LEAST))
    is_far = sp.And(sp.Eq(ATTEMPT, REFINING_BEGINS - 1), sp.Gt(NEAREST_NOW, NEAR))
    around = AROUND * ToReal(following - SCAN_ENDS)
    scanned = STEP * ToReal(following - 1)
    refined = NEAREST_TURN_NOW + Select(refines(following), BESIDE, _ZERO)
    return (
        Let(ANOTHER, sp.Le(LEFT, 0)),
        Let(LEFT_NOW, LEFT - Select(stalls, _ONE, _ZERO)),
        Let(nearer, sp.And(is_scan(ATTEMPT), sp.Lt(LEFT_OVER, NEAREST))),
        Let(NEAREST_NOW, Select(nearer, LEFT_OVER, NEAREST)),
        Let(NEAREST_TURN_NOW, Select(nearer, TURN, NEAREST_TURN)),
        Let(following, Select(is_far, sp.Integer(SCAN_ENDS), ATTEMPT + Select(ANOTHER, _ONE, _ZERO))),
        Let(SCANS, is_scan(following)),
        Let(AGAIN, sp.And(MIRRORS, sp.Gt(LEFT, STALLS // 2)), "what is nearly free is known now"),
        Let(FREE, Select(AGAIN, FREE_ANGLE if deviates else DOUBTFUL, free)),
        *(_asked(following) if deviates else ()),
        Let(
            FREE_TURN, Select(is_around, around, Select(is_refined, refined, scanned)), "how far free angles are turned"
        ),
    )


def _asked(following: sp.Symbol) -> Iterator[Let]:
    """The pose of which the closed form of a machine with deviations is asked: that of the drawing where the steps are,
    moved by what they miss; in the attempts of every machine the goal.
    """
    moves = flag("moves_the_goal")
    yield Let(moves, sp.Or(MIRRORS, sp.Le(following, 0)))
    tries = ToReal(following + MOVES - 1)
    yield Let(BEYOND, Select(sp.And(ANOTHER, sp.Lt(following, 0)), tries**2, _ZERO))
    goal, here, drawn = (
        sp.Matrix(3, 3, [table[r] for r in ROTATION_ENTRIES])
        for table in (GOAL, {r: r for r in ROTATION_ENTRIES}, DRAWN)
    )
    missed = [GOAL[c] - c for c in POSITION]
    moved = [*(DRAWN[c] + m for c, m in zip(POSITION, missed, strict=True)), *(goal * here.T * drawn)]
    for (name, asked), value in zip(ASKED.items(), moved, strict=True):
        yield Let(asked, Select(moves, value, GOAL[name]))


def ending(closed: Sequence[Let], *further: sp.Basic) -> Let:
    """The flag that ends all attempts: another start is wanted, but no angle is nearly free, so that it is the same.
    further: what has to hold, too.
    """
    tests = {test for let in closed for test in let.value.atoms(sp.StrictGreaterThan, sp.LessThan)}
    known = [sp.Gt(test.lhs, test.rhs) for test in tests if test.rhs.has(FREE)]
    return Let(ENDS, sp.And(ANOTHER, *known, *further))


def is_scan(attempt: sp.Symbol) -> sp.Basic:
    """Whether an attempt is one of the scan: its start is rated, and no step is taken."""
    return sp.And(sp.Gt(attempt, 1), sp.Lt(attempt, SCAN_ENDS))


def refines(attempt: sp.Symbol) -> sp.Basic:
    """Whether an attempt is one beside the nearest of the scan."""
    return sp.And(sp.Ge(attempt, REFINING_BEGINS), sp.Lt(attempt, SCAN_ENDS))


def closed_form(mechanism: Mechanism, branch: Program, deviates: bool) -> tuple[list[Let], dict[Joint, sp.Expr]]:
    """The closed form of a start under names of its own, and the axis values in it."""
    lets = [s for s in needed_for(branch.lets(), [o.value for o in branch.outputs]) if isinstance(s, Let)]
    names = {let.name: called(f"closed_{let.name.name}", let.name) for let in lets} | (ASKED if deviates else GOAL)
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
