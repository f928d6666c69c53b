"""The equations from which a step was made: those from which its rule finds the step again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

from derive.equations.problem import Equation, Problem
from derive.solver.solve import RULES, TIERS, Rule, Step
from derive.solver.subproblems.affine_system import affine_triple
from derive.solver.subproblems.one_equation.trigonometric import lateral

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
    every = (*RULES, lateral, affine_triple)
    return tuple(sorted(every, key=lambda rule: rule.__name__ != step.found.rule.replace(" ", "_")))


def _finds(rule: Rule, step: Step, problem: Problem, equations: tuple[Equation, ...]) -> bool:
    wanted = step.found
    return any(b.unknowns == wanted.unknowns and b.statements == wanted.statements for b in rule(problem, equations))
