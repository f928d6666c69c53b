"""The driver: solve unknowns one after the other by subproblems until none is left, or raise `Unsolved` with the rest.

It knows no mechanism: it asks every rule for candidates, takes the best, removes its unknowns, and repeats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.positions import positions, positions_and_distance, positions_from_flange
from derive.equations.problem import Binding, Equation, Problem
from derive.equations.rotations import rotations
from derive.ir.program import Statement
from derive.solver.derivation import Derivation, Step
from derive.solver.derivation_record import (
    DerivationRecord,
    left_alone,
    left_of_positions,
    left_of_rotation,
    unknowns_in,
    with_known_legs,
)
from derive.solver.eliminations import (
    differences,
    eliminations,
    free_of_lengths,
    lossy_differences,
    squares,
    squares_of_three,
    squares_with_lengths,
)
from derive.solver.meeting_axes import circles_and_spheres
from derive.solver.parallel_axes import Sum, candidate_sums, resolve, substitute
from derive.solver.positive_steps import known_signs, where_roots_meet, with_known_signs
from derive.solver.subproblems.affine_system import (
    affine,
    affine_across,
    affine_along,
    affine_along_or_free,
    affine_pair,
    affine_triple,
)
from derive.solver.subproblems.one_equation.trigonometric import lateral, trigonometric
from derive.solver.subproblems.pair import pair, scaled_pair
from derive.solver.subproblems.polar import polar
from derive.solver.subproblems.quadratic import quadratic
from derive.solver.subproblems.spheres import spheres
from derive.solver.subproblems.two_slides import of_turns, rotation_gives_turns, two_slides
from derive.solver.unsolved import Exhausted, Undetermined, Unsolved, undetermined, unsolved
from derive.work import TooMuchWork, at_most, spend

Rule = Callable[[Problem, tuple[Equation, ...]], Iterator[Binding]]
RULES: tuple[Rule, ...] = (affine, affine_pair, pair, polar, trigonometric, quadratic, spheres)
_BETTER: tuple[Rule, ...] = tuple(lateral if rule is trigonometric else rule for rule in RULES)
"""The rules without the steps that give a cosine alone, which rank behind all others."""


def _stated(problem: Problem) -> tuple[Equation, ...]:
    """The equations of the problem and those of the rotation. With one equation too many the rotation waits until the
    positions are solved.
    """
    if problem.is_overdetermined and problem.equations:
        return problem.equations
    return problem.equations + rotations(problem)


def _between_positions(problem: Problem) -> tuple[Equation, ...]:
    """The differences of the positions seen in a known frame."""
    return differences(replace(problem, equations=positions(problem)))


def _squares_of_positions(problem: Problem) -> tuple[Equation, ...]:
    """The sums of squares of the positions seen in a known frame."""
    seen = replace(problem, equations=positions(problem))
    return squares(seen) + squares_with_lengths(seen)


TIERS: tuple[Callable[[Problem], tuple[Equation, ...]], ...] = (
    _stated,
    differences,
    eliminations,
    positions,
    _between_positions,
    squares,
    squares_with_lengths,
    _squares_of_positions,
    lossy_differences,
    free_of_lengths,
    positions_from_flange,
)
Resolve = Callable[[sp.Symbol], tuple[Statement, ...]]
MOST_TERMS = 100_000
"""The work of one derivation, in terms (`derive.work`): some seconds."""


def solve(problem: Problem, arguments: Sequence[sp.Expr], resolve_angle: Resolve) -> Derivation:
    """Solve a problem.

    arguments: those of the sines and cosines in the original equations, from which sums of angles about parallel axes
    are read. resolve_angle: gives the statements that bind an angle with its whole turns, for equations in which it
    stands outside sines and cosines. Raises `Unsolved` if no rule applies, `Exhausted` if
    rules meet expressions with too many terms.
    """
    try:
        with at_most(MOST_TERMS):
            turned = _turns_first(problem, arguments, resolve_angle) if rotation_gives_turns(problem) else None
            return turned or _solved(problem, arguments, resolve_angle)
    except TooMuchWork as much:
        raise Exhausted(f"{unsolved(problem)}\n    (given up after {much.most:.0f} terms)") from None


def _solved(problem: Problem, arguments: Sequence[sp.Expr], resolve_angle: Resolve) -> Derivation:
    if (reason := undetermined(problem)) is not None:
        raise Undetermined(reason)
    record, is_trial = DerivationRecord(), problem.is_overdetermined
    sums: tuple[Sum, ...] = ()
    rules: list[str] = []
    steps: list[Step] = []
    has_spare = len(unknowns_in(problem)) < len(problem.equations)
    left = left_alone(problem, record) if is_trial else []
    problem = replace(problem, is_overdetermined=is_trial and not left)
    wrist: tuple[sp.Symbol, ...] = ()
    not_zero: list[sp.Expr] = []
    while problem.angles or problem.lengths or problem.pending:
        if problem.is_overdetermined and not problem.equations and not left:
            left += left_of_rotation(problem, record)
            if not left and has_spare:  # a wrist takes any rotation, so the surplus equation is one of the positions
                left, wrist = left_of_positions(problem, record), problem.angles
                problem = replace(problem, is_overdetermined=False)
        try:
            problem, binding, sums = _next_after(steps, problem, sums, arguments)
        except Unsolved:
            if problem.is_overdetermined and not left:  # parallel axes: the rotation gives their sum before a position
                left += left_of_rotation(problem, record)
            if not left or not problem.is_overdetermined:
                raise
            problem = replace(problem, is_overdetermined=False)
            continue
        begin, found, binding = len(record.statements), binding, record.commit(binding)
        names = tuple(record.renamed.items())
        rules.append(binding.rule)
        not_zero += binding.conditions
        for angle in _read_plainly(problem, binding.unknowns):
            record.append(resolve_angle(angle))
        steps.append(Step(problem, found, binding, (begin, len(record.statements)), names))
        problem = _without(problem, binding, record)
    if is_trial and not problem.turns:
        left = left_of_positions(problem, record)
    statements = record.statements if is_trial else with_known_legs(record.statements, record.determinants)
    signs = known_signs(problem, record.determinants)
    return Derivation(
        with_known_signs(statements, signs),
        tuple(step for step in record.determinants if step not in signs),
        (*record.conditionings, *where_roots_meet(signs)),
        tuple(rules),
        sums,
        tuple(left),
        wrist,
        tuple(not_zero),
        with_known_signs(record.statements, signs),
        tuple(steps),
    )


def _turns_first(problem: Problem, arguments: Sequence[sp.Expr], resolve_angle: Resolve) -> Derivation | None:
    """A trial whose turns the rotation gives; then the positions give two slides, and leave one equation."""
    try:
        found = _solved(of_turns(problem), arguments, resolve_angle)
    except Unsolved:
        return None
    known = replace(problem, angles=(), turns=(), is_overdetermined=False)
    binding = next(two_slides(known, problem.equations), None)
    if binding is None or binding.residual is None:
        return None
    plain = (*found.plain, *binding.statements)
    step = Step(known, binding, binding, (len(found.plain), len(plain)))
    return replace(
        found, statements=(*found.statements, *binding.statements), plain=plain, residuals=(binding.residual,),
        rules=(*found.rules, binding.rule), steps=(*found.steps, step),
    )  # fmt: skip


def _read_plainly(problem: Problem, unknowns: Sequence[sp.Symbol]) -> list[sp.Symbol]:
    """The angles that an equation reads outside sines and cosines."""
    read = {symbol for equation in problem.equations for symbol in equation.expression.free_symbols}
    return [u for u in unknowns if u in read and u not in problem.lengths]


def _next_after(
    steps: Sequence[Step], problem: Problem, sums: tuple[Sum, ...], arguments: Sequence[sp.Expr]
) -> tuple[Problem, Binding, tuple[Sum, ...]]:
    """The next step; if there is none, the refusal holds those before it."""
    try:
        return _next(problem, sums, arguments)
    except Unsolved as stuck:
        stuck.steps = tuple(steps)
        raise


def _next(
    problem: Problem, sums: tuple[Sum, ...], arguments: Sequence[sp.Expr]
) -> tuple[Problem, Binding, tuple[Sum, ...]]:
    for total in sums:
        binding = resolve(problem, total) if total.replaced in problem.pending else None
        if binding is not None:
            return problem, binding, sums
    found, seen = _of_a_trial(problem), _seen_from_slides(problem)
    if found is None:
        found = _best(candidate for tier in TIERS for candidate in [_candidates(seen, tier(seen))])
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
        found = _best(last_resort(seen) for last_resort in _LAST)
    if found is not None:
        return problem, _with_one_root(problem, found), sums
    raise Unsolved(unsolved(problem))


def _seen_from_slides(problem: Problem) -> Problem:
    """The problem; with every angle known, its positions seen in the known frame in front of the slides: an equation
    there has often one of them alone, and is always shorter.
    """
    if problem.angles or problem.pending:
        return problem
    return replace(problem, equations=positions(problem) or problem.equations)


def _of_a_trial(problem: Problem) -> Binding | None:
    """A step of a trial without two roots, which leaves a residual of the positions: for a point alone, or where the
    joints of a wrist take any rotation.
    """
    if not problem.is_overdetermined or (problem.turns and len(unknowns_in(problem)) >= len(problem.equations)):
        return None
    return _best([list(scaled_pair(problem, positions_and_distance(problem)))])


def _with_one_root(problem: Problem, found: Binding) -> Binding:
    """The step, or one with a single root for the same unknowns, where the point seen from the known joints determines
    which of two roots it is.
    """
    if found.determinant is None or problem.is_overdetermined:
        return found
    both = (*_stated(problem), *positions(problem))
    single = [b for b in _candidates(problem, both, found.unknowns[0]) if b.determinant is None]
    return min((b for b in single if b.unknowns == found.unknowns), key=lambda b: b.rank, default=found)


def _along_a_direction(problem: Problem) -> list[Binding]:
    return [b for equations in (_stated, positions) for b in affine_along(problem, equations(problem))]


def _three_lengths(problem: Problem) -> list[Binding]:
    return [b for equations in (_stated, positions) for b in affine_triple(problem, equations(problem))]


def _by_condition(problem: Problem) -> list[Binding]:
    """Steps for lengths that equations determine for every machine, unless a value made of its parameters vanishes."""
    known = replace(problem, fixed=problem.parameters)
    return next((found for tier in TIERS if (found := _lengths(known, tier(known)))), [])


def _lengths(problem: Problem, equations: tuple[Equation, ...]) -> list[Binding]:
    return [b for rule in (affine, affine_pair, affine_triple) for b in rule(problem, equations)]


def _along_or_free(problem: Problem) -> list[Binding]:
    return list(affine_along_or_free(problem, _stated(problem)))


def _across(problem: Problem) -> list[Binding]:
    return [b for equations in (_stated, positions) for b in affine_across(problem, equations(problem))]


def _three_squares(problem: Problem) -> list[Binding]:
    return _candidates(problem, squares_of_three(problem))


def _meeting_axes(problem: Problem) -> list[Binding]:
    return _candidates(problem, circles_and_spheres(problem))


_LAST = (_along_a_direction, _three_lengths, _by_condition, _three_squares, _along_or_free, _across, _meeting_axes)


def _candidates(problem: Problem, equations: tuple[Equation, ...], wanted: sp.Symbol | None = None) -> list[Binding]:
    """The steps that the rules find, all or those for a wanted unknown. A step that gives a cosine alone is computed
    only if there is no other.
    """
    spend(sum(len(sp.Add.make_args(e.expression)) for e in equations))
    answers = {rule: tuple(rule(problem, equations)) for rule in _BETTER}
    found = _of(answers.values(), wanted)
    if all(b.cosine_alone for b in found):
        answers[lateral] = tuple(trigonometric(problem, equations))
        found = _of(answers.values(), wanted)
    return found


def _of(answers: Iterable[Sequence[Binding]], wanted: sp.Symbol | None) -> list[Binding]:
    return [b for answer in answers for b in answer if wanted is None or wanted in b.unknowns]


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
