"""The joint that turns the plane of an arm, where the position leaves it free: the tool's direction determines it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.algebra.normal_form import split_known
from derive.description.mechanism import Joint, Mechanism
from derive.equations.axes import reference_value
from derive.equations.pitch.chain import followed_of, matrix_of_turns
from derive.equations.problem import sign_of
from derive.geometry.frames import Factor
from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import Atan2, Root, Select
from derive.ir.program import Let
from derive.ir.symbols import real

_LEAN = real("heading_length")


def free_heading(mechanism: Mechanism, steps: Sequence[sp.Symbol] = ()) -> tuple[tuple[Let, ...], sp.Symbol | None]:
    """The joint that turns the plane: where the position does not determine it, the tool's direction does.

    Two turns hold the direction in the plane: one for each sign of the step of that joint, where it has two roots
    (`steps`), else the one nearer to the reference. If the tool is along the axis of the joint, the joint takes its
    reference. Returns the statements, which bind `free_value` of the joint, and the joint; none if more or fewer
    than one joint turns the plane.
    """
    found = followed_of(mechanism)
    joints = {j.symbol: j for j in mechanism.solved_joints if j.is_angle}
    moving = [k for k, t in enumerate(found.before) if t.amount.free_symbols & joints.keys()]
    if len(moving) != 1:
        return (), None
    turn = found.before[moving[0]]
    own, known = split_known(turn.amount, joints)
    sense = next((s for j in joints for s in (1, -1) if own == s * j), 0)
    square = matrix_of_turns(found.before[moving[0] + 1 :])[:, found.pitch.axis]
    base = matrix_of_turns(found.before[: moving[0]])
    if not sense or known.free_symbols or square[turn.axis] != 0 or base.free_symbols:
        return (), None
    joint = joints[sp.sympify(own * sense)]
    side = sign_of(joint.symbol) if joint.symbol in steps else None
    return _heading_lets(base.T * found.commanded, turn, square, _Heading(joint, sense, known, side)), joint.symbol


def free_value(joint: sp.Symbol) -> sp.Symbol:
    """The name of the value of a joint where the position leaves it free."""
    return real(f"free_{joint.name}")


@dataclass(frozen=True)
class _Heading:
    """The joint that turns the plane, its sense, a fixed angle added to it, and the sign of its step."""

    joint: Joint
    sense: int
    known: sp.Expr
    side: sp.Symbol | None


def _heading_lets(seen: sp.Matrix, turn: Factor, square: sp.Matrix, of: _Heading) -> tuple[Let, ...]:
    """See `free_heading`; seen: the direction in front of the turn, square: the axis of the pitch behind it."""
    i, j = (turn.axis + 1) % 3, (turn.axis + 2) % 3
    along, across, side = real("heading_along"), real("heading_across"), real("heading_side")
    reference, symbol = reference_value(of.joint), of.joint.symbol
    turned = of.sense * reference + of.known
    agrees = sp.Ge(along * sp.cos(turned) + across * sp.sin(turned), 0)
    angle = Atan2(side * across, side * along)
    return (
        Let(along, square[i] * seen[j] - square[j] * seen[i], f"{symbol.name} where the position leaves it free"),
        Let(across, -square[i] * seen[i] - square[j] * seen[j]),
        Let(_LEAN, Root(along**2 + across**2)),
        Let(side, Select(agrees, sp.Integer(1), sp.Integer(-1)) if of.side is None else of.side),
        Let(free_value(symbol), Select(sp.Gt(_LEAN, FREE_ANGLE), of.sense * angle - of.sense * of.known, reference)),
    )
