"""Root scan: one joint is tried around the circle, and the others are solved at each trial; a root leaves no residual.

Three programs with the same inputs. `try_joint` computes the residual of the closure at a trial, and its slope (see
`FindRoot`). `finish_root` computes the joints at a root, improves them by Newton's method on the closure, and tells
whether they lie on the wanted branch. `find_root` finds the root that is nearest to the reference; `ir/roots` says how.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Mechanism, Turning
from derive.equations.axes import reference_value
from derive.equations.named_pose import named_pose
from derive.ir.constants import BOUNDARY, DAMPED, IMPROVEMENTS, MET, NEARLY
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select
from derive.ir.program import FindRoot, Iterate, Let, Output, Program, Solve, Statement, Status, rewritten
from derive.ir.symbols import (
    COORDINATE_NAMES,
    FREED,
    FREED_ANGLE,
    PLACE,
    ROTATION_ENTRIES,
    SCALE,
    TRIED,
    cosine,
    count,
    flag,
    real,
    sine,
)
from derive.kinematics.differential import scaled_entries, solved_entries
from derive.kinematics.scan.guards import conditions_of, least, room_of
from derive.kinematics.scan.slopes import slope_name, with_slopes

START = real("start")
LOOKED_FOR = flag("looked_for")
GOAL = {real(c): real(f"goal_{c}") for c in COORDINATE_NAMES} | {r: real(f"goal_{r.name}") for r in ROTATION_ENTRIES}
"""The names of the commanded pose in these programs."""
AGREEMENT = real("agreement")
FITS = "fits"
FOUND = flag("found")
"""Whether there is a root on the wanted branch."""
_ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Trial:
    """One trial: statements that solve the other joints with the scanned one at `TRIED`, and the residual that they
    leave.
    """

    statements: tuple[Let, ...]
    value: sp.Expr
    """The residual, a number without a unit."""
    guard: sp.Expr
    """Negative where the other joints have no solution."""
    angles: tuple[sp.Symbol, ...]
    """The angles that may be free, and turn fast near the pose where they are."""


def try_program(trial: Trial) -> Program:
    """The program of a trial: residual and guard with their slopes, and the directions of angles that may turn fast."""
    value, guard = real("value"), real("guard")
    left = Let(value, trial.value, "residual of the closure")
    differentiated = with_slopes([*_roots_named(trial.statements), left, Let(guard, trial.guard)], TRIED)
    bound = {s.name for s in differentiated if isinstance(s, Let)}
    slopes = [slope_name(n) if slope_name(n) in bound else _ZERO for n in (value, guard)]
    outputs = [
        Output("remainder", value),
        Output("slope", slopes[0]),
        Output("room", guard),
        Output("room_slope", slopes[1]),
    ]
    for number, angle in enumerate(trial.angles, 1):
        outputs += [Output(f"direction_{number}_cos", cosine(angle)), Output(f"direction_{number}_sin", sine(angle))]
    program = normalise("try_joint", differentiated, outputs)
    return replace(
        program, summary="The residual of the closure at a trial, its slope, and the angles that may turn fast"
    )


def find_program(
    mechanism: Mechanism, trial: Program, finish: Program, arguments: Sequence[sp.Symbol], sides: tuple[int, ...] = ()
) -> Program:
    """The program that finds the root on the wanted branch that is nearest to the start.

    sides: those of the candidates that the trial lists; none where it is scanned.
    """
    search = mechanism.search
    assert search is not None
    names = (FOUND, *(real(o.name) for o in finish.outputs[1:]))
    note = f"{'roots' if sides else 'root scan'} along {search.joint.name}"
    is_always = search.where is None
    wanted = sp.true if is_always else LOOKED_FOR
    found = FindRoot(trial, finish, START, wanted, names, tuple(arguments), note, sides)
    program = normalise("find_root", (found,), [Output(n.name, n) for n in names])
    otherwise = "there is none" if is_always else "the machine needs no scan"
    return replace(program, summary=f"The joints at the root that is nearest to the start; zeros where {otherwise}")


def finish_program(
    mechanism: Mechanism, trial: Sequence[Statement], wanted: Sequence[sp.Expr], determinant: sp.Symbol
) -> Program:
    """The program that computes the joints at a root, and whether they fit: no value in `wanted` may be negative."""
    joints = [j.symbol for j in mechanism.solved_joints]
    held = [Let(j.symbol, reference_value(j)) for j in mechanism.held_joints]
    solved = {j: solved_value(mechanism, j) for j in joints}
    error = real("error")
    conditions = [sp.Le(error, MET), *(sp.Ge(w, -NEARLY) for w in wanted)]
    loop, jacobian = newton(mechanism, [solved[j] for j in joints])
    last = Solve((), jacobian, (), determinant, "determinant of the Jacobian, positions in characteristic lengths")
    fits = Let(flag(FITS), sp.And(*conditions))
    outputs = [Output(FITS, fits.name), *(Output(f"found_{j.symbol.name}", j.symbol) for j in mechanism.joints)]
    program = normalise("finish_root", (*trial, *held, loop, last, fits), outputs)
    return replace(
        program, summary="The joints at a root, improved by Newton's method, and whether they are on the branch"
    )


def solved_value(mechanism: Mechanism, joint: sp.Symbol) -> sp.Expr:
    """The value of a joint in a trial."""
    if any(j.symbol == joint and not j.is_angle for j in mechanism.joints):
        return real(f"{joint.name}_tried")
    return Atan2(real(f"{sine(joint).name}_tried"), real(f"{cosine(joint).name}_tried"))


def newton(mechanism: Mechanism, start: Sequence[sp.Expr]) -> tuple[Iterate, tuple[sp.Expr, ...]]:
    """Newton's method on the closure: a step is taken where the next error, about its square, is smaller than this one.

    The step is that of damped least squares, J^T (J J^T + d^2)^-1 e. Where the machine is singular it leaves an error
    that only a long step could remove: there a root is known to a few digits, and the long step would lead away from
    it.
    """
    joints = [j.symbol for j in mechanism.solved_joints]
    lengths = {j.symbol for j in mechanism.solved_joints if not j.is_angle}
    composed, (lets, entries) = named_pose(mechanism), solved_entries(mechanism)
    pose = [Let(n, v) for n, v in zip(GOAL, (*composed.position, *composed.rotation), strict=True)]
    scaled = list(scaled_entries(mechanism, entries))
    errors = [Let(real(f"error_{k}"), v) for k, v in enumerate(_errors(mechanism), 1)]
    names = [let.name for let in errors]
    steps = tuple(real(f"step_{j.name}") for j in joints)
    pairs = list(zip(joints, steps, strict=True))
    error, passes, taken = real("error"), count("passes"), flag("taken")
    agreement = _agreement(mechanism)
    squares = [*(n**2 for n in names), *(Select(sp.Gt(let.name, 1), _ZERO, sp.Integer(1)) for let in agreement)]
    rates, jacobian = _named_entries(scaled, len(joints))
    body = (
        *composed.statements,
        *pose,
        *errors,
        *agreement,
        Let(error, Root(sp.Add(*squares)), "pose error, in characteristic lengths and radians"),
        *lets,
        *rates,
        *_shortest_step(jacobian, names, steps),
        *_taken(steps, error, taken),
    )
    loop = Iterate(
        state=(*joints, passes),
        start=(*start, _ZERO),
        step=tuple(s for s in body if isinstance(s, Let | Solve)),
        following=(*(j + Select(taken, _way(j, s, lengths), _ZERO) for j, s in pairs), passes + 1),
        done=sp.Or(sp.Le(error, BOUNDARY / 100), sp.Ge(passes, IMPROVEMENTS), sp.Not(taken)),
        limit=IMPROVEMENTS + 1,
        otherwise=Status.UNREACHABLE,
        note="Newton's method on the closure",
    )
    return loop, tuple(jacobian)


def _way(joint: sp.Symbol, step: sp.Symbol, lengths: Container[sp.Symbol]) -> sp.Expr:
    """The step of a joint: that of a slide is counted in lengths of the machine."""
    return step * SCALE if joint in lengths else step


def _taken(steps: Sequence[sp.Symbol], error: sp.Symbol, taken: sp.Symbol) -> tuple[Let, Let]:
    """The statements that tell whether a step is taken."""
    size = real("size")
    return (
        Let(size, sp.Add(*[s**2 for s in steps])),
        Let(taken, sp.Le(size, error), "whether the error becomes smaller"),
    )


def _named_entries(entries: Sequence[sp.Expr], width: int) -> tuple[list[Let], sp.Matrix]:
    """The statements that bind the entries of the Jacobian, and the Jacobian by their names."""
    names = [v if v.is_number else real(f"rate_{k // width + 1}_{k % width + 1}") for k, v in enumerate(entries)]
    lets = [Let(name, value) for name, value in zip(names, entries, strict=True) if not value.is_number]
    return lets, sp.Matrix(len(entries) // width, width, names)


def _shortest_step(jacobian: sp.Matrix, errors: Sequence[sp.Symbol], steps: Sequence[sp.Symbol]) -> list[Let | Solve]:
    """The step of damped least squares, J^T (J J^T + d^2)^-1 e."""
    size, product = len(errors), jacobian * jacobian.T
    upper = [(i, j) for i in range(size) for j in range(i, size)]
    names = {(i, j): real(f"product_{i + 1}_{j + 1}") for i, j in upper}
    multipliers = tuple(real(f"multiplier_{k + 1}") for k in range(size))
    matrix = tuple(names[min(i, j), max(i, j)] for i in range(size) for j in range(size))
    return [
        *(Let(names[i, j], product[i, j] + (DAMPED if i == j else 0)) for i, j in upper),
        Solve(
            multipliers, matrix, tuple(errors), None, "damped least squares: the shortest step that cancels the error"
        ),
        *(Let(step, value) for step, value in zip(steps, jacobian.T * sp.Matrix(multipliers), strict=True)),
    ]


def _agreement(mechanism: Mechanism) -> list[Let]:
    """The statements that distinguish a rotation that agrees with the goal from one half a turn away, whose error also
    vanishes.
    """
    if mechanism.task.turning is Turning.NONE:
        return []
    trace = sp.Add(*[GOAL[r] * r for r in ROTATION_ENTRIES])
    return [Let(AGREEMENT, trace, "3 where the rotations agree, -1 where they are half a turn apart")]


def _errors(mechanism: Mechanism) -> list[sp.Expr]:
    """The error to the goal: a shift in characteristic lengths, and the vector of the rotation to
    it (its skew part), where a rotation is commanded.
    """
    places = [(GOAL[real(c)] - real(c)) / SCALE for c in COORDINATE_NAMES]
    if mechanism.task.turning is Turning.NONE:
        return places
    here = sp.Matrix(3, 3, ROTATION_ENTRIES)
    turn = sp.Matrix(3, 3, [GOAL[r] for r in ROTATION_ENTRIES]) * here.T
    return [*places, *((turn[i, j] - turn[j, i]) / 2 for i, j in ((2, 1), (0, 2), (1, 0)))]


def trial_of(statements: Sequence[Statement], value: sp.Expr, angles: Sequence[tuple[sp.Symbol, sp.Symbol]]) -> Trial:
    """A trial from solved statements. angles: those that may be free, each with its value where it is."""
    rooms, guard = _rooms(conditions_of(statements))
    found: list[Let] = []
    choices: dict[sp.Expr, sp.Expr] = {}
    conditions: dict[sp.Expr, sp.Basic] = {}
    for number, (angle, reference) in enumerate(angles):
        chosen = real(f"chosen_{angle.name}")
        is_freed = sp.Eq(FREED, number)
        found.append(
            Let(chosen, Select(is_freed, FREED_ANGLE, reference), f"{angle.name} where the pose leaves it free")
        )
        for function in (sp.cos, sp.sin):
            choices[function(reference)] = function(chosen)
            conditions[function(reference)] = sp.Ne(FREED, number)
    for s in statements:
        if isinstance(s, Let):
            found.append(replace(s, value=_freed(s.value, choices, conditions)))
    return Trial((*found, *rooms), value, guard, tuple(a for a, _ in angles))


def _rooms(conditions: Sequence[sp.Basic]) -> tuple[list[Let], sp.Expr]:
    """The statements that bind by how much every condition holds, where there are several, and the least of these."""
    rooms = [room_of(c) for c in conditions]
    if len(rooms) < 2:
        return [], rooms[0] if rooms else sp.Integer(1)
    lets = [Let(real(f"room_{k}"), room) for k, room in enumerate(rooms, 1)]
    return lets, least([let.name for let in lets])


def _freed(value: sp.Expr, choices: dict[sp.Expr, sp.Expr], conditions: dict[sp.Expr, sp.Basic]) -> sp.Expr:
    if isinstance(value, Select) and value.args[2] in choices:
        return Select(sp.And(value.args[0], conditions[value.args[2]]), value.args[1], choices[value.args[2]])
    return value


def _roots_named(statements: Sequence[Let]) -> list[Let]:
    """The statements with every root under a name, so that root and slope are computed once."""
    found: list[Let] = []
    for s in statements:
        inner = sorted((r for r in s.value.atoms(Root) if r != s.value), key=sp.default_sort_key)
        names = {r: real(f"root_{f'{number}_' if number else ''}of_{s.name.name}") for number, r in enumerate(inner)}
        found += [Let(name, root) for root, name in names.items()]
        found.append(replace(s, value=s.value.xreplace(names)))
    return found


def names_of_search(mechanism: Mechanism, trial: Trial) -> Iterator[sp.Symbol]:
    """The names that the programs of a search bind, or that are their arguments."""
    yield from (*PLACE, *GOAL.values(), START, LOOKED_FOR, FOUND, flag(FITS))
    yield from (real(n) for n in ("value", "guard", "remainder", "slope", "room", "room_slope", "error"))
    yield from (s.name for s in trial.statements)
    loop, _ = newton(mechanism, [_ZERO] * len(mechanism.solved_joints))
    yield from (name for s in loop.step for name in s.bound())


def with_goal(statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The statements with the commanded pose by the names in `GOAL`."""
    return tuple(rewritten(s, lambda e: e.xreplace(dict(GOAL))) for s in statements)
