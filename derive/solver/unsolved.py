"""The message where subproblems do not solve a problem: the unknowns and equations that are left, and what would help.

First it is tested numerically whether the equations determine their unknowns: at a random pose of a random machine the
derivatives of all equations show which unknowns can move while the commanded values stay.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from derive.equations.known_turns import joints_of
from derive.equations.problem import Equation, Problem
from derive.ir.interpret import Array, evaluate
from derive.ir.symbols import POSITION, cosine, sine
from derive.solver.probe import DRAWS, drawn, turned

_SEED = 33
_STEP = 1e-5
_NOTHING = 1e-6
"""A derivative, or a part of a motion, below this is rounding: columns and rows are scaled to one."""
_ONE_KNOWN = ", or if one of these joints were known"
_THREE_AXES = "it would help if the axes of three neighbouring joints met in one point or were parallel" + _ONE_KNOWN
_TOOL_LINE = "it would help if the line of the tool, through its point, met the axis of the last joint" + _ONE_KNOWN
_WRITTEN = 120
"""The largest number of letters of an equation in a message; of a longer one the number of terms is stated."""


class Unsolved(Exception):
    """No subproblem fits what is left; the message tells the unknowns, the equations, and what would help."""

    steps: tuple[Any, ...] = ()
    """The steps (`solve.Step`) that were found before."""


class Exhausted(Unsolved):
    """The work that is allowed was done, and the derivation was not finished."""


class Undetermined(Unsolved):
    """The equations do not hold all unknowns: no rule and no search finds what nothing determines."""


def undetermined(problem: Problem) -> str | None:
    """The message where unknowns can move while the commanded values stay; None if the equations determine all."""
    unknowns = (*problem.lengths, *problem.angles)
    free, moving = _free(problem, unknowns) if unknowns else (0, [])
    if not free:
        return None
    if not problem.equations and not problem.turns:
        return f"the closure does not determine {_list(unknowns)}"
    several = _list([u for u, moves in zip(unknowns, moving, strict=True) if moves])
    too_many = f"{_count(unknowns)} in {_conditions(problem)} leave {free} free to move"
    return f"the closure does not determine {several}: {too_many}; {_more(problem, unknowns, free)}"


def unsolved(problem: Problem) -> str:
    """The message where no subproblem fits the equations that are left."""
    unknowns = (*problem.lengths, *problem.angles, *problem.pending)
    if not problem.equations and not problem.turns:
        return f"the closure does not determine {_list(unknowns)}"
    left = "".join(f"\n    {_written(problem, e)}" for e in problem.equations)
    return (
        f"no subproblem determines {_list(unknowns)}: {_count(unknowns)} in {_conditions(problem)}; {_help(problem)}"
        + (f"; equations left:{left}" if left else "")
    )


def with_advice(message: str, advice: str) -> str:
    """The message about a chain with what would help this machine, by the names and amounts of its axes."""
    for general in (_THREE_AXES, _TOOL_LINE):
        message = message.replace(general, advice or general, 1)
    return message


def _more(problem: Problem, unknowns: Sequence[sp.Symbol], free: int) -> str:
    """The advice on what would determine all unknowns."""
    if any(u in POSITION for u in unknowns):
        return f"state {'one more equation' if free == 1 else f'{free} more equations'}"
    more = "one more quantity" if free == 1 else f"{free} more quantities"
    pitch = "; where the position decides the heading of the tool, command its pitch and roll: Turning.PITCH_ROLL"
    hint = pitch if free == 1 and problem.turns and problem.columns == (2,) and not problem.followed else ""
    return f"command {more}, or leave out {'one' if free == 1 else free} of these joints{hint}"


def _help(problem: Problem) -> str:
    """The advice on what would make the problem solvable."""
    if problem.followed > 1 and _roll_moves_position(problem):
        return (
            "it would help if the tip were on the axis of the roll: leave out the shift across it behind that turn, "
            "which is the offset of a tool"
        )
    if problem.turns and len(problem.columns) < 3:  # with a free twist only points on the tool's axis are known
        return _TOOL_LINE
    if problem.turns:
        return _THREE_AXES
    return (
        "it would help if one equation had one of them alone, or if two equations were the coordinates of a point that "
        "one of them turns"
    )


def _roll_moves_position(problem: Problem) -> bool:
    """Whether the last turn moves the commanded point."""
    moving = [joints for turn in problem.turns if (joints := joints_of(problem, turn))]
    read = {u.name for e in problem.equations if e.is_length for u in problem.unknowns_of(e.expression)}
    return bool(moving) and not read.isdisjoint(moving[-1])


def _count(unknowns: Sequence[sp.Symbol]) -> str:
    return "1 unknown" if len(unknowns) == 1 else f"{len(unknowns)} unknowns"


def _conditions(problem: Problem) -> str:
    """The equations, by number and name, and the commanded rotation."""
    count = len(problem.equations)
    names = f"{count} equation{'' if count == 1 else 's'} ({', '.join(e.label for e in problem.equations)})"
    rotation = "the commanded rotation" if len(problem.columns) == 3 else "the commanded direction"
    return " and ".join([names] * bool(count) + [rotation] * bool(problem.turns))


def _written(problem: Problem, equation: Equation) -> str:
    text = f"{equation.label}: {equation.expression} = 0"
    if len(text) <= _WRITTEN:
        return text
    terms = len(sp.Add.make_args(equation.expression))
    return f"{equation.label}: {terms} terms in {_list(problem.unknowns_of(equation.expression))}"


def _list(unknowns: Sequence[sp.Symbol]) -> str:
    return ", ".join(u.name for u in unknowns)


def _free(problem: Problem, unknowns: tuple[sp.Symbol, ...]) -> tuple[int, list[bool]]:
    """The number of unknowns that can be chosen, and for each unknown whether it can move."""
    values = drawn(problem, [e.expression for e in problem.equations], np.random.default_rng(_SEED))
    columns = [_derivative(problem, values, unknown) for unknown in unknowns]
    matrices = np.stack(columns, axis=-1)  # draws, conditions, unknowns
    free, moving = len(unknowns), np.ones(len(unknowns), dtype=bool)
    for matrix in matrices:
        still = _motions(matrix)
        if len(still) < free:
            free, moving = len(still), np.any(np.abs(still) > _NOTHING, axis=0)
    return free, moving.tolist()


def _motions(matrix: Array) -> Array:
    """The motions of the unknowns that change nothing, by rows."""
    for axis in (1, 0):
        size = np.max(np.abs(matrix), axis=axis, keepdims=True, initial=0.0)
        matrix = np.where(size > _NOTHING, matrix / np.where(size > _NOTHING, size, 1.0), 0.0)
    padded = np.vstack([matrix, np.zeros((matrix.shape[1], matrix.shape[1]))])
    _, sizes, rows = np.linalg.svd(padded, full_matrices=False)
    return np.asarray(rows[sizes <= _NOTHING])


def _derivative(problem: Problem, values: Mapping[str, Array], unknown: sp.Symbol) -> Array:
    """The derivatives of all conditions by one unknown: draws, conditions."""
    above, below = (_at(problem, _moved(values, unknown, step)) for step in (_STEP, -_STEP))
    return np.asarray((above - below) / (2 * _STEP))


def _moved(values: Mapping[str, Array], unknown: sp.Symbol, step: float) -> dict[str, Array]:
    value = values[unknown.name] + step
    functions = {cosine(unknown).name: np.cos(value), sine(unknown).name: np.sin(value)}
    return {**values, unknown.name: value, **functions}


def _at(problem: Problem, values: Mapping[str, Array]) -> Array:
    """The left sides of all equations, and the entries of the rotation that the task commands: draws, conditions."""
    found = [np.broadcast_to(evaluate(e.expression, values), (DRAWS,)) for e in problem.equations]
    rotation = np.broadcast_to(np.eye(3), (DRAWS, 3, 3))
    for turn in problem.turns:
        amount = np.broadcast_to(evaluate(turn.amount, values), (DRAWS,))
        rotation = rotation @ turned(turn.axis, amount)
    entries = [rotation[:, i, j] for i in range(3) for j in problem.columns] if problem.turns else []
    return np.stack([*found, *entries, np.zeros(DRAWS)], axis=1)
