"""`explain`: the derivation of a machine, step by step, in plain text or as a page; for unnamed branches it shows how
to name them.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import sympy as sp

from derive.command.own import described, each
from derive.command.report import opened, written
from derive.command.stages import Stages
from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.equations.problem import Equation
from derive.faults import error
from derive.kinematics.branches.assembly import assembled, with_derived_assembly
from derive.kinematics.branches.assignment import Assignment, assign
from derive.kinematics.branches.derived import in_words, with_derived_branches
from derive.kinematics.build import prepared
from derive.kinematics.forward import pose_at_axes, solve_for_position
from derive.kinematics.inverse import Inverse, solve_at, solve_pose
from derive.kinematics.scan.choice import with_search
from derive.kinematics.scan.derivations import without_search
from derive.plate.passive import solve_passive
from derive.report.used import equations_of
from derive.solver.solve import Step
from derive.solver.unsolved import Unsolved

_FORMS = {
    "affine": "linear in it",
    "affine pair": "two equations, linear in both",
    "affine along": "two or three equations of a length along a known direction",
    "affine along or free": "linear in it in several of them, along the direction of its slide, where it has one",
    "affine across": "linear in it, where its slide does not point across",
    "affine triple": "three equations, linear in all",
    "pair": "its cosine and its sine are linear in two equations: a rotation that takes one vector to another",
    "polar": "two equations that are its cosine and its sine, times one unknown radius",
    "trigonometric": "a cos u + b sin u = c: law of cosines, two solutions",
    "lateral": "a cos u + b sin u = c for a point beside the axis, two solutions",
    "quadratic": "a square, two solutions",
    "spheres": "circles or spheres about known points, two solutions",
    "sum": "the sum of parallel angles, less those that are known",
}
"""The forms of equations that rules solve."""
_LONGEST = 160


def explain(options: argparse.Namespace) -> int:
    """Print the derivation of every machine, or write its page; 2 where one of them cannot be derived."""

    def told(path: Path, stages: Stages) -> None:
        mechanism = load(path)
        if options.html:
            opened(written(path, mechanism, options.out, stages))
            return
        try:
            for line in explanation(mechanism):
                stages.line(line)
        except Exception as problem:
            raise error(path, problem) from None

    return each(described(options.files), told, keep_going=True, with_trace=options.traceback)


def explanation(mechanism: Mechanism) -> Iterator[str]:
    """The lines of one machine. Raises `Unsolved` or `DescriptionError` where it cannot be derived."""
    mechanism = with_derived_assembly(with_search(prepared(mechanism)))
    if mechanism.search is not None:
        joint, parameter = mechanism.search.joint, mechanism.search.where
        if parameter is None:
            yield f"{joint.name} is scanned for roots. The steps below are those of a trial, where it is known."
            yield from _trial(mechanism, solve_at(mechanism, joint))
            return
        name = parameter.given_name
        yield f"Where {name} is not 0, {joint.name} is scanned for roots. Below are the steps where it is 0."
        mechanism = without_search(mechanism)
    try:
        inverse = solve_pose(mechanism)
    except Unsolved as stuck:
        yield "Inverse kinematics, as far as it goes"
        for number, step in enumerate(stuck.steps, 1):
            yield from _step(mechanism, number, step, ())
        raise
    forward = assembled(mechanism, pose_at_axes(mechanism)).forward
    whole = with_derived_branches(mechanism, inverse, forward)
    assignments = assign(whole, inverse, forward)
    yield "Inverse kinematics"
    yield from _equations(inverse.closure.equations)
    yield from _held(inverse)
    passive = solve_passive(mechanism).steps if mechanism.passive else ()
    if passive:
        yield f"  not commanded: {', '.join(mechanism.passive)}; from the guides, on the side of the home pose"
    for number, step in enumerate((*passive, *inverse.derivation.steps), 1):
        yield from _step(mechanism, number, step, assignments)
    yield from _branches(whole)
    yield from _forward(mechanism)


def _trial(mechanism: Mechanism, inverse: Inverse) -> Iterator[str]:
    yield from _equations(inverse.closure.equations)
    for number, step in enumerate(inverse.derivation.steps, 1):
        yield from _step(mechanism, number, step, ())
    for left in inverse.derivation.residuals:
        yield f"  residual, which vanishes at a root: {_written(left)}"
    yield from _branches(mechanism)
    yield from _forward(mechanism)


def _equations(equations: Sequence[Equation]) -> Iterator[str]:
    for equation in equations:
        yield f"  equation {equation.label}: {_written(equation.expression)}"


def _held(inverse: Inverse) -> Iterator[str]:
    for joint in inverse.frozen:
        yield f"  {joint.name} is held: it stays where the reference has it"


def _step(mechanism: Mechanism, number: int, step: Step, assignments: Sequence[Assignment]) -> Iterator[str]:
    """One step: unknown <- rule <- equations, and what it means."""
    binding = step.recorded
    unknowns = ", ".join(_name(mechanism, u) for u in binding.unknowns) or "no unknown"
    others = "the sum and its other angles" if binding.rule == "sum" else "the equations above"
    used = " and ".join(e.label for e in equations_of(step)) or others
    yield f"  {number}. {unknowns} <- {binding.rule} <- {used}"
    yield f"       form: {_FORMS.get(binding.rule, binding.rule)}"
    if binding.determinant is not None:
        value, scale = binding.determinant.value, binding.determinant.scale
        yield f"       determinant: {_plain(value)}, over {_plain(scale)}; where it is 0 both solutions meet"
        for found in (a for a in assignments if a.determinant.step == binding.determinant.step):
            named = found.branch
            same = "the sign" if found.orientation > 0 else "the opposite sign"
            yield f"       branch {named.name}: 1 {named.names[0]}, 2 {named.names[1]}; {same} of the determinant is 1"
    if binding.conditioning is not None:
        angle = _name(mechanism, binding.conditioning.angle)
        value = _plain(binding.conditioning.value)
        yield f"       {angle} is free where {value} = 0: there it is that of the reference"
    for condition in binding.conditions:
        yield f"       Initialize refuses a machine where {_plain(condition)} = 0"


def _branches(mechanism: Mechanism) -> Iterator[str]:
    """The lines on the branches: their names, or how to name them."""
    if not mechanism.branches:
        yield "Branches: none, every pose has one solution"
        return
    yield "Branches"
    for branch in mechanism.branches:
        signs = ", ".join(f"{n}={s:+d}" for n, s in zip(branch.names, branch.signs, strict=True))
        if branch.is_crossing and mechanism.search is not None:
            joint, (first, second) = mechanism.search.joint.name, branch.names
            yield f'  crossing("{branch.name}", {signs})'
            yield f"       whether the residual rises (1 {first}) or falls (2 {second}) with {joint} at the root;"
            yield f"       of the roots of one branch the answer is the one whose {joint} is nearest to the reference"
            continue
        indicator = in_words(mechanism, branch.indicator)
        yield f'  branch("{branch.name}", {indicator}, {signs})'
        if branch.meanings[0]:
            first, second = branch.meanings
            yield f"       derived, to be named: 1 {branch.names[0]} where {first}, 2 {branch.names[1]} where {second}"


def _forward(mechanism: Mechanism) -> Iterator[str]:
    """The steps of the forward kinematics of a closed loop; a chain has none."""
    yield "Forward kinematics"
    if mechanism.chain is not None:
        yield "  the product of the chain"
    elif mechanism.is_platform:
        yield "  Newton's method from the home pose; the assembly mode is that of the home pose"
    else:
        derivation = solve_for_position(mechanism)
        for number, step in enumerate(derivation.steps, 1):
            yield from _step(mechanism, number, step, ())
        if mechanism.assembly is not None:
            way = mechanism.assembly
            yield f"  assembly {way.name}: {way.parameter} chooses the second mode"
            if way.meanings[0]:
                signs = ", ".join(f"{n}={s:+d}" for n, s in zip(way.names, way.signs, strict=True))
                indicator = in_words(mechanism, way.indicator)
                yield f'  assembly("{way.name}", {indicator}, margin="{way.margin}", {signs})'
                first, second = way.meanings
                yield f"       derived, to be named: {way.names[0]} where {first}; {way.names[1]} where {second}"


def _name(mechanism: Mechanism, unknown: sp.Symbol) -> str:
    return next((j.name for j in mechanism.joints if j.symbol == unknown), str(unknown))


def _plain(value: sp.Basic) -> str:
    text = str(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} …"


def _written(value: sp.Expr) -> str:
    text = f"{value} = 0"
    return text if len(text) <= _LONGEST else f"{len(sp.Add.make_args(value))} terms"
