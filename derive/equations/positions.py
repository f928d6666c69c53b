"""The equations of the commanded position for the joints of a chain that are still unknown: L^-1 p = M.

They are written again whenever joints become known: the known frames at the base are moved to the side of the commanded
point, one after the other, each coordinate under a name: `x_from_c` is the x of the point in the frame behind C. Where
the rotations of a machine are known, every slide that they carry is then alone in its equation.
"""

from __future__ import annotations

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.equations.known_turns import Side, is_unknown, joints_of, matrix_of, named_point, needed
from derive.equations.problem import Equation, Problem
from derive.geometry.frames import Chain, Motion
from derive.geometry.pose import pose_of
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES


def positions(problem: Problem) -> tuple[Equation, ...]:
    """The coordinates of L^-1 p = M; none where no joint at the base is known."""
    links = list(problem.links)
    point, lets = sp.Matrix(problem.point), list(problem.point_lets)
    side = Side("from", "base")
    while links and not is_unknown(problem, links[0]):
        known = links.pop(0)
        if known.motion is Motion.SHIFT:
            point[known.axis] -= known.amount
            continue
        before, side = side, side.behind(joints_of(problem, known), known)
        point = matrix_of(problem, known, lets).T * point
        if side != before:  # a turn by right angles only permutes the coordinates
            point = named_point(point, side.suffix, lets)
    if not side.joints:
        return ()
    return _equations(problem, sp.Matrix(pose_of(Chain(tuple(links))).position), point, (side.suffix, lets))


def _equations(
    problem: Problem, moving: sp.Matrix, point: sp.Matrix, seen: tuple[str, list[Let]]
) -> tuple[Equation, ...]:
    suffix, lets = seen
    found = []
    for name, left, right in zip(COORDINATE_NAMES, moving, point, strict=True):
        expression = polynomial(left, problem.units, problem.signs) - right
        if problem.unknowns_of(expression):
            found.append(Equation(f"{name}{suffix}", expression, needed(lets, expression)))
    return tuple(found)
