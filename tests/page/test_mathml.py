"""Formulas: what is printed as MathML, and read again as a person reads it, has the value of the expression."""

from xml.etree import ElementTree as ET

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.emit.page.mathml import WIDTH, MathML, broken
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, Wrap
from derive.ir.symbols import real
from tests.page.reading import value_of

NAMES = ("link_length_1", "cos_a2", "sin_a2", "x", "a_long_name_of_a_distance_that_fills_lines")
SYMBOLS = tuple(map(real, NAMES))
VALUES = {name: np.asarray(value) for name, value in zip(NAMES, (1.7, 0.6, -0.8, 2.3, -3.1), strict=True)}
_XHTML = 'xmlns="http://www.w3.org/1999/xhtml"'

leaves = st.one_of(
    st.sampled_from(SYMBOLS),
    st.sampled_from([sp.Integer(2), sp.Integer(-3), sp.Rational(1, 2), sp.Rational(-3, 7), sp.Float("1e-11"), DEGREE]),
)


def _chosen(parts: tuple[sp.Expr, sp.Expr, sp.Expr]) -> sp.Expr:
    one, two, three = parts
    return Select(sp.And(sp.Gt(one, 0), sp.Le(two, 1)), two, three)


def _grown(inner: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    two = st.tuples(inner, inner)
    return st.one_of(
        st.lists(inner, min_size=2, max_size=5).map(lambda terms: sp.Add(*terms)),
        st.lists(inner, min_size=2, max_size=4).map(lambda terms: sp.Mul(*terms)),
        two.map(lambda ab: ab[0] - ab[1]),
        two.map(lambda ab: ab[0] / (1 + ab[1] ** 2)),
        inner.map(lambda a: a**2),
        inner.map(lambda a: -a),
        inner.map(sp.Abs),
        inner.map(sp.sin),
        inner.map(lambda a: Root(1 + a**2)),
        two.map(lambda ab: Atan2(*ab)),
        two.map(lambda ab: NearestPeriod(*ab)),
        inner.map(Wrap),
        st.tuples(inner, inner, inner).map(lambda abc: NearestOnArc(abc[0], abc[1], 1 + abc[2] ** 2)),
        st.tuples(inner, inner, inner).map(_chosen),
    )


def _is_real(expression: sp.Expr) -> bool:
    """Whether SymPy sees that it is real: of an angle between two numbers it does not, and takes its imaginary part."""
    return not expression.has(sp.im, sp.re, sp.conjugate, sp.arg, sp.I)


expressions = st.recursive(leaves, _grown, max_leaves=10).filter(_is_real)


def _read(lines: tuple[str, ...]) -> np.ndarray:
    page = ET.fromstring(f"<div {_XHTML}>{''.join(lines)}</div>")
    return value_of(list(page), VALUES)


@pytest.mark.slow
@settings(max_examples=200)
@given(expressions, st.sampled_from([30, 60, WIDTH]))
def test_what_is_printed_is_what_is_meant(expression: sp.Expr, width: int) -> None:
    """On one line and on many: signs, fractions, powers, roots and parentheses."""
    expected = float(evaluate(expression, VALUES))
    if not np.isfinite(expected):
        return
    shown = float(_read(MathML(str).lines(expression, width)))
    assert abs(shown - expected) <= 1e-9 * max(1.0, abs(expected)), expression


def test_no_line_is_wide() -> None:
    """A long sum breaks at its signs, and a product only where there is nothing better."""
    terms = [a * b * c for a in SYMBOLS for b in SYMBOLS for c in SYMBOLS]
    row = MathML(str).row(sp.Add(*terms))
    lines = list(broken(row, 60))
    assert len(lines) > 10 and sum(lines, ()) == row
    begins = [line[0].text for line in lines[1:]]
    assert all(text in ("<mo>+</mo>", "<mo>−</mo>", "<mo>⋅</mo>") for text in begins)
    short = MathML(str).row(sp.Add(*(a * b for a in SYMBOLS[:4] for b in SYMBOLS[:4])))
    assert all(line[0].text == "<mo>+</mo>" for line in list(broken(short, 60))[1:])
    longest = max(max(t.width for t in line) for line in lines)
    assert all(sum(t.width for t in line) <= 60 + longest for line in lines)
