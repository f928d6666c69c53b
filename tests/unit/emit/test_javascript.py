"""Expressions and lines of JavaScript."""

import re

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.emit.javascript.printer import PRINTER, WIDTH, function_name, laid_out, spelled, text
from derive.ir.constants import DEGREE
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select
from derive.ir.symbols import count, flag, real

X, Y, K, B = real("x"), real("y"), count("turn_a1"), flag("single_a1")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (X - Y / 2, "x - 0.5*y"),
        (-(X**2) * Y, "-x*x*y"),
        (X / DEGREE, "x*RADIAN"),
        (Root(X), "squareRoot(x)"),
        (Root(X**2 + Y**2), "Math.sqrt(x*x + y*y)"),
        (Atan2(Y, X), "angleOf(y, x)"),
        (Select(B, X, Y), "(single_a1 ? x : y)"),
        (Select(sp.Not(B), X, Y), "(!single_a1 ? x : y)"),
        (NearestPeriod(X, Y), "nearestPeriod(x, y)"),
        (sp.And(sp.Gt(X, 0), sp.Or(B, sp.Lt(Y, 1))), "(x > 0) && (single_a1 || (y < 1))"),
        (sp.Ne(K, 0), "turn_a1 !== 0"),
        (sp.Abs(X) - sp.Float("1e-9"), "Math.abs(x) - 1e-9"),
        (real("class") * real("given"), "class_*given_"),
    ],
    ids=str,
)
def test_an_expression(value: sp.Basic, expected: str) -> None:
    """It is written as JavaScript has it: strict comparisons, one side of a choice, no word of the language."""
    assert PRINTER.print(value) == expected


def test_names() -> None:
    """No name of the derivation is that of a function, of the runtime, or a word of the language."""
    assert function_name("wrist_centre") == "findWristCentre"
    assert spelled("reach") == "reach" and spelled("await") == "await_" and spelled("k") == "k_"
    assert text('a "quoted" \\ text') == '"a \\"quoted\\" \\\\ text"'


WORDS = st.text("abcxyz_0", min_size=1, max_size=16)
PARTS = st.one_of(WORDS, WORDS.map(lambda w: f"f({w}, {w} + 1)"), WORDS.map(lambda w: text(f"{w}, {w} + {w} // {w}")))


@given(st.lists(PARTS, min_size=1, max_size=14), st.sampled_from([" + ", ", ", " && ", "*"]))
def test_a_long_line_is_broken_outside_of_texts(parts: list[str], between: str) -> None:
    """Each line fits, no text is broken, no line ends in `return`, and nothing is lost."""
    line = f"    return refuse({between.join(parts)});"
    found = laid_out([line])
    assert all(len(one) <= WIDTH for one in found)
    assert all(one.count('"') % 2 == 0 and one.strip() != "return" for one in found)
    assert re.sub(r"\s", "", "".join(found)) == re.sub(r"\s", "", line)
