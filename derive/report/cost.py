"""The cost of a program: the operations of one call in the worst case, counted in the statements that every language
prints.

A subtraction counts as an addition, changes of sign and comparisons are free, a power counts as multiplications. For a
choice between statements the more expensive side counts; for a choice between values both values count. All passes of
an iteration count. Values that `Initialize` has computed do not count.
"""

from __future__ import annotations

import operator
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import sympy as sp
from sympy.logic.boolalg import Boolean

from derive.equations.rotation_repair import rotation_program, surely_exact
from derive.ir.constants import DEGREE
from derive.ir.one_row import Repeats
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root
from derive.ir.program import Call, Iterate, Let, Program, Require, Solve, Statement
from derive.ir.tree import If, Item
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import structured
from derive.report.branch_stretches import stretches_of

_BINARY_FRACTIONS = (2, 4, 8, 16)
"""The denominators that are written as a decimal factor."""


@dataclass(frozen=True)
class Cost:
    """The number of operations of each kind."""

    additions: int = 0
    multiplications: int = 0
    divisions: int = 0
    roots: int = 0
    trigonometric: int = 0
    """Sines, cosines and arc tangents."""

    def __add__(self, other: Cost) -> Cost:
        if other is _NOTHING or self is _NOTHING:
            return self if other is _NOTHING else other
        return Cost(*map(operator.add, self.counts, other.counts))

    def __mul__(self, times: int) -> Cost:
        return Cost(*(times * a for a in self.counts))

    @property
    def counts(self) -> tuple[int, int, int, int, int]:
        """The numbers in their order."""
        return self.additions, self.multiplications, self.divisions, self.roots, self.trigonometric


_NOTHING = Cost()
_OfSides = Callable[[Cost, Cost], Cost]


def _most(*costs: Cost) -> Cost:
    return Cost(*map(max, zip(*(cost.counts for cost in costs), strict=True)))


def _regular(holds: Cost, _: Cost) -> Cost:
    """The cost of the first side, which the rules take away from singular poses."""
    return holds


@dataclass(frozen=True)
class Bound:
    """The bound of an iteration: its program, its note, and the largest number of its passes."""

    program: str
    note: str
    limit: int


@dataclass(frozen=True)
class Costs:
    """The cost of the calls of a block in the worst case."""

    forward: Cost
    inverse: Cost
    """The inverse with a configuration that names every branch, away from singular poses."""
    tried: Cost
    """One branch of a configuration with automatic bytes, with the distance of its solution from the reference."""
    limits: Cost
    """The test of the limits."""
    automatic: Cost
    """The inverse with a configuration whose branch bytes are all automatic; without branches, equal to `inverse`."""
    exact: Cost
    """The check of an exact commanded rotation, once a call; zero if the rotation is not read."""
    repair: Cost
    """Check and repair of any other commanded rotation, once a call; zero if the rotation is not read."""
    corners: Cost
    """The additional cost of a branch at a singular pose: the second sides of choices."""
    bounds: tuple[Bound, ...]
    corner: str
    """Where it is added: a machine with deviations adds it wherever it is."""


_PRIMITIVES: dict[type[sp.Basic], Cost] = {
    sp.sin: Cost(trigonometric=1),
    sp.cos: Cost(trigonometric=1),
    Root: Cost(roots=1),
    Atan2: Cost(additions=1, divisions=1, trigonometric=1),
    NearestPeriod: Cost(additions=4, multiplications=2),
    NearestOnArc: Cost(additions=5, multiplications=2),
}
"""The cost of the shared functions of Structured Text."""
_PERIOD_BYTE = Cost(additions=3, multiplications=1)
"""The number of the turn in which an axis value lies."""


@kept_by_identity(10)
def costs_of(kinematics: Kinematics) -> Costs:
    """The cost of forward and inverse kinematics of a mechanism in the worst case."""
    periods, axes = len(kinematics.period_joints), len(kinematics.distance_joints)
    limits, branch = _with_refusals(kinematics.limits), _with_refusals(kinematics.branch, _regular)
    # The distance of a solution from the reference, a sum of squares, and its comparison with the least so far
    tried = branch + Cost(additions=3 * axes, multiplications=axes)
    exact = _total(map(expression_cost, surely_exact()))
    return Costs(
        forward=cost_of(kinematics.forward) + _PERIOD_BYTE * periods,
        inverse=branch + limits,
        tried=tried,
        limits=limits,
        automatic=_all_branches(kinematics, tried) + limits if kinematics.branches else branch + limits,
        exact=exact if kinematics.reads_rotation else Cost(),
        repair=exact + _with_refusals(rotation_program()) if kinematics.reads_rotation else Cost(),
        corners=_with_refusals(kinematics.branch) + branch * -1,
        bounds=tuple(dict.fromkeys(b for p in (kinematics.forward, kinematics.branch) for b in _bounds(p))),
        corner="a branch with deviations" if kinematics.mechanism.nominal else "a branch at a singular pose",
    )


def _all_branches(kinematics: Kinematics, tried: Cost) -> Cost:
    """The cost of all branches: what several of them share is computed once."""
    slots = 1 << len(kinematics.branches)
    shared = (s for s in stretches_of(kinematics.branch) if s.is_shared)
    saved = (_total(_item(i, _regular) for i in s.items) * (slots - s.sides) for s in shared)
    return tried * slots + _total(saved) * -1


def _with_refusals(program: Program, of_sides: _OfSides = _most) -> Cost:
    """The cost including a refusal that computes the missing amount, after which no further statement runs."""
    worst, before = cost_of(program, of_sides), Cost()
    for item in (item for stretch in stretches_of(program) for item in stretch.items):
        before += _item(item, of_sides)
        if isinstance(item, Require):
            worst = _most(worst, *(before + expression_cost(e) for e in _amounts(item)))
    return worst


def _amounts(require: Require) -> tuple[sp.Expr, ...]:
    reason = require.reason
    return () if reason is None or reason.amount is None else (reason.amount,)


def cost_of(program: Program, of_sides: _OfSides = _most, repeats: Repeats | None = None) -> Cost:
    """The cost of one run of a program in the worst case. of_sides: combines the costs of both sides of a choice;
    repeats: how often the bodies of loops run; without it they run as often as they may.
    """
    if of_sides is _most and repeats is None:
        return _at_most(program)
    return _counted(program, of_sides, repeats)


@kept_by_identity(400)
def _at_most(program: Program) -> Cost:
    return _counted(program, _most, None)


def _counted(program: Program, of_sides: _OfSides, repeats: Repeats | None) -> Cost:
    items = (_item(item, of_sides, repeats) for item in structured(program))
    return _total(items) + _total(map(expression_cost, (o.value for o in program.outputs)))


@cache
def expression_cost(node: sp.Basic) -> Cost:
    """The cost of an expression as every language writes it."""
    if isinstance(node, sp.Mul | sp.Pow):
        return _product(node)
    own = _PRIMITIVES.get(type(node), _NOTHING)
    if isinstance(node, sp.Add):
        own = Cost(additions=len(node.args) - 1)
    return own + _total(map(expression_cost, node.args))


def solve_cost(size: int, columns: int) -> Cost:
    """The cost of linear equations: elimination with pivoting, determinant, and back substitution."""
    eliminated = sum(rows * (rows + columns) for rows in range(size))
    back = columns * size * (size - 1) // 2
    by_inverses = size * (size - 1) // 2 + size * columns
    return Cost(additions=eliminated + back, multiplications=eliminated + back + by_inverses + 2 * size, divisions=size)


def _item(item: Item, of_sides: _OfSides, repeats: Repeats | None = None) -> Cost:
    if isinstance(item, If):
        sides = (_total(_item(inner, of_sides, repeats) for inner in side) for side in (item.holds, item.fails))
        return expression_cost(item.condition) + of_sides(*sides)
    is_skipped = isinstance(item, Call) and item.is_rare and of_sides is _regular
    return _NOTHING if is_skipped else _statement(item, repeats)


def _statement(statement: Statement, repeats: Repeats | None = None) -> Cost:
    if isinstance(statement, Let):
        return expression_cost(statement.value)
    if isinstance(statement, Require):
        return expression_cost(statement.condition)
    if isinstance(statement, Solve):
        entries = _total(map(expression_cost, (*statement.matrix, *statement.right)))
        return entries + solve_cost(statement.size, statement.columns)
    if isinstance(statement, Call):
        return _given(statement) + _runs(statement, 1, repeats)
    calls, passes = statement.calls(), statement.limit if repeats is None else repeats.passes[statement.note]
    one_pass = _total(_given(s) if isinstance(s, Call) else _statement(s) for s in statement.step) + _total(
        map(expression_cost, (statement.done, *statement.following))
    )
    ways = _run_together(statement) if repeats is None else [[calls]]
    most = [_most(*(_total(_runs(call, passes, repeats) for call in some) for some in way)) for way in ways]
    runs = min(most, key=lambda cost: sum(cost.counts))
    return _total(map(expression_cost, statement.start)) + one_pass * passes + runs


def _run_together(loop: Iterate) -> Iterator[list[tuple[Call, ...]]]:
    """The calls that one pass may run, in several ways: all; or those for each value of a state that they ask for."""
    yield [loop.calls()]
    flags = [s for s in loop.step if isinstance(s, Let) and isinstance(s.value, Boolean)]
    conditions = (*(s.value for s in flags), *(call.wanted for call in loop.calls()))
    tests = {t for c in conditions for t in c.atoms(sp.Eq) if t.lhs in loop.state and t.rhs.is_Integer}
    for name in sorted({t.lhs for t in tests}, key=str):
        own = sorted((t for t in tests if t.lhs == name), key=sp.default_sort_key)
        yield [
            _wanted_where(loop, flags, {t: sp.true if t == holds else sp.false for t in own}) for holds in (None, *own)
        ]


def _wanted_where(loop: Iterate, flags: Sequence[Let], known: Mapping[sp.Basic, sp.Basic]) -> tuple[Call, ...]:
    """The calls that a pass may run where the truth of some conditions is known."""
    table = dict(known)
    for let in flags:
        if let.value.xreplace(table) == sp.false:
            table[let.name] = sp.false
    return tuple(call for call in loop.calls() if call.wanted.xreplace(table) != sp.false)


def _given(call: Call) -> Cost:
    return _total(map(expression_cost, call.children()))


def _runs(call: Call, times: int, repeats: Repeats | None) -> Cost:
    """The cost of all runs of a shared program. Passes that are counted, or bounded by `passes`, are those of all runs
    together.
    """
    once = cost_of(call.program, repeats=Repeats())
    if repeats is not None:
        return once * (repeats.runs[call.program.name] - 1) + cost_of(call.program, repeats=repeats)
    if call.passes is None:
        return cost_of(call.program) * times
    each = Repeats(passes=Counter({s.note: 1 for s in call.program.body if isinstance(s, Iterate)}))
    return once * times + (cost_of(call.program, repeats=each) + once * -1) * call.passes


def _product(node: sp.Expr) -> Cost:
    """The numbers of factors in numerator and denominator; a coefficient counts as a factor, a sign does not."""
    coefficient, rest = node.as_coeff_Mul()
    above = below = 0
    inner = Cost()
    for factor in sp.Mul.make_args(rest):
        base, exponent = factor.as_base_exp() if isinstance(factor, sp.Pow) else (factor, sp.Integer(1))
        times = abs(int(exponent))
        is_above = exponent.is_positive or base == DEGREE  # one radian in degrees is a constant, too
        above, below = (above + times, below) if is_above else (above, below + times)
        inner += expression_cost(base) * times
    numerator = abs(coefficient)
    if isinstance(coefficient, sp.Rational) and coefficient.q not in _BINARY_FRACTIONS:
        numerator = abs(coefficient.p)
        below += int(coefficient.q != 1)
    above += int(numerator != 1 or not above)
    return inner + Cost(multiplications=above - 1 + max(below - 1, 0), divisions=int(below > 0))


def _bounds(program: Program) -> Iterator[Bound]:
    for statement in program.body:
        if isinstance(statement, Iterate):
            yield Bound(program.name, statement.note, statement.limit)
            yield from (bound for call in statement.calls() for bound in _bounds(call.program))
        elif isinstance(statement, Call):
            yield from _bounds(statement.program)


def _total(costs: Iterable[Cost]) -> Cost:
    return sum(costs, start=_NOTHING)
