"""The driver: solve unknowns one after the other by subproblems until none is left, or raise `Unsolved` with the rest.

It knows no mechanism: it asks every rule for candidates, takes the best, removes its unknowns, and repeats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.equations.positions import positions
from derive.equations.problem import Binding, Conditioning, Equation, Problem, StepDeterminant
from derive.equations.rotations import conditions, rotations
from derive.ir.program import Statement
from derive.solver.derivation_record import DerivationRecord
from derive.solver.eliminations import differences, eliminations, squares, squares_of_three, squares_with_lengths
from derive.solver.feasible_arc import within_reach
from derive.solver.folds import beyond_folds
from derive.solver.parallel_axes import Sum, candidate_sums, resolve, substitute
from derive.solver.positive_steps import known_signs, where_roots_meet, with_known_signs
from derive.solver.subproblems.affine import affine
from derive.solver.subproblems.affine_system import affine_pair, affine_triple
from derive.solver.subproblems.pair import pair
from derive.solver.subproblems.polar import polar
from derive.solver.subproblems.quadratic import quadratic
from derive.solver.subproblems.spheres import spheres
from derive.solver.subproblems.trigonometric import lateral, trigonometric
from derive.solver.unsolved import undetermined, unsolved

Rule = Callable[[Problem, tuple[Equation, ...]], Iterator[Binding]]
RULES: tuple[Rule, ...] = (affine, affine_pair, pair, polar, trigonometric, quadratic, spheres)
_BETTER: tuple[Rule, ...] = tuple(lateral if rule is trigonometric else rule for rule in RULES)
"""The same without the steps that give a cosine alone, which rank behind all others."""


def _stated(problem: Problem) -> tuple[Equation, ...]:
    """The equations and those of the rotation; with an equation too many the rotation waits until the positions are
    solved.
    """
    if problem.is_overdetermined and problem.equations:
        return problem.equations
    return problem.equations + rotations(problem)


TIERS: tuple[Callable[[Problem], tuple[Equation, ...]], ...] = (
    _stated,
    differences,
    eliminations,
    positions,
    squares,
    squares_with_lengths,
)
Resolve = Callable[[sp.Symbol], tuple[Statement, ...]]


class Unsolved(Exception):
    """No subproblem fits what is left; the message tells the unknowns, the equations, and what would help."""


@dataclass(frozen=True)
class Derivation:
    """The solution as statements, with the determinants of its two-root steps, and the conditioning of every step
    whose angle may be free.
    """

    statements: tuple[Statement, ...]
    determinants: tuple[StepDeterminant, ...]
    conditionings: tuple[Conditioning, ...]
    rules: tuple[str, ...]
    sums: tuple[Sum, ...] = ()
    residuals: tuple[sp.Expr, ...] = ()
    """With an equation too many: the expressions that vanish if the equations agree with each other."""
    conditions: tuple[sp.Expr, ...] = ()
    """Values of parameters that must not vanish."""
    plain: tuple[Statement, ...] = ()
    """The statements without `beyond_folds` and `within_reach`: the plain definitions of the names."""


def solve(problem: Problem, arguments: Sequence[sp.Expr], resolve_angle: Resolve) -> Derivation:
    """Solve a problem.

    arguments: those of the sines and cosines in the original equations, from which sums of angles about parallel axes
    are read. resolve_angle: gives the statements that bind an angle with its whole turns, for equations in which it
    stands outside sines and cosines. Raises `Unsolved` where no rule applies.
    """
    if (reason := undetermined(problem)) is not None:
        raise Unsolved(reason)
    record = DerivationRecord()
    sums: tuple[Sum, ...] = ()
    rules: list[str] = []
    left: list[sp.Expr] = []
    not_zero: list[sp.Expr] = []
    while problem.angles or problem.lengths or problem.pending:
        if problem.is_overdetermined and not problem.equations and not left:
            for condition in conditions(problem):
                binding = record.commit(Binding("rotation", (), condition.lets, residual=condition.expression))
                left += [binding.residual] if binding.residual is not None else []
        problem, binding, sums = _next(problem, sums, arguments)
        binding = record.commit(binding)
        rules.append(binding.rule)
        not_zero += binding.conditions
        plain = [a for a in binding.unknowns if any(a in e.expression.free_symbols for e in problem.equations)]
        for angle in plain:
            if angle not in problem.lengths:
                record.append(resolve_angle(angle))
        problem = _without(problem, binding, record)
    statements = record.statements
    if not problem.is_overdetermined:
        unfolded = beyond_folds(statements, record.determinants, record.conditionings, problem.scale)
        statements = within_reach(unfolded, record.determinants, record.conditionings)
    signs = known_signs(problem, record.determinants)
    return Derivation(
        with_known_signs(statements, signs),
        tuple(step for step in record.determinants if step not in signs),
        (*record.conditionings, *where_roots_meet(signs)),
        tuple(rules),
        sums,
        tuple(left),
        tuple(not_zero),
        with_known_signs(record.statements, signs),
    )


def _next(
    problem: Problem, sums: tuple[Sum, ...], arguments: Sequence[sp.Expr]
) -> tuple[Problem, Binding, tuple[Sum, ...]]:
    for total in sums:
        binding = resolve(problem, total) if total.replaced in problem.pending else None
        if binding is not None:
            return problem, binding, sums
    found = _best(candidate for tier in TIERS for candidate in [_candidates(problem, tier(problem))])
    if found is not None and not found.yields_to_a_sum:
        return problem, _with_one_root(problem, found), sums
    for total in candidate_sums(problem, arguments):
        trial = substitute(problem, total)
        wanted = (
            TIERS if found is None else TIERS[:1]
        )  # a cosine alone loses half the digits: both functions of a sum are better
        better = _best(_candidates(trial, tier(trial), total.symbol) for tier in wanted)
        if better is not None and (found is None or (better.rank < found.rank and problem.turns)):
            return trial, better, (*sums, total)
    if found is None and not problem.is_overdetermined:
        found = _best(last_resort(problem) for last_resort in _LAST)
    if found is not None:
        return problem, _with_one_root(problem, found), sums
    raise Unsolved(unsolved(problem))


def _with_one_root(problem: Problem, found: Binding) -> Binding:
    """The step, or one for the same unknowns with a single root, where the point seen from the joints that are known
    tells which of two roots it is.
    """
    if found.determinant is None or problem.is_overdetermined:
        return found
    both = (*_stated(problem), *positions(problem))
    single = [b for b in _candidates(problem, both, found.unknowns[0]) if b.determinant is None]
    return min((b for b in single if b.unknowns == found.unknowns), key=lambda b: b.rank, default=found)


def _three_lengths(problem: Problem) -> list[Binding]:
    return [b for equations in (_stated, positions) for b in affine_triple(problem, equations(problem))]


def _by_condition(problem: Problem) -> list[Binding]:
    """Lengths that equations determine for every machine but those for which a value of parameters vanishes."""
    known = replace(problem, fixed=problem.parameters)
    return next((found for tier in TIERS if (found := _lengths(known, tier(known)))), [])


def _lengths(problem: Problem, equations: tuple[Equation, ...]) -> list[Binding]:
    return [b for rule in (affine, affine_pair, affine_triple) for b in rule(problem, equations)]


def _three_squares(problem: Problem) -> list[Binding]:
    return _candidates(problem, squares_of_three(problem))


_LAST = (_three_lengths, _by_condition, _three_squares)


def _candidates(problem: Problem, equations: tuple[Equation, ...], wanted: sp.Symbol | None = None) -> list[Binding]:
    """What the rules find; with a wanted unknown, for that one. A step that gives a cosine alone is worked out only
    where there is no other.
    """
    found: list[Binding] = []
    for rules in (_BETTER, RULES):
        found = [b for rule in rules for b in rule(problem, equations) if wanted is None or wanted in b.unknowns]
        if not all(b.cosine_alone for b in found):
            break
    return found


def _best(tiers: Iterable[list[Binding]]) -> Binding | None:
    for candidates in tiers:
        if candidates:
            return min(candidates, key=lambda b: b.rank)  # min keeps the first of equals: deterministic
    return None


def _without(problem: Problem, binding: Binding, record: DerivationRecord) -> Problem:
    """The problem without the unknowns of a binding."""
    known = set(binding.unknowns)
    rest = replace(
        problem,
        angles=tuple(a for a in problem.angles if a not in known),
        lengths=tuple(v for v in problem.lengths if v not in known),
        pending=tuple(a for a in problem.pending if a not in known),
        definitions=record.definitions(problem.units),
    )
    equations = tuple(e for e in (*problem.equations, *binding.new_equations) if rest.unknowns_of(e.expression))
    return rest.with_equations(equations)
