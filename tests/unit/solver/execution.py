"""Small problems for one rule, and the execution of its statements on numbers."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import sympy as sp
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from derive.algebra.normal_form import polynomial
from derive.equations.problem import Binding, Equation, Problem
from derive.ir.interpret import evaluate, run
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Statement, Status
from derive.ir.symbols import cosine, real, sine
from derive.solver.solve import Rule

Array = NDArray[np.float64]

SCALE = sp.Symbol("scale", positive=True)
ORDINALS = ("first", "second", "third", "fourth")

few = settings(max_examples=25)
"""Settings of Hypothesis for a property of many problems."""

ANGLES = st.floats(-4.0, 4.0)
"""Angles in radians, more than one turn."""
LENGTHS = st.floats(0.01, 1e3)
NUMBERS = st.floats(-1e3, 1e3).map(lambda x: x if abs(x) > 1e-100 else 0.0)
"""Numbers of either sign whose squares do not vanish."""
ANYTHING = st.one_of(st.floats(-1e9, 1e9), st.sampled_from([0.0, 1e-300, -1e-12, 1e-6, -1.0, 1e9, -1e9]))
"""Any input that a program must accept."""


def problem(
    *expressions: sp.Expr,
    angles: Sequence[sp.Symbol] = (),
    lengths: Sequence[sp.Symbol] = (),
    known: Sequence[sp.Symbol] = (),
    signs: Sequence[sp.Symbol] = (),
    positive: Iterable[sp.Expr] = (),
) -> Problem:
    """A problem from equations in sines and cosines of `angles` (unknown) and `known` (angles as well)."""
    units = (*angles, *known)
    equations = (Equation(n, polynomial(e, units, signs)) for n, e in zip(ORDINALS, expressions, strict=False))
    return Problem(
        angles=tuple(angles),
        lengths=tuple(lengths),
        equations=tuple(equations),
        units=units,
        references={a: reference(a) for a in (*units, *lengths)},
        scale=SCALE,
        signs=tuple(signs),
        positive=tuple(polynomial(e, units, signs) for e in positive),
    )


def reference(angle: sp.Symbol) -> sp.Symbol:
    """The value that an angle takes where nothing determines it."""
    return real(f"free_{angle.name}")


def answers(rule: Rule, given: Problem) -> list[Binding]:
    """All bindings that a rule finds in the equations of a problem."""
    return list(rule(given, given.equations))


def answer(rule: Rule, given: Problem) -> Binding:
    """The one binding that a rule finds in the equations of a problem."""
    (binding,) = answers(rule, given)
    return binding


def execute(
    statements: Iterable[Statement], values: Mapping[sp.Symbol, float | Array]
) -> tuple[dict[str, Array], Status]:
    """Every value that the statements bind, beside the given ones; and the status."""
    statements = tuple(statements)
    names = dict.fromkeys(s.name.name for s in statements if isinstance(s, Let))
    program = normalise("rule", statements, [Output(n, real(n)) for n in names])
    given = {s.name: np.asarray(v, dtype=float) for s, v in values.items()}
    outputs, status = run(program, given)
    return {**given, **outputs}, status.item()


def at(expression: sp.Expr, values: Mapping[str, Array]) -> float:
    """The value of an expression at numbers, symbols read by their names."""
    return float(evaluate(sp.sympify(expression).subs(sp.pi, 180 * sp.Symbol("DEGREE", positive=True)), values))


def trigonometry(**angles: float) -> dict[sp.Symbol, float]:
    """The sines and cosines of known angles, as the solver names them."""
    found: dict[sp.Symbol, float] = {}
    for name, value in angles.items():
        found |= {cosine(real(name)): float(np.cos(value)), sine(real(name)): float(np.sin(value))}
    return found


def distance(first: float, second: float) -> float:
    return float(abs(np.angle(np.exp(1j * (first - second)))))


def angle_of(values: Mapping[str, Array], angle: sp.Symbol) -> float:
    return float(np.arctan2(values[sine(angle).name], values[cosine(angle).name]))


def all_finite(values: Mapping[str, Array]) -> bool:
    return all(bool(np.all(np.isfinite(v))) for v in values.values())
