"""`explain`: the derivation of a machine, step by step, in plain text or as a page, or its programs as plain text; for
unnamed branches it shows how to name them.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import sympy as sp

from derive.command.own import described, each
from derive.command.report import opened, written
from derive.command.stages import Stages
from derive.description.catalogue import load_with_variables
from derive.description.mechanism import Mechanism
from derive.faults import error
from derive.form.inner_names import in_given_names
from derive.ir.text import text_of
from derive.kinematics.branches.derived import in_words
from derive.kinematics.build import build
from derive.kinematics.shared_names import with_free_names
from derive.kinematics.solution import prepared, solve_machine
from derive.report.derived import FORMS, Derived, ExplainedStep, Route, derived_of, unfinished
from derive.solver.unsolved import Unsolved

_LONGEST = 160


def explain(options: argparse.Namespace) -> int:
    """Print the derivation of every machine, or write its page; 2 where one of them cannot be derived."""

    def explained(path: Path, stages: Stages) -> None:
        mechanism, variables = load_with_variables(path)
        if options.html:
            opened(written(path, mechanism, options.out, stages))
            return
        try:
            for line in programs(mechanism) if options.programs else explanation(mechanism, variables):
                stages.line(line)
        except Exception as problem:
            raise error(path, problem) from None

    return each(described(options.files), explained, keep_going=True, with_trace=options.traceback)


def programs(mechanism: Mechanism) -> Iterator[str]:
    """The programs of one machine as text: the inverse as it was derived, then all programs as languages get them."""
    kin = build(mechanism)
    derived = replace(kin.derived_branch, name="branch, as it was derived")
    for program in (derived, kin.setup, *kin.shared, *kin.programs):
        yield from text_of(program).split("\n")


def explanation(mechanism: Mechanism, variables: Mapping[str, str] | None = None) -> Iterator[str]:
    """The lines of one machine. Raises `Unsolved` or `DescriptionError` if it cannot be derived.

    The lines to be put into its file are written in `variables`: those of the file, by names of joints and parameters.
    """
    try:
        solution = with_free_names(mechanism, lambda further: solve_machine(prepared(mechanism, further)))
    except Unsolved as stuck:
        yield "Inverse kinematics, as far as it goes"
        for step in unfinished(stuck.steps):
            yield from _step(mechanism, step)
        raise
    derived = derived_of(solution)
    for line in _derivation(derived, variables):
        yield in_given_names(line, derived.mechanism)


def _derivation(derived: Derived, variables: Mapping[str, str] | None) -> Iterator[str]:
    """The lines of a machine that is derived, with its inner names."""
    if derived.searched is not None:
        where = f"Where {derived.where.given_name} is not 0, " if derived.where is not None else ""
        yield f"{where}{derived.searched.name} is searched for roots: a trial takes it as known."
    for route in derived.inverse:
        yield from _route(derived.mechanism, route)
    yield from _branches(derived.mechanism, variables)
    yield from _forward(derived, variables)


def _route(mechanism: Mechanism, route: Route) -> Iterator[str]:
    """The lines of one solved problem."""
    yield route.title
    for equation in route.equations:
        yield f"  equation {equation.label}: {_written(equation.expression)}"
    for joint in route.frozen:
        yield f"  {joint.name} is held: it stays where the reference has it"
    for step in route.steps:
        yield from _step(mechanism, step)
    for left in route.residuals:
        yield f"  residual, which vanishes at a root: {_written(left)}"


def _step(mechanism: Mechanism, step: ExplainedStep) -> Iterator[str]:
    """One step: unknown <- rule <- equations, and what it means."""
    unknowns = ", ".join(_name(mechanism, u) for u in step.unknowns) or "no unknown"
    others = "the sum and its other angles" if step.rule == "sum" else "the equations above"
    used = " and ".join(e.label for e in step.equations) or others
    yield f"  {step.number}. {unknowns} <- {step.rule} <- {used}"
    yield f"       form: {FORMS.get(step.rule, step.rule)}"
    if step.determinant is not None:
        value, scale = step.determinant.value, step.determinant.scale
        yield f"       determinant: {_plain(value)}, over {_plain(scale)}; where it is 0 both solutions meet"
    for found in step.assignments:
        first, second = found.branch.names
        same = "the sign" if found.orientation > 0 else "the opposite sign"
        yield f"       branch {found.branch.name}: 1 {first}, 2 {second}; {same} of the determinant is 1"
    if step.conditioning is not None:
        angle = _name(mechanism, step.conditioning.angle)
        yield f"       {angle} is free where {_plain(step.conditioning.value)} = 0: there it is that of the reference"
    for condition in step.conditions:
        yield f"       Initialize refuses a machine where {_plain(condition)} = 0"


def _branches(mechanism: Mechanism, variables: Mapping[str, str] | None) -> Iterator[str]:
    """The lines on the branches: their names, or how to name them."""
    if not mechanism.branches:
        yield "Branches: none, every pose has one solution"
        return
    yield "Branches"
    for branch in mechanism.branches:
        signs = ", ".join(f"{n}={s:+d}" for n, s in zip(branch.names, branch.signs, strict=True))
        if branch.is_crossing and mechanism.search is not None:
            joint, bytes_ = mechanism.search.joint.name, zip(branch.signs, (1, 2), branch.names, strict=True)
            first, second = (f"{byte} {name}" for _, byte, name in sorted(bytes_, reverse=True))
            yield f'  crossing("{branch.name}", {signs})'
            rises = f"whether the residual rises ({first}) or falls ({second}) with {joint} at the root"
            sign = f"whether the determinant of the Jacobian is positive ({first}) or negative ({second})"
            yield f"       {sign if mechanism.search.is_eliminated else rises};"
            yield f"       of the roots of one branch the answer is next to the reference, or has the nearest {joint}"
            continue
        indicator = in_words(mechanism, branch.indicator, variables)
        yield f'  branch("{branch.name}", {indicator}, {signs})'
        if branch.meanings[0]:
            first, second = branch.meanings
            yield f"       derived, to be named: 1 {branch.names[0]} where {first}, 2 {branch.names[1]} where {second}"
    if any(branch.meanings[0] for branch in mechanism.branches):
        yield "  If your machine only has the positive side of a branch: positive=(its expression,), and no such branch"


def _forward(derived: Derived, variables: Mapping[str, str] | None) -> Iterator[str]:
    """The steps of the forward kinematics of a closed loop; a chain has none."""
    mechanism = derived.mechanism
    yield "Forward kinematics"
    if derived.forward is None:
        by_newton = "Newton's method from the home pose; the assembly mode is that of the home pose"
        yield f"  {by_newton if mechanism.is_platform else 'the product of the chain'}"
        return
    for step in derived.forward.steps:
        yield from _step(mechanism, step)
    if (way := mechanism.assembly) is not None:
        yield f"  assembly {way.name}: {way.parameter} chooses the second mode"
        if way.meanings[0]:
            signs = ", ".join(f"{n}={s:+d}" for n, s in zip(way.names, way.signs, strict=True))
            indicator = in_words(mechanism, way.indicator, variables)
            yield f'  assembly("{way.name}", {indicator}, margin="{way.margin}", {signs})'
            first, second = way.meanings
            yield f"       derived, to be named: {way.names[0]} where {first}; {way.names[1]} where {second}"


def _name(mechanism: Mechanism, unknown: sp.Symbol) -> str:
    return next((j.moved_name for j in mechanism.joints if j.symbol == unknown), str(unknown))


def _plain(value: sp.Basic) -> str:
    text = str(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} …"


def _written(value: sp.Expr) -> str:
    text = f"{value} = 0"
    return text if len(text) <= _LONGEST else f"{len(sp.Add.make_args(value))} terms"
