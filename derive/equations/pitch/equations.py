"""The equations of the pitch and of the roll, once the turns before them are known."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.algebra.normal_form import polynomial, reduce_units
from derive.equations.known_turns import between_known, is_unknown, joints_of, needed
from derive.equations.pitch.chain import matrix_of_turns
from derive.equations.problem import Equation, Problem
from derive.geometry.frames import Factor
from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import COORDINATE_NAMES, real

IN_PLANE = real("in_plane")
"""The length of the commanded direction's projection to the plane in which the pitch moves the tool."""


def followed_entries(problem: Problem) -> tuple[Equation, ...]:
    """The equations of the pitch once all turns before it are known, then those of the roll."""
    own = [t for t in problem.turns if joints_of(problem, t)]
    unknown = [t for t in problem.turns if is_unknown(problem, t)]
    if not unknown or unknown != own[-problem.followed :][-len(unknown) :]:
        return ()
    turns, entries, lets = between_known(problem, moves_last=problem.followed > 1)
    if len(unknown) == problem.followed:
        return _pitch(problem, turns, entries, lets)
    return _roll(problem, turns[0], entries, lets)


def _pitch(problem: Problem, turns: Sequence[Factor], entries: sp.Matrix, lets: list[Let]) -> tuple[Equation, ...]:
    """The direction of the tool, projected to the plane of the pitch and normalised."""
    seen, column = turns, 2
    if problem.followed > 1:
        seen, column = turns[:-1], turns[-1].axis
    moved = matrix_of_turns(seen)[:, column]
    plane = [i for i in range(3) if i != turns[0].axis]
    parts = [entries[i, column] for i in plane]
    divisor = real("in_plane_divisor")
    note = "length of the commanded direction in the plane in which the arm turns the tool"
    lets.append(Let(IN_PLANE, Root(sp.Add(*[p**2 for p in parts])), note))
    lets.append(Let(divisor, Select(sp.Gt(IN_PLANE, FREE_ANGLE), IN_PLANE, sp.Integer(1))))
    found: list[Equation] = []
    for i, part in zip(plane, parts, strict=True):
        name = real(f"tool_{COORDINATE_NAMES[i]}")
        lets.append(Let(name, part / divisor, "" if found else "the nearest direction that the arm can reach"))
        found.append(_equation(problem, f"pitch {COORDINATE_NAMES[i]}", moved[i], name, lets))
    return tuple(found)


def _roll(problem: Problem, turn: Factor, entries: sp.Matrix, lets: list[Let]) -> tuple[Equation, ...]:
    """The turn about the axis of the tool that is nearest to the remaining commanded rotation."""
    i, j = (turn.axis + 1) % 3, (turn.axis + 2) % 3
    along, across, length, divisor = (real(f"roll_{w}") for w in ("along", "across", "length", "divisor"))
    lets += [
        Let(along, entries[i, i] + entries[j, j], "the roll: nearest turn about the axis of the tool"),
        Let(across, entries[j, i] - entries[i, j]),
        Let(length, Root(along**2 + across**2)),
        Let(divisor, Select(sp.Gt(length, FREE_ANGLE), length, sp.Integer(1))),
    ]
    cos_roll, sin_roll = real("cos_roll"), real("sin_roll")
    lets += [Let(cos_roll, along / divisor), Let(sin_roll, across / divisor)]
    return (
        _equation(problem, "cos roll", sp.cos(turn.amount), cos_roll, lets),
        _equation(problem, "sin roll", sp.sin(turn.amount), sin_roll, lets),
    )


def _equation(problem: Problem, label: str, moved: sp.Expr, name: sp.Symbol, lets: list[Let]) -> Equation:
    form = polynomial(moved, problem.units, problem.signs)
    expression = reduce_units(form - name, problem.units, problem.signs)
    return Equation(label, expression, needed(lets, expression), is_length=False)


def with_refusal(statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The statements, which refuse a direction at right angles to the plane of the arm: no direction in the plane is
    nearest to it.
    """
    refusal = Require(sp.Gt(IN_PLANE, FREE_ANGLE), Status.UNREACHABLE, reason=about_machine(Why.ACROSS))
    found: list[Statement] = []
    for statement in statements:
        found.append(statement)
        if isinstance(statement, Let) and statement.name == IN_PLANE:
            found.append(refusal)
    return tuple(found)
