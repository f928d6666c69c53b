"""The coordinates that a loop moves but the task does not command: planes determine them from the commanded ones.

The platform has the tool direction of the commanded rotation C, and is turned about it: R = C Rz(twist). A point t of
the plate stays in the plane n . (x + R t) = d: that is linear in the passive coordinates of x, and in the cosine and
the sine of the twist. So the solver finds them by its rules. Of two solutions the machine has the one of its home pose:
the sign of the determinant there is a constant of the machine.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.mechanism import DescriptionError, Mechanism
from derive.equations.closures.fixed_names import all_angles, fixed_lets, fixed_names, signs_of, with_fixed_names
from derive.equations.problem import Equation, Problem, StepDeterminant
from derive.ir.passes import renamed
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Require, Statement, rewritten
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import COORDINATE_NAMES, HEADING, ROTATION_ENTRIES, SCALE, cosine, real, sine
from derive.plate.legs import NORMAL, moments, names, rotation_axes, rotation_of
from derive.solver.derivation import Derivation
from derive.solver.solve import solve
from derive.solver.unsolved import Unsolved

TWIST = real("twist")
"""The turn about the tool, from the commanded rotation to that of the platform."""
GUIDES = "guides_dependent"
"""The name of the margin that is zero if the planes do not determine the passive coordinates."""
_COMMANDED = tuple(real(f"commanded_{r.name}") for r in ROTATION_ENTRIES)


@cache
def solve_passive(mechanism: Mechanism) -> Derivation:
    """The passive coordinates, from the commanded ones. Raises `DescriptionError` if the planes leave them free."""
    turns = "twist" in mechanism.passive
    problem = Problem(
        angles=(TWIST,) if turns else (),
        lengths=tuple(real(c) for c in mechanism.passive if c != "twist"),
        equations=tuple(_equation(mechanism, k) for k in range(len(mechanism.fixed_guides))),
        units=(*all_angles(mechanism), TWIST),
        references={TWIST: sp.Integer(0)},
        scale=SCALE,
        signs=signs_of(mechanism),
        parameters=fixed_names(mechanism),
    )
    try:
        return solve(problem, (), lambda angle: ())
    except Unsolved as left:
        raise DescriptionError(
            f"the task commands {mechanism.task.position!r}, and the loop moves {', '.join(mechanism.passive)} as well:"
            f" its guides do not hold that: {left}"
        ) from None


def _equation(mechanism: Mechanism, number: int) -> Equation:
    plane = mechanism.fixed_guides[number]
    stated = with_fixed_names(mechanism, plane.equation)
    if "twist" in mechanism.passive:
        stated = stated.xreplace(dict(zip(ROTATION_ENTRIES, _turned(), strict=True)))
    units = (*all_angles(mechanism), TWIST)
    return Equation(f"guide {plane.name}", polynomial(stated, units, signs_of(mechanism)))


def _turned() -> list[sp.Expr]:
    """The commanded rotation, turned about its z axis by the twist."""
    cos_twist, sin_twist = cosine(TWIST), sine(TWIST)
    turn = sp.Matrix([[cos_twist, -sin_twist, 0], [sin_twist, cos_twist, 0], [0, 0, 1]])
    return list(sp.Matrix(3, 3, _COMMANDED) * turn)


def passive_statements(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The statements that bind the passive coordinates to their own names, from commanded ones under other names."""
    if not mechanism.passive:
        return ()
    derivation = solve_passive(mechanism)
    modes = {step.sigma: mode_of(step) for step in derivation.determinants}
    solved = tuple(_about_the_plate(rewritten(s, lambda e: e.xreplace(modes))) for s in derivation.statements)
    if "twist" not in mechanism.passive:
        return solved
    note = "the platform has the commanded tool direction, and the twist about it that its guides leave"
    lets = (Let(r, v) for r, v in zip(ROTATION_ENTRIES, _turned(), strict=True))
    first, *others = lets
    return (*solved, Let(first.name, first.value, note), *others)


def _about_the_plate(statement: Statement) -> Statement:
    """The statement; if it refuses because planes do not determine the twist, its reason says so."""
    if isinstance(statement, Require) and statement.reason is not None and statement.reason.why is Why.TOO_SHORT:
        return replace(statement, reason=about_machine(Why.UNCONTROLLED))
    return statement


def mode_of(step: StepDeterminant) -> sp.Symbol:
    """The constant of a machine that tells which of two solutions its home pose has."""
    return real(f"home_{step.sigma.name}")


def at_the_pose(mechanism: Mechanism) -> tuple[Let, ...]:
    """The names of the derivation at a pose of the platform: there its twist from the commanded rotation is zero."""
    if not mechanism.passive:
        return ()
    derivation = solve_passive(mechanism)
    own = {real(c) for c in mechanism.passive} | {TWIST, cosine(TWIST), sine(TWIST)}
    known = (Let(c, r) for c, r in zip(_COMMANDED, ROTATION_ENTRIES, strict=True))
    zero = (Let(cosine(TWIST), sp.Integer(1)), Let(sine(TWIST), sp.Integer(0)))
    kept = (s for s in derivation.plain if isinstance(s, Let) and s.name not in own)
    signs = (Let(step.sigma, Select(sp.Ge(step.value, 0), 1, -1)) for step in derivation.determinants)
    return (
        *(known if "twist" in mechanism.passive else ()),
        *(zero if "twist" in mechanism.passive else ()),
        *signs,
        *kept,
    )


@cache
def guides_determinant(mechanism: Mechanism) -> sp.Expr:
    """The determinant of the planes by the passive coordinates, at a pose and in the names of the rows of A. Moments
    are divided by the platform's radius.
    """
    tool = rotation_of(mechanism)[:, 2]
    about = dict(zip(rotation_axes(mechanism), tool[-len(rotation_axes(mechanism)) :, 0], strict=True))
    rows = []
    for plane in mechanism.fixed_guides:
        along = dict(zip(COORDINATE_NAMES, names(NORMAL, plane), strict=False))
        turned = sp.Add(*[n * about[c] for n, c in zip(moments(mechanism, plane), about, strict=True)])
        rows.append([turned if c == "twist" else along.get(c, sp.Integer(0)) for c in mechanism.passive])
    return sp.Matrix(rows).det()


def modes_at_home(mechanism: Mechanism, home: dict[sp.Symbol, sp.Expr]) -> tuple[Statement, ...]:
    """The statements that bind the modes of the machine. home: the coordinates of the platform at its home pose."""
    determinants = solve_passive(mechanism).determinants if mechanism.passive else ()
    if not determinants:
        return ()
    turns = "twist" in mechanism.passive
    level = {cosine(TWIST): sp.Integer(1), sine(TWIST): sp.Integer(0)} if turns else {}
    commanded_there = {c: home[r] for c, r in zip(_COMMANDED, ROTATION_ENTRIES, strict=True)} if turns else {}
    own = {let.name: let.value for let in (*fixed_lets(mechanism), *at_the_pose(mechanism))}
    needed = _needed([step.value for step in determinants], own, {*level, *commanded_there})
    table = home | commanded_there | level | {name: real(f"passive_{name.name}") for name in needed}
    lets = (Let(real(f"passive_{name.name}"), own[name].xreplace(table)) for name in own if name in needed)
    values = ((mode_of(step), step.value.xreplace(table)) for step in determinants)
    note = "of two twists the machine has the one of its home pose"
    return (*lets, *(Let(n, Select(sp.Gt(v, 0), sp.Integer(1), sp.Integer(-1)), note) for n, v in values))


def _needed(values: Iterable[sp.Expr], own: Mapping[sp.Symbol, sp.Expr], known: set[sp.Symbol]) -> set[sp.Symbol]:
    """The names that values read, themselves or through others."""
    found: set[sp.Symbol] = set()
    left = {s for v in values for s in v.free_symbols}
    while left := {s for s in left if s in own and s not in known and s not in found}:
        found |= left
        left = {s for name in left for s in own[name].free_symbols}
    return found


def mode_constants(mechanism: Mechanism) -> tuple[Output, ...]:
    """The modes as outputs, for other programs."""
    determinants = solve_passive(mechanism).determinants if mechanism.passive else ()
    return tuple(Output(mode_of(step).name, mode_of(step)) for step in determinants)


def commanded(mechanism: Mechanism) -> dict[sp.Symbol, sp.Symbol]:
    """The names in a program of the inverse for the commanded pose and for that of the platform: only the commanded one
    is an input.
    """
    if not mechanism.passive:
        return {}
    own = [real(c) for c in mechanism.passive if c != "twist"]
    turned = ROTATION_ENTRIES if "twist" in mechanism.passive else ()
    table = {s: real(f"platform_{s.name}") for s in (*own, *turned)}
    return table | (dict(zip(_COMMANDED, ROTATION_ENTRIES, strict=True)) if turned else {})


def renamed_in(statements: Iterable[Statement], table: Mapping[sp.Symbol, sp.Symbol]) -> tuple[Statement, ...]:
    """The statements in which names are replaced, also those that they bind."""
    if not table:
        return tuple(statements)
    return tuple(
        renamed(rewritten(s, lambda e: e.xreplace(dict(table))), lambda n: table.get(n, n)) for s in statements
    )


def completed(
    mechanism: Mechanism, position: Sequence[sp.Symbol], rotation: Sequence[sp.Symbol]
) -> tuple[tuple[Statement, ...], tuple[sp.Symbol, ...], tuple[sp.Symbol, ...]]:
    """The statements that give a pose the passive coordinates that belong to its commanded ones, and the pose: a caller
    may know what it has commanded alone.
    """
    places = tuple(real(c) for c in mechanism.motion.position)
    turns = ROTATION_ENTRIES if len(rotation) == len(ROTATION_ENTRIES) else (cosine(HEADING), sine(HEADING))
    table = dict(zip((*places, *turns), (*position, *rotation), strict=True))
    table |= dict(zip(_COMMANDED, rotation, strict=False)) if "twist" in mechanism.passive else {}
    own = [s for s in passive_statements(mechanism) if not isinstance(s, Require)]
    table |= {name: real(f"completed_{name.name}") for s in own for name in s.bound()}
    return renamed_in(own, table), tuple(table[c] for c in places), tuple(table[r] for r in turns)
