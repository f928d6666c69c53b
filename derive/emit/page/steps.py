"""The derivation on a page: its closure, the known values, its steps, and the tree of its branches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Branch, Mechanism
from derive.emit.page.lines import Line, Lines
from derive.emit.page.mathml import Row, element, operator, word
from derive.equations.problem import Equation
from derive.geometry.frames import LETTERS, Factor, Motion
from derive.ir.program import Let, Statement
from derive.ir.symbols import names_in
from derive.kinematics.branches.assignment import Assignment
from derive.kinematics.kinematics import Kinematics
from derive.report.branch_meanings import meanings_of_crossing
from derive.report.derived import FORMS, Derived, ExplainedStep, Route


@dataclass(frozen=True)
class Stated:
    """An equation with its label, one element a line."""

    label: str
    math: tuple[str, ...]


@dataclass(frozen=True)
class ShownStep:
    """One step of the derivation on the page."""

    number: int
    unknowns: str
    rule: str
    form: str
    used: tuple[Stated, ...]
    lines: tuple[Line, ...]
    determinant: tuple[str, ...]
    """The determinant, over its scale, one element a line; none of a step with one root."""
    branches: tuple[str, ...]
    only: str
    """The sign of the determinant, where the machine has one of the two solutions alone; else empty."""
    free: str
    """The unknown that is free where a value vanishes; empty if there is none."""
    free_where: tuple[str, ...]
    """The equation that says that this value is zero."""
    refused: tuple[tuple[str, ...], ...]
    """The conditions that Initialize tests."""


@dataclass(frozen=True)
class ShownRoute:
    """One solved problem on the page."""

    title: str
    equations: tuple[Stated, ...]
    """Those that no step takes as they are: the others stand at their steps."""
    known: tuple[Line, ...]
    steps: tuple[ShownStep, ...]
    held: str
    residuals: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Leaf:
    """A node of the tree of branches: a byte, and the nodes below."""

    text: str
    below: tuple[Leaf, ...] = ()


@dataclass(frozen=True)
class Sign:
    """A branch and its meaning: in words, or as the condition for its first name."""

    name: str
    names: tuple[str, str]
    words: str
    math: tuple[str, ...]


_DEEPEST = 3
"""Up to this number of branches are shown as a tree."""


def route_of(route: Route, mechanism: Mechanism, lines: Lines) -> ShownRoute:
    """A solved problem on the page."""
    used = {e.expression for step in route.steps for e in step.equations}
    return ShownRoute(
        title=route.title,
        equations=tuple(_stated(e, lines) for e in route.equations if e.expression not in used),
        known=tuple(lines.of(_needed(route))),
        steps=tuple(_step(step, mechanism, lines) for step in route.steps),
        held=", ".join(j.name for j in route.frozen),
        residuals=tuple(lines.math.equation(r, sp.Integer(0)) for r in route.residuals),
    )


def _needed(route: Route) -> list[Statement]:
    """The statements whose values are bound before the first step and read in it or later."""
    wanted = {s for e in route.equations for s in names_in(e.expression)}
    for step in route.steps:
        wanted |= {s for e in step.equations for s in names_in(e.expression)}
        wanted |= {s for statement in step.statements for s in statement.reads()}
    kept: list[Statement] = []
    for statement in reversed(route.known):
        if not isinstance(statement, Let) or statement.name in wanted:
            kept.insert(0, statement)
            wanted |= statement.reads()
    return kept


def _stated(equation: Equation, lines: Lines) -> Stated:
    return Stated(equation.label, lines.math.equation(equation.expression, sp.Integer(0)))


def _step(step: ExplainedStep, mechanism: Mechanism, lines: Lines) -> ShownStep:
    used = tuple(_stated(e, lines) for e in step.equations)
    if step.total is not None:
        terms = sp.Add(*(sign * angle for angle, sign in step.total.terms))
        used = (Stated("sum of parallel angles", lines.math.equation(step.total.symbol, terms)),)
    made, partial = step.determinant, step.conditioning
    return ShownStep(
        number=step.number,
        unknowns=", ".join(_axis(mechanism, u) for u in step.unknowns) or "no unknown",
        rule=step.rule,
        form=FORMS.get(step.rule, step.rule),
        used=used,
        lines=tuple(lines.of(step.statements)),
        determinant=() if made is None else lines.math.lines(_over(made.value, made.scale)),
        branches=tuple(_of_branch(a) for a in step.assignments),
        only={0: "", 1: "positive", -1: "negative"}[step.only],
        free="" if partial is None else _axis(mechanism, partial.angle),
        free_where=() if partial is None else lines.math.equation(partial.value, sp.Integer(0)),
        refused=tuple(lines.math.equation(c, sp.Integer(0)) for c in step.conditions),
    )


def _over(value: sp.Expr, scale: sp.Expr) -> sp.Expr:
    return value if scale == 1 else sp.Mul(value, sp.Pow(scale, -1, evaluate=False), evaluate=False)


def _of_branch(found: Assignment) -> str:
    first, second = found.branch.names
    sign = "positive" if found.orientation > 0 else "negative"
    return f"branch {found.branch.name}: byte 1 is {first}, where the determinant is {sign}; byte 2 is {second}"


def _axis(mechanism: Mechanism, unknown: sp.Symbol) -> str:
    return next((j.name for j in mechanism.joints if j.symbol == unknown), str(unknown))


def signs_of(kinematics: Kinematics, lines: Lines) -> Iterator[Sign]:
    """Every branch with its meaning: in words where the derivation named it, else the sign of its indicator."""
    for branch in kinematics.mechanism.branches:
        (first, second), (one, other) = branch.names, branch.meanings
        if branch.is_crossing:
            one, other = meanings_of_crossing(kinematics.mechanism, branch)
        words = f"In {first} {one}; in {second} {other}." if one else ""
        condition = () if words else lines.math.lines(sp.Rel(branch.indicator, 0, ">" if branch.signs[0] > 0 else "<"))
        yield Sign(branch.name, branch.names, words, condition)


def tree_of(derived: Derived) -> tuple[Leaf, ...]:
    """The tree of branches, in the order in which the steps choose; of many branches none."""
    assignments = [a for route in derived.inverse for a in route.assignments]
    order = list(dict.fromkeys(a.branch.name for a in assignments))
    known = {b.name: (k, b) for k, b in enumerate(derived.mechanism.branches)}
    names = [n for n in order if n in known] + [n for n in known if n not in order]
    return tuple(_below(names, known)) if len(names) <= _DEEPEST else ()


def _below(names: Sequence[str], known: Mapping[str, tuple[int, Branch]]) -> Iterator[Leaf]:
    if not names:
        return
    place, branch = known[names[0]]
    for byte in (0, 1):
        text = f"byte {place} = {byte + 1}: {names[0]} {branch.names[byte]}"
        yield Leaf(text, tuple(_below(names[1:], known)))


def product_of(factors: Sequence[Factor], lines: Lines) -> tuple[str, ...]:
    """The product of a chain as the description writes it, a line for every few factors."""
    rows: list[Row] = [_factor(f, lines) for f in factors]
    found: list[str] = []
    line: Row = ()
    for row in rows:
        piece = (operator("⋅"), *row) if line or found else row
        if line and sum(t.width for t in (*line, *piece)) > 90:
            found.append(element(line))
            line = ()
        line = (*line, *piece)
    return (*found, element(line)) if line else tuple(found)


def _factor(factor: Factor, lines: Lines) -> Row:
    head = word("F" if factor.motion is Motion.FLIP else LETTERS[factor.motion])
    named = f"<msub>{head.text}<mi>{'xyz'[factor.axis]}</mi></msub>"
    inside = lines.math.row(factor.amount)
    opening, closing = (f'<mo stretchy="false">{sign}</mo>' for sign in "()")
    text = named + opening + "".join(t.text for t in inside) + closing
    return (type(head)(text, 4 + sum(t.width for t in inside)),)
