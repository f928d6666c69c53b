"""The rotations that the flange can have: their programs, which an orientation kinematics behind it calls."""

from __future__ import annotations

import sympy as sp

from derive.description.mechanism import Mechanism, Turning
from derive.equations.closures.commanded import heading_of
from derive.geometry.pose import pose_of
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.ir.symbols import ROTATION_ENTRIES, real
from derive.kinematics.differential import TWIST_ROWS, jacobian_rows
from derive.kinematics.inverse import heading_lets, rotation_behind
from derive.kinematics.kinematics import Freedom


def projection_program(mechanism: Mechanism) -> Program:
    """The rotation of the flange nearest to the commanded one; if it follows a direction, with any twist about it.

    The rotation of a pitch depends on the position, too, so there is no projection before the position is known.
    """
    if mechanism.task.turning is Turning.ABOUT_Z:
        return projection_about_z(rotation_behind(mechanism))
    return normalise("projection", (), [Output(r.name, r) for r in ROTATION_ENTRIES])


def projection_about_z(behind: sp.Matrix) -> Program:
    """The rotation nearest to the commanded one that is a turn about z, with the rotation of the flange behind it."""
    cos_heading, sin_heading = real("cos_heading"), real("sin_heading")
    turned = sp.Matrix([[cos_heading, -sin_heading, 0], [sin_heading, cos_heading, 0], [0, 0, 1]])
    outputs = [Output(r.name, v) for r, v in zip(ROTATION_ENTRIES, turned * behind, strict=True)]
    return normalise("projection", heading_lets(behind), outputs)


def needs_twist(mechanism: Mechanism) -> bool:
    """Whether the Jacobian lacks rows of the twist that are not zero: a coupling and a turned base need them."""
    return freedom_of(mechanism) is not Freedom.ZERO and not set(TWIST_ROWS) <= set(jacobian_rows(mechanism))


def freedom_of(mechanism: Mechanism) -> Freedom:
    """The orientations that the flange can have."""
    if mechanism.motion.turning is Turning.FULL or mechanism.followed_turns:
        return Freedom.THREE
    if mechanism.chain is None:
        return Freedom.ONE if mechanism.is_turning_loop else Freedom.ZERO
    joints = {j.symbol for j in mechanism.joints}
    turns = [t for t in pose_of(mechanism.chain).turns if t.amount.free_symbols & joints]  # parallel turns are merged
    return Freedom.THREE if len(turns) > 1 else Freedom.ONE if turns else Freedom.ZERO


def _one_turn(mechanism: Mechanism) -> tuple[sp.Matrix, sp.Matrix]:
    """The axis about which the flange turns, in the frame of the machine, and its rotation where the turn is zero."""
    assert mechanism.chain is not None
    if mechanism.task.turning is Turning.ABOUT_Z:
        heading_of(mechanism.chain)  # refuses a chain whose rotation is not one turn about z
    joints = {j.symbol for j in mechanism.joints}
    axis, zero = sp.Matrix([0, 0, 1]), sp.eye(3)
    for turn in pose_of(mechanism.chain).turns:
        if turn.amount.free_symbols & joints:
            axis = zero[:, turn.axis]
        else:
            zero = zero * turn.matrix()[:3, :3]
    return axis, zero


def image_program(mechanism: Mechanism) -> Program:
    """The orientations that the flange can take: one of them, and the axis of its rotation in both frames."""
    zero = sp.eye(3)
    axis = sp.Matrix([0, 0, 1])
    if mechanism.chain is not None and freedom_of(mechanism) is not Freedom.THREE:
        zero = sp.Matrix(pose_of(mechanism.chain).rotation)
        if freedom_of(mechanism) is Freedom.ONE:
            axis, zero = _one_turn(mechanism)
    moving = zero.T * axis
    outputs = [Output(f"zero_{r.name}", v) for r, v in zip(ROTATION_ENTRIES, zero, strict=True)]
    outputs += [Output(f"rot_{c}", v) for c, v in zip("xyz", axis, strict=True)]
    outputs += [Output(f"u_{c}", v) for c, v in zip("xyz", moving, strict=True)]
    return normalise("image", (), outputs)
