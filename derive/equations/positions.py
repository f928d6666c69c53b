"""The equations of the commanded position for the joints of a chain that are still unknown: L^-1 p = M.

They are written again whenever joints become known: the known frames at the base are moved to the side of the commanded
point, one after the other, and each coordinate gets a name: `x_from_c` is the x of the point in the frame behind C.
Where the rotations of a machine are known, every slide behind them is then alone in its equation.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import polynomial, reduce_units
from derive.equations.chain_splits import Target, Unknowns, views
from derive.equations.known_turns import Side, is_unknown, joints_of, matrix_of, named_point, needed
from derive.equations.problem import Equation, Problem
from derive.geometry.frames import Chain, Factor, Motion
from derive.geometry.pose import pose_of
from derive.ir.primitives import Root
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, real


def positions(problem: Problem) -> tuple[Equation, ...]:
    """The coordinates of L^-1 p = M; none if no joint at the base is known."""
    links, point, side, lets = behind_known(problem, Side("from", "base"))
    if not side.joints:
        return ()
    return _equations(problem, sp.Matrix(pose_of(Chain(tuple(links))).position), point, (side.suffix, lets))


def positions_and_distance(problem: Problem) -> tuple[Equation, ...]:
    """The coordinates of L^-1 p = M, and the square of their sum: the distance from a point on the first unknown axis,
    which is free of its angle.
    """
    links, point, side, lets = behind_known(problem, Side("from", "base"))
    moving = [polynomial(v, problem.units, problem.signs) for v in pose_of(Chain(tuple(links))).position]
    square = reduce_units(sum(v**2 for v in moving), problem.units, problem.signs)
    reach = real(f"distance{side.suffix}")
    far = Let(reach, Root(sum(v**2 for v in point)), "distance of the point from the first axis that is not known")
    both = (side.suffix, lets)
    label = " + ".join(f"{c}²" for c in COORDINATE_NAMES)
    return (
        *_equations(problem, sp.Matrix(moving), point, both),
        Equation(label, square - reach**2, (*needed(lets, far.value), far)),
    )


def positions_from_flange(problem: Problem) -> tuple[Equation, ...]:
    """`positions` for the point in which the first joints intersect, seen from the flange: once joints between the two
    are known, an equation may hold one other joint alone.
    """
    if problem.back is None or problem.pending:
        return ()
    links, point, lets = problem.back
    seen = replace(problem, links=links, point=point, point_lets=lets)
    rest, known, _, named = behind_known(seen, Side("back", "flange"))
    unknowns = Unknowns(problem.angles, problem.lengths, problem.units, problem.signs)
    found = [e for view in views(rest, Target(tuple(known), tuple(named)), unknowns) for e in view]
    return tuple(replace(e, lets=needed(named, e.expression)) for e in found if problem.unknowns_of(e.expression))


def behind_known(problem: Problem, side: Side) -> tuple[list[Factor], sp.Matrix, Side, list[Let]]:
    """The links behind the known joints at the base, the point seen from there, the frame, and bindings of names."""
    links = list(problem.links)
    point, lets = sp.Matrix(problem.point), list(problem.point_lets)
    while links and not is_unknown(problem, links[0]):
        known = links.pop(0)
        if known.motion is Motion.SHIFT:
            point[known.axis] -= known.amount
            continue
        before, side = side, side.behind(joints_of(problem, known), known)
        point = matrix_of(problem, known, lets).T * point
        if side != before:  # a turn by right angles only permutes the coordinates
            point = named_point(point, side.suffix, lets)
    return links, point, side, lets


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
