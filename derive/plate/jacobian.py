"""The Jacobian of a platform that a loop turns: from the lines of its legs, which are the rows of A (see `legs`)."""

from __future__ import annotations

import sympy as sp

from derive.description.mechanism import Mechanism, Plane, Turning
from derive.equations.closures.fixed_names import fixed_lets, with_fixed_names
from derive.equations.trigonometry import named_trigonometry
from derive.ir.constants import FREE_ANGLE
from derive.ir.program import Require, Solve, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import DETERMINANT, real
from derive.plate.legs import RADIUS, Leg, legs_of, names, rotation_axes, rotation_of, rows


def platform_jacobian(mechanism: Mechanism, motors: sp.Matrix) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The Jacobian A^-1 (-B) at a pose that forward kinematics has found."""
    joints = [j.symbol for j in mechanism.joints]
    driven = sp.Matrix([_driven(mechanism, leg).jacobian(joints) for leg in legs_of(mechanism)]) * motors
    lets, named = named_trigonometry(mechanism, list(driven))
    width, shifts = len(joints), len(mechanism.motion.position)
    words = (*(f"v{c}" for c in mechanism.motion.position), *(f"w{c}" for c in rotation_axes(mechanism)))
    entries = [real(f"column_{column}_{word}") for word in words for column in range(1, width + 1)]
    held = Require(sp.Gt(sp.Abs(DETERMINANT), FREE_ANGLE), Status.IMPOSSIBLE, reason=about_machine(Why.UNCONTROLLED))
    system = Solve(
        tuple(entries), rows(mechanism), tuple(named), None, "twist of the platform per velocity of each axis"
    )
    values = [e if k // width < shifts else e / RADIUS for k, e in enumerate(entries)]
    return (held, *fixed_lets(mechanism), *lets, system), _of_the_task(mechanism, values)


def _of_the_task(mechanism: Mechanism, twists: list[sp.Expr]) -> list[sp.Expr]:
    """The rows of the task, made from those of the platform: commanded coordinates, and tilts about the tool's axes."""
    if not mechanism.passive:
        return twists
    width, position = len(mechanism.joints), mechanism.motion.position
    matrix = sp.Matrix(len(twists) // width, width, twists)
    spin = matrix[len(position) :, :]
    if mechanism.task.turning is Turning.DIRECTION:
        spin = (rotation_of(mechanism).T * spin)[:2, :]
    kept = [position.index(c) for c in mechanism.task.position]
    return list(sp.Matrix.vstack(matrix.extract(kept, list(range(width))), spin))


def _driven(mechanism: Mechanism, leg: Leg) -> sp.Matrix:
    """The negative of a leg's residual as a function of the joints, at a constant direction: along . base + length; for
    a plane, its offset.
    """
    if isinstance(leg, Plane):
        return sp.Matrix([with_fixed_names(mechanism, leg.offset)])
    ahead = sum((a * b for a, b in zip(names("along", leg), leg.base, strict=True)), leg.length)
    return sp.Matrix([with_fixed_names(mechanism, ahead)])
