"""Cables only pull: the inverse refuses poses at which a load would make one push.

Let a be the unit vectors along the legs, from their bases, with their moments about the point on which the load acts.
At rest the tensions t per unit of the load w satisfy A' t = (w, 0), where the rows of A are the legs. With more legs
than the pose has quantities there are many such t: one of them has no negative tension just where a set of as many
legs as quantities has one (Caratheodory), so every such set is asked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import reduce
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.mechanism import DescriptionError, Mechanism, Rod
from derive.equations.closures.fixed_names import all_angles, signs_of, with_fixed_names
from derive.ir.constants import BOUNDARY, LEAST
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Solve, Statement, Status
from derive.ir.reason import Reason, Why, about, about_machine
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.plate.legs import RADIUS, rotation_axes
from derive.plate.surplus import turned_rate

_MOST = 10
"""The most sets of legs that are asked: each is a system of linear equations in the inverse."""
_LOAD, _LEAST_TENSION = real("load"), real("least_tension")
_NOWHERE = sp.Integer(-1)
"""The least tension of legs that do not hold the load."""


def tension_checks(mechanism: Mechanism, offset: bool) -> tuple[Statement, ...]:
    """The conditions on the tensions at a solved pose. offset: the pose is that of the flange of a commanded point."""
    sets = _sets(mechanism)
    if not sets:
        return ()
    seen = {real(c): real(f"flange_{c}") for c in COORDINATE_NAMES} if offset else {}
    load = [with_fixed_names(mechanism, v) for v in mechanism.load]
    lines, width = {rod.name: _line(mechanism, rod, seen) for rod in mechanism.rods}, len(_quantities(mechanism))
    loaded = sp.Gt(_LOAD, 0)
    unit = [v / Select(loaded, _LOAD, sp.Integer(1)) for v in load] + [sp.Integer(0)] * (width - len(load))
    found: list[Statement] = [
        Let(
            _LOAD,
            Root(sp.Add(*[v**2 for v in load])),
            "the size of the load; 0: it is not known, and no tension is tested",
        )
    ]
    found += [let for lets in lines.values() for let in lets]
    least = []
    for number, legs in enumerate(sets, 1):
        tensions = [real(f"tension_{number}_{rod.name}") for rod in legs]
        matrix = [lines[rod.name][k - width].name for k in range(width) for rod in legs]
        one, own = real(f"determinant_of_pulls_{number}"), real(f"least_tension_{number}")
        found.append(Solve(tuple(tensions), tuple(matrix), tuple(unit), one, "tensions per unit of the load"))
        pulls = [t for t, rod in zip(tensions, legs, strict=True) if rod.only_pulls]
        found.append(Let(own, Select(sp.Gt(sp.Abs(one), LEAST), reduce(_smaller, pulls), _NOWHERE)))
        least.append(own)
    found.append(Let(_LEAST_TENSION, reduce(_larger, least)))
    return (*found, *_refusals(sets, loaded))


def _sets(mechanism: Mechanism) -> list[tuple[Rod, ...]]:
    """The sets of legs, as many as the load has coordinates, in which rods that may push come first; none where such
    rods hold the pose alone.
    """
    if not mechanism.load:
        return []
    if mechanism.closure or mechanism.guides or mechanism.heading is not None:
        raise DescriptionError("load= is for a point or a platform that cables and rods alone hold")
    stiff, width = [rod for rod in mechanism.rods if not rod.only_pulls], len(_quantities(mechanism))
    if len(stiff) >= width:
        return []
    sets = [(*stiff, *some) for some in combinations(mechanism.cables, width - len(stiff))]
    if len(sets) > _MOST:
        raise DescriptionError(
            f"load=: {len(sets)} sets of cables may hold it, and at most {_MOST} are asked: leave load= out"
        )
    return sets


def _quantities(mechanism: Mechanism) -> tuple[str, ...]:
    """What the legs hold: coordinates of the load, and turns."""
    return (*mechanism.motion.position, *(rotation_axes(mechanism) if mechanism.is_platform else ()))


def _line(mechanism: Mechanism, rod: Rod, seen: dict[sp.Symbol, sp.Symbol]) -> tuple[Let, ...]:
    """The unit vector from the base of a leg to the tool, and its moment, as the last statements."""
    names = [real(f"pull_{rod.name}_{c}") for c in COORDINATE_NAMES[: len(rod.plate)]]
    ends = (with_fixed_names(mechanism, p - b) for p, b in zip(rod.plate, rod.base, strict=True))
    spans = [polynomial(v, all_angles(mechanism), signs_of(mechanism)).xreplace(seen) for v in ends]
    away, own = real(f"distance_{rod.name}"), real(f"divisor_of_pull_{rod.name}")
    return (
        Let(away, Root(sp.Add(*[v**2 for v in spans]))),
        Let(own, Select(sp.Gt(away, LEAST), away, sp.Integer(1))),
        *(Let(n, v / own) for n, v in zip(names, spans, strict=True)),
        *_moments(mechanism, rod, names),
    )


def _moments(mechanism: Mechanism, rod: Rod, line: Sequence[sp.Symbol]) -> Iterator[Let]:
    """The moments of a leg about the point on which the load acts, in lengths of the platform."""
    for axis in _quantities(mechanism)[len(mechanism.motion.position) :]:
        rates = [with_fixed_names(mechanism, turned_rate(p, axis)) for p in rod.plate]
        value = sp.Add(*[n * v for n, v in zip(line, rates, strict=True)]) / RADIUS
        yield Let(real(f"moment_of_pull_{rod.name}_{axis}"), value)


def _smaller(one: sp.Expr, other: sp.Expr) -> sp.Expr:
    return Select(sp.Lt(one, other), one, other)


def _larger(one: sp.Expr, other: sp.Expr) -> sp.Expr:
    return Select(sp.Gt(one, other), one, other)


def _refusals(sets: Sequence[tuple[Rod, ...]], loaded: sp.Basic) -> Iterator[Require]:
    """The refusals; of legs that determine their tensions they name the cable with the least."""
    if len(sets) > 1:
        reason = replace(about_machine(Why.NONE_PULLS), amount=-_LEAST_TENSION)
        yield _needed(loaded, sp.Ge(_LEAST_TENSION, -BOUNDARY), reason)
        return
    for rod in (r for r in sets[0] if r.only_pulls):
        tension = real(f"tension_1_{rod.name}")
        holds = sp.Or(sp.Ge(tension, -BOUNDARY), sp.Gt(tension, _LEAST_TENSION))
        yield _needed(loaded, holds, about(f"cable {rod.name}", Why.PUSHES, -tension))


def _needed(loaded: sp.Basic, holds: sp.Basic, reason: Reason) -> Require:
    return Require(sp.Or(sp.Not(loaded), holds), Status.UNREACHABLE, reason=reason)
