"""The equation of a joint behind which two axes meet: their point of intersection has a known distance from the
commanded point.

Seen from the first unknown joint, the chain is a circle and a sphere. The joint carries the point in which the next
two axes meet along a circle (a slide: along a line); the two joints move the commanded point on a sphere about it. The
square of its radius is known, so that the first joint is the only unknown. Pieper solves an arm with three joints whose
last two axes meet by this step; seen from the flange it is an arm whose middle and last axes meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import polynomial, reduce_units
from derive.equations.known_turns import Side, is_unknown, needed
from derive.equations.positions import behind_known
from derive.equations.problem import Equation, Problem
from derive.geometry.frames import Chain, Factor, Motion
from derive.geometry.pose import pose_of
from derive.solver.probe import unknowns_of_squares


def circles_and_spheres(problem: Problem) -> tuple[Equation, ...]:
    """The equation of the squared distance between the commanded point and the point in which the axes behind the first
    unknown joint meet, and the same equation for the chain seen from its flange.
    """
    seen = [(problem, Side("from", "base"))]
    if problem.back is not None:
        links, point, lets = problem.back
        seen.append((replace(problem, links=links, point=point, point_lets=lets), Side("back", "flange")))
    return tuple(equation for one in seen for equation in _circle_and_sphere(*one))


def _circle_and_sphere(problem: Problem, side: Side) -> tuple[Equation, ...]:
    links, point, side, lets = behind_known(problem, side)
    parted = _at_the_meeting(problem, links)
    if parted is None:
        return ()
    circle, sphere = (_position(problem, part) for part in parted)
    if unknowns_of_squares(problem, [s for s in sphere if s != 0]):
        return ()
    squares = sum(((p - c) ** 2 for p, c in zip(point, circle, strict=True)), start=sp.Integer(0))
    radius = sum((s**2 for s in sphere), start=sp.Integer(0))
    expression = reduce_units(squares - radius, problem.units, problem.signs)
    if len(problem.unknowns_of(expression)) != 1:
        return ()
    return (Equation(f"distance{side.suffix}²", expression, needed(lets, expression)),)


def _at_the_meeting(problem: Problem, links: Sequence[Factor]) -> tuple[list[Factor], list[Factor]] | None:
    """The links up to the axis of the second unknown joint and along it, and the links behind it, without its turn."""
    second = next((i for i, f in enumerate(links) if i > 0 and is_unknown(problem, f)), None)
    if second is None or links[second].motion is not Motion.TURN:
        return None
    fixed = second + 1
    while fixed < len(links) and links[fixed].motion is Motion.SHIFT and not is_unknown(problem, links[fixed]):
        fixed += 1
    along = [f for f in links[second + 1 : fixed] if f.axis == links[second].axis]
    beside = [f for f in links[second + 1 : fixed] if f.axis != links[second].axis]
    return [*links[:second], *along], [*beside, *links[fixed:]]


def _position(problem: Problem, links: Sequence[Factor]) -> list[sp.Expr]:
    return [polynomial(v, problem.units, problem.signs) for v in pose_of(Chain(tuple(links))).position]
