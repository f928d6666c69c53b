"""The derivation of a mechanism for a reader: its closure, its steps with the equations that they use, the branches
that they decide, and the margins.

It is read from what was solved for the build.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import sympy as sp

from derive.algebra.normal_form import cancelled, reduce_units
from derive.description.mechanism import Joint, Mechanism, Parameter
from derive.equations.closures.fixed_names import fixed_lets
from derive.equations.problem import Binding, Conditioning, Equation, Problem, StepDeterminant
from derive.ir.primitives import Root
from derive.ir.program import Let, Statement, rewritten
from derive.ir.symbols import ASSEMBLY_SIGN, cosine, sine
from derive.kinematics.branches.assignment import Assignment, with_branch_signs
from derive.kinematics.forward import solve_for_position
from derive.kinematics.inverse import Inverse
from derive.kinematics.margins import Factor
from derive.kinematics.search.derivations import Searched
from derive.kinematics.solution import Solution
from derive.plate.passive import mode_of, solve_passive
from derive.solver.derivation import Derivation, Step
from derive.solver.parallel_axes import Sum
from derive.solver.positive_steps import known_signs
from derive.solver.solve import RULES, TIERS, Rule
from derive.solver.subproblems.affine_system import affine_triple
from derive.solver.subproblems.one_equation.trigonometric import lateral
from derive.solver.subproblems.two_slides import two_slides

_WORTH_A_NAME = 3
"""The least number of operations of a value that stands under its name in an equation of many operations."""
MANY = 40
"""An equation with more operations is written in the names that its step binds."""

FORMS = {
    "affine": "linear in the unknown",
    "affine pair": "two equations, linear in both unknowns",
    "affine along": "two or three equations of a length along a known direction",
    "affine along or free": "linear in it in several of them, along the direction of its slide, where it has one",
    "affine across": "linear in it, where its slide does not point across",
    "affine triple": "three equations, linear in all three unknowns",
    "pair": "cosine and sine are linear in two equations: the rotation that takes one vector to another",
    "polar": "two equations that are its cosine and its sine, times one unknown radius: two solutions",
    "trigonometric": "a cos u + b sin u = c, the law of cosines: two solutions",
    "lateral": "a cos u + b sin u = c for a point beside the axis: two solutions",
    "quadratic": "a square: two solutions",
    "two slides": "three equations, linear in both unknowns; what is left across both is zero at a solution",
    "spheres": "circles or spheres about known points: two solutions",
    "sum": "the sum of parallel angles, less those that are known",
}
"""The equation that each rule solves."""


@dataclass(frozen=True)
class ExplainedStep:
    """One step: unknowns ← rule ← equations, and the names that it binds."""

    number: int
    unknowns: tuple[sp.Symbol, ...]
    rule: str
    equations: tuple[Equation, ...]
    """In the names of the derivation."""
    statements: tuple[Statement, ...]
    determinant: StepDeterminant | None
    assignments: tuple[Assignment, ...]
    """The branches that its sign decides."""
    conditioning: Conditioning | None
    conditions: tuple[sp.Expr, ...]
    """The values that Initialize refuses at zero."""
    total: Sum | None = None
    """The sum of angles that it takes apart."""
    only: int = 0
    """The sign of the determinant, where this machine has one of the two solutions alone."""


@dataclass(frozen=True)
class Route:
    """One solved problem: its closure and its steps."""

    title: str
    equations: tuple[Equation, ...]
    """The closure, in the names of the derivation."""
    known: tuple[Statement, ...]
    """The statements before the first step."""
    steps: tuple[ExplainedStep, ...]
    frozen: tuple[Joint, ...] = ()
    residuals: tuple[sp.Expr, ...] = ()
    """The residuals of a trial, which are zero at a root."""
    assignments: tuple[Assignment, ...] = ()


@dataclass(frozen=True)
class Derived:
    """The derivation of a mechanism."""

    mechanism: Mechanism
    """The mechanism as it is derived: its numbers have names, its gears are moved to the joints."""
    inverse: tuple[Route, ...]
    forward: Route | None
    """The forward kinematics of a closed loop, where it has a closed form."""
    factors: tuple[Factor, ...]
    """The formulas of the margins."""
    searched: Joint | None = None
    where: Parameter | None = None
    """The parameter at whose zero no root search is needed."""


def derived_of(solution: Solution) -> Derived:
    """The derivation of a machine, from its solution."""
    if isinstance(solution, Searched):
        return _searched(solution)
    mechanism = solution.mechanism
    routes = [_route("Inverse kinematics", solution.inverse, solution.assignments)]
    if mechanism.passive:
        passive = solve_passive(mechanism)
        steps = _Explained(passive, {step.sigma: mode_of(step) for step in passive.determinants}).steps()
        routes.insert(0, Route(f"What the task does not command: {', '.join(mechanism.passive)}", (), (), steps))
    return Derived(mechanism, tuple(routes), _forward(mechanism), solution.factors)


def _searched(both: Searched) -> Derived:
    mechanism, search = both.mechanism, both.mechanism.search
    assert search is not None
    title = f"A trial: {search.joint.name} is known"
    if both.eliminated is not None:
        title += f"; {both.eliminated.elimination.words}"
    routes = [_route(title, both.trial, both.trial_branches)]
    if both.closed is not None and search.where is not None:
        title = f"Where {search.where.name} is 0: in closed form"
        routes.insert(0, _route(title, both.closed, both.closed_branches))
    return Derived(mechanism, tuple(routes), None, (), search.joint, search.where)


def _route(title: str, inverse: Inverse, assignments: Sequence[Assignment]) -> Route:
    derivation = inverse.derivation
    signs = with_branch_signs((), assignments)
    explained = _Explained(
        derivation, {a.determinant.sigma: a.orientation * a.factor for a in assignments}, assignments
    )
    left = tuple(explained.signed(r) for r in derivation.residuals)
    known = (*inverse.naming, *signs, *(rewritten(let, explained.signed) for let in inverse.free))
    equations = tuple(_recorded(e, derivation) for e in inverse.closure.equations)
    return Route(title, equations, known, explained.steps(), inverse.frozen, left, tuple(assignments))


def _recorded(equation: Equation, derivation: Derivation) -> Equation:
    """An equation in the recorded names, in which equal values have one name."""
    names = {s.value: s.name for s in reversed(derivation.plain) if isinstance(s, Let)}
    table: dict[sp.Symbol, sp.Symbol] = {}
    for let in equation.lets:
        table[let.name] = names.get(let.value.xreplace(table), let.name)
    return Equation(equation.label, equation.expression.xreplace(table))


def _forward(mechanism: Mechanism) -> Route | None:
    if mechanism.chain is not None or mechanism.is_platform:
        return None
    derivation = solve_for_position(mechanism)
    sides = {s.sigma: ASSEMBLY_SIGN for s in derivation.determinants}
    return Route("Forward kinematics", (), fixed_lets(mechanism), _Explained(derivation, sides).steps())


class _Explained:
    """The steps of a derivation, in the signs of branches."""

    def __init__(
        self, derivation: Derivation, signs: Mapping[sp.Symbol, sp.Expr], assignments: Sequence[Assignment] = ()
    ) -> None:
        made = [s.recorded.determinant for s in derivation.steps if s.recorded.determinant is not None]
        single = known_signs(derivation.steps[-1].problem, made) if made else {}
        self._derivation, self._assignments = derivation, assignments
        self._known = {step.step: sign for step, sign in single.items()}
        self._signs = {**signs, **{step.sigma: sp.Integer(sign) for step, sign in single.items()}}

    def signed(self, value: sp.Expr) -> sp.Expr:
        """An expression in the signs of branches."""
        return value.xreplace(self._signs)

    def steps(self) -> tuple[ExplainedStep, ...]:
        """All steps, in their order."""
        return tuple(self._step(number, step) for number, step in enumerate(self._derivation.steps, 1))

    def _step(self, number: int, step: Step) -> ExplainedStep:
        plain, binding, names = _plain(number, step), step.recorded, dict(step.names)
        own = tuple(rewritten(s, lambda e: e.xreplace(self._signs)) for s in self._derivation.plain[slice(*step.span)])
        equations = [Equation(e.label, self.signed(e.expression.xreplace(names))) for e in plain.equations]
        made, partial = plain.determinant, plain.conditioning
        is_sum = binding.rule == "sum"
        return replace(
            plain,
            equations=tuple(Equation(e.label, _in_names(e.expression, own, step.problem, binding)) for e in equations),
            statements=own,
            determinant=None if made is None else replace(made, value=self.signed(made.value)),
            assignments=tuple(a for a in self._assignments if made is not None and a.determinant.step == made.step),
            conditioning=None if partial is None else replace(partial, value=self.signed(partial.value)),
            total=next((t for t in self._derivation.sums if is_sum and t.replaced in binding.unknowns), None),
            only=0 if made is None else self._known.get(made.step, 0),
        )


def unfinished(steps: Sequence[Step]) -> tuple[ExplainedStep, ...]:
    """The steps of a derivation that did not reach its end."""
    return tuple(_plain(number, step) for number, step in enumerate(steps, 1))


def _plain(number: int, step: Step) -> ExplainedStep:
    binding = step.recorded
    return ExplainedStep(
        number=number,
        unknowns=binding.unknowns,
        rule=binding.rule,
        equations=equations_of(step),
        statements=(),
        determinant=binding.determinant,
        assignments=(),
        conditioning=binding.conditioning,
        conditions=binding.conditions,
    )


def _in_names(value: sp.Expr, statements: Sequence[Statement], problem: Problem, binding: Binding) -> sp.Expr:
    """An equation of many operations, collected by its unknowns, in the names that the step has for coefficients."""
    if sp.count_ops(value) <= MANY:
        return value
    atoms = [a for u in binding.unknowns for a in (u, cosine(u), sine(u)) if value.has(a)]
    lets = [s for s in statements if isinstance(s, Let) and s.value.free_symbols]
    parts = sp.collect(sp.expand(value), atoms, evaluate=False)
    terms = [(atom, _named(sp.together(c), lets, problem)) for atom, c in parts.items()]
    return sp.Add(*(c if atom == 1 else sp.Mul(c, atom, evaluate=False) for atom, c in terms))


def _named(value: sp.Expr, lets: Sequence[Let], problem: Problem) -> sp.Expr:
    """A coefficient as a multiple of a named value, or as the square of a named root, plus the rest."""
    best = value
    for let in lets:
        if isinstance(let.value, Root):
            values = {other.name: other.value for other in lets if other.name in let.value.free_symbols}
            square = let.value.args[0].xreplace(values)
            rest = reduce_units(sp.expand(value - square), problem.units, problem.signs)
            if sp.count_ops(rest) < sp.count_ops(best) / 2:
                best = let.name**2 + rest
        elif sp.count_ops(let.value) >= _WORTH_A_NAME and let.value.is_rational_function():
            ratio = cancelled(value / let.value)
            if sp.count_ops(ratio) < sp.count_ops(best) / 3 and not ratio.is_Add:
                best = ratio * let.name
    return best


_MOST = {1: 80, 2: 24, 3: 9}
"""The largest number of equations that are tried: alone, in pairs, by three."""


def equations_of(step: Step) -> tuple[Equation, ...]:
    """The equations, in the names that their rule was given; empty if they are not found again."""
    if not step.found.unknowns:
        return ()
    for problem in (step.problem, replace(step.problem, fixed=step.problem.parameters)):
        for tier in TIERS:
            found = next(_again(step, problem, tier(problem)), None)
            if found is not None:
                return found
    return ()


def _again(step: Step, problem: Problem, equations: tuple[Equation, ...]) -> Iterator[tuple[Equation, ...]]:
    """The smallest sets of equations from which a rule finds the step."""
    unknowns = set(step.found.unknowns)
    about = tuple(e for e in equations if unknowns & set(problem.unknowns_of(e.expression)))
    rules = [rule for rule in _rules(step) if _finds(rule, step, problem, about)]
    for count, most in _MOST.items():
        for some in combinations(about[:most], count):
            if any(_finds(rule, step, problem, some) for rule in rules):
                yield some


def _rules(step: Step) -> tuple[Rule, ...]:
    """The rules that may have found the step, those with its name first."""
    every = (*RULES, lateral, affine_triple, two_slides)
    return tuple(sorted(every, key=lambda rule: rule.__name__ != step.found.rule.replace(" ", "_")))


def _finds(rule: Rule, step: Step, problem: Problem, equations: tuple[Equation, ...]) -> bool:
    wanted = step.found
    return any(b.unknowns == wanted.unknowns and b.statements == wanted.statements for b in rule(problem, equations))
