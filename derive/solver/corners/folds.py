"""Folds: where the two roots of a step nearly meet, its angle is turned, within rounding, to where a later step has a
solution.

A two-root step solves along cos v + across sin v = beside for v. The distance ahead is a root: along sin v - across cos
v = sigma sqrt(distance² - beside²). A rounding error eps of the radicand becomes sqrt(eps) in a root near zero, and eps
/ root in v. A later step needs |e| <= h, where e depends on v. If it is at its own boundary, e is then beyond h by far
more than rounding: where two singularities coincide, the pose would be refused. So v is turned to where the later step
has a solution, if the residual of v's own equation stays within rounding. The turn t follows from the first order, e +
e' t = ± h. Where this turns a later angle that is nearly free, the first order does not suffice: see `sweeps`. Where e
is within its bound, or the root is not near zero, v stays.

The distance ahead is not computed from v again: the root is as long as the triangle says even where v is free.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra.normal_form import is_compound, linear_coefficients
from derive.equations.problem import Conditioning, Legs, StepDeterminant
from derive.ir.constants import FOLD, FREE_ANGLE, ROUNDING
from derive.ir.passes import depending_on, needed_lets, normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Program, Require, Statement, Status, binds, rewritten
from derive.ir.symbols import SCALE, cosine, flag, real, sine
from derive.solver.corners.feasible_arc import WITHIN_ITS_BOUND
from derive.solver.corners.sweeps import WAYS, Sweep, sweep_of, swept


@dataclass(frozen=True)
class Later:
    """The condition of a later step on the angle of an earlier one: |value| <= size, and how the value follows from the
    angle.
    """

    step: sp.Symbol
    """The unknown of the later step."""
    word: str
    """What the names of this motion end in."""
    angle: sp.Symbol
    legs: Legs
    size: sp.Expr
    value: sp.Expr
    chain: tuple[Let, ...]
    scale: sp.Expr

    @property
    def bound(self) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        """What the earlier step binds: the distance ahead, and the cosine and sine of its angle."""
        return (self.legs.root, cosine(self.angle), sine(self.angle))

    def name(self, word: str) -> sp.Symbol:
        """A name of this motion."""
        return real(f"{word}_{self.word}")

    def before(self, name: sp.Symbol) -> sp.Symbol:
        """The name of a value before the motion."""
        return real(f"{name.name}_before_{self.word}")


def beyond_folds(
    statements: Sequence[Statement],
    determinants: Sequence[StepDeterminant],
    conditionings: Sequence[Conditioning],
    scale: sp.Expr,
) -> tuple[Statement, ...]:
    """The derivation with the angle of every two-root step near its fold turned to where later steps have solutions."""
    found = list(statements)
    for determinant in determinants:
        if determinant.legs is None:
            continue
        found = [_through_legs(s, determinant.step, determinant.legs) for s in found]
        for step in determinants:
            later = _later(found, determinant, step, scale)
            if later is not None:
                sweep = sweep_of(later.chain, later.value, later.angle, conditionings)
                found = with_motion(found, later, _motion(later, sweep))
    return tuple(found)


def _through_legs(statement: Statement, angle: sp.Symbol, legs: Legs) -> Statement:
    """The statement, where its value is a multiple of the distance ahead or beside, with that distance by its name."""
    own = (cosine(angle), sine(angle))
    if not isinstance(statement, Let) or statement.name in own or not statement.value.is_polynomial():
        return statement
    linear = linear_coefficients(sp.expand(statement.value), own)
    if linear is None or linear[0][0] == 0:
        return statement
    (a, b), rest = linear
    for pair, leg in (((legs.along, legs.across), legs.beside), ((-legs.across, legs.along), legs.root)):
        ratio = sp.cancel(a / pair[0])
        if ratio.is_number and sp.expand(b - ratio * pair[1]) == 0:
            return replace(statement, value=rest + ratio * leg)
    return statement


def _later(
    statements: Sequence[Statement], determinant: StepDeterminant, step: StepDeterminant, scale: sp.Expr
) -> Later | None:
    """The condition of a later step on a two-root step; None where it does not depend on it."""
    if determinant.legs is None or step.reach is None or step is determinant:
        return None
    angle = determinant.step
    own = {determinant.legs.root, cosine(angle), sine(angle)}
    dependent = depending_on(statements, own)
    size, value = step.reach
    if not value.free_symbols & dependent.keys() or size.free_symbols & dependent.keys():
        return None
    value = value.xreplace({n**2: s.value.args[0] for n, s in dependent.items() if isinstance(s.value, Root)})
    chain = needed_lets(dependent.values(), [value])
    if determinant.legs.beside == 0 and not any(let.value.free_symbols & {cosine(angle), sine(angle)} for let in chain):
        return None  # the distance ahead is the whole distance, whatever the angle
    return Later(step.step, f"{angle.name}_for_{step.step.name}", angle, determinant.legs, size, value, chain, scale)


def with_motion(statements: Sequence[Statement], later: Later, motion: Sequence[Let]) -> list[Statement]:
    """The statements with the angle turned, behind where it was bound."""
    found: list[Statement] = []
    for s in statements:
        if not (isinstance(s, Let) and s.name in later.bound):
            found.append(s)
            continue
        found.append(
            replace(s, name=later.before(s.name), value=s.value.xreplace({n: later.before(n) for n in later.bound}))
        )
        if s.name == sine(later.angle):  # the last of the three
            found += motion
    return found


def _motion(later: Later, sweep: Sweep | None) -> tuple[Let, ...]:
    """The angle behind the turn, computed from where it was."""
    lets, names, rates = rates_of(later)
    value, size, rate, excess, divisor, turn = map(later.name, ("value", "size", "rate", "excess", "divisor", "turn"))
    derivative = sp.Add(*[sp.diff(later.value, n) * r for n, r in rates.items() if n in later.value.free_symbols])
    is_steep = sp.Gt(sp.Abs(rate), ROUNDING * size)
    flat = sp.Integer(0 if sweep is None else 1)  # a turn of one radian, which is far enough for the angle to follow
    follows = () if sweep is None else (*swept(sweep, later.angle, names, rates, later.word), *_swept(later))
    return (
        *lets,
        Let(value, later.value.xreplace(names), WITHIN_ITS_BOUND.format(later.step)),
        Let(size, sp.Abs(later.size)),
        Let(rate, derivative.xreplace(names), f"its derivative by {later.angle.name}"),
        Let(excess, Select(sp.Gt(value, 0), value - size, value + size)),
        Let(divisor, Select(is_steep, rate, sp.Integer(1))),
        Let(turn, Select(is_steep, -excess / divisor, flat), f"turn of {later.angle.name} to first order"),
        *turned(later, turn),
        *follows,
        *taken(later, is_swept=sweep is not None),
    )


def turned(later: Later, turn: sp.Symbol) -> tuple[Let, ...]:
    """The distance ahead, the cosine and the sine behind a turn, and the residual of the step's own equation."""
    root, cos_v, sin_v = (later.before(n) for n in later.bound)
    length = later.name("turned_length")
    return (
        Let(length, Root(1 + turn**2)),
        Let(later.name("turned_ahead"), (root + turn * later.legs.beside) / length),
        Let(later.name("turned_cos"), (cos_v - turn * sin_v) / length),
        Let(later.name("turned_sin"), (sin_v + turn * cos_v) / length),
        Let(later.name("turned_cost"), _residual(later, "turned"), f"residual of the equation of {later.angle.name}"),
    )


def _swept(later: Later) -> tuple[Let, ...]:
    """The motion where the angle follows a later one: of two ways, the one with the smaller residual. A free angle has
    no residual.
    """
    legs, (near, mirrored) = later.legs, (later.name(f"{way}_cost") for way in WAYS)
    determined = sp.Gt(legs.distance, FREE_ANGLE * later.scale)
    cos_v, sin_v = later.name("swept_cos"), later.name("swept_sin")
    chosen = (
        Select(sp.Le(near, mirrored), *(later.name(f"{way}_{f}") for way in WAYS)) for f in ("cost", "cos", "sin")
    )
    return (
        *(Let(later.name(f"{way}_cost"), Select(determined, _residual(later, way), sp.Integer(0))) for way in WAYS),
        *(Let(n, v) for n, v in zip((later.name("swept_cost"), cos_v, sin_v), chosen, strict=True)),
        Let(later.name("swept_ahead"), legs.along * sin_v - legs.across * cos_v),
    )


def _residual(later: Later, word: str) -> sp.Expr:
    cos_v, sin_v = later.name(f"{word}_cos"), later.name(f"{word}_sin")
    return sp.Abs(later.legs.along * cos_v + later.legs.across * sin_v - later.legs.beside)


def taken(later: Later, *, is_swept: bool) -> tuple[Let, ...]:
    """The unchanged angle where it is far from the fold or the later step has a solution; else the angle turned within
    rounding.
    """
    bests = [later.name(f"best_{word}") for word in ("cost", "ahead", "cos", "sin")]
    chosen = [later.name(f"turned_{word}") for word in ("cost", "ahead", "cos", "sin")]
    if is_swept:
        others = [later.name(f"swept_{word}") for word in ("cost", "ahead", "cos", "sin")]
        chosen = [Select(flag(later.name("follows").name), b, a) for a, b in zip(chosen, others, strict=True)]
    note = f"turned so that {later.step.name} has a solution"
    return (
        *(Let(n, c) for n, c in zip(bests, chosen, strict=True)),
        *(Let(n, _where_turned(later, n, v), note) for n, v in zip(later.bound, bests[1:], strict=True)),
    )


def _where_turned(later: Later, name: sp.Symbol, after: sp.Expr) -> sp.Expr:
    before, value, size = later.before(name), later.name("value"), later.name("size")
    is_dear = sp.Gt(later.name("best_cost"), ROUNDING * later.scale)
    near = Select(sp.Le(sp.Abs(value), size), before, Select(is_dear, before, after))
    return Select(_is_far(later.legs.square, later.scale), before, near)


def _is_far(square: sp.Expr, scale: sp.Expr) -> sp.Basic:
    return sp.Gt(square, FOLD * scale**2)


def rates_of(later: Later) -> tuple[list[Let], dict[sp.Symbol, sp.Expr], dict[sp.Symbol, sp.Expr]]:
    """The chain before the turn with its derivatives by the angle; the names of the values; the derivatives or their
    names.
    """
    cos_v, sin_v = cosine(later.angle), sine(later.angle)
    names: dict[sp.Symbol, sp.Expr] = {n: later.before(n) for n in later.bound}
    rates: dict[sp.Symbol, sp.Expr] = {later.legs.root: later.legs.beside, cos_v: -sin_v, sin_v: cos_v}
    lets: list[Let] = []
    for let in later.chain:
        own = names[let.name] = later.before(let.name)
        more, rate = _rate(let, rates, own, later.word)
        lets += [Let(m.name, m.value.xreplace(names)) for m in (Let(own, let.value), *more)]
        rate = rate.xreplace(names)
        if is_compound(rate):
            lets.append(Let(real(f"{let.name.name}_rate_{later.word}"), rate))
            rate = lets[-1].name
        rates[let.name] = rate
    return lets, names, rates


def _rate(let: Let, rates: Mapping[sp.Symbol, sp.Expr], own: sp.Symbol, word: str) -> tuple[list[Let], sp.Expr]:
    """The derivative of a value, given those of the values that it reads."""
    if isinstance(let.value, Select):
        condition, *sides = let.value.args
        return [], Select(condition, *(rate_along(side, rates) for side in sides))
    if not isinstance(let.value, Root):
        return [], rate_along(let.value, rates)
    is_long, divisor = sp.Gt(own, 0), real(f"{let.name.name}_divisor_{word}")
    rate = Select(is_long, rate_along(let.value.args[0], rates) / (2 * divisor), sp.Integer(0))
    return [Let(divisor, Select(is_long, own, sp.Integer(1)))], rate


def rate_along(value: sp.Expr, rates: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """The derivative of a value, given those of the names in it."""
    return sp.Add(*[sp.diff(value, name) * rate for name, rate in rates.items() if name in value.free_symbols])


def far_from_folds(program: Program) -> Program:
    """The program for poses far from every fold: near one it ends with the status OK and without an answer."""
    conditions = {
        node: sp.true
        for let in program.lets()
        for node in let.value.atoms(sp.StrictGreaterThan)
        if node.lhs.is_Symbol and node == _is_far(node.lhs, SCALE)
    }
    body: list[Statement] = []
    for s in program.body:
        body.append(rewritten(s, lambda e: e.xreplace(conditions)))
        body += [Require(c, Status.OK, "near a fold") for c in conditions if c.lhs in binds(s)]
    return normalise(program.name, body, program.outputs) if conditions else program
