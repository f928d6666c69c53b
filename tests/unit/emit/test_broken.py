"""Long statements on several lines: nothing is lost, no line is too wide, and the time follows the length."""

from time import process_time

import pytest

from derive.emit.c.printer import laid_out as in_c
from derive.emit.javascript.printer import laid_out as in_javascript
from derive.emit.st.layout import wrapped

LAID_OUT = {"C": lambda s: in_c([s]), "JavaScript": lambda s: in_javascript([s]), "Structured Text": wrapped}


def statement(terms: int) -> str:
    """A sum of products, and calls with lists."""
    return "wide = " + " + ".join(f"first_{i}*(second_{i} - f(third_{i}, 2.0*{i}.0))" for i in range(terms)) + ";"


@pytest.mark.parametrize("language", LAID_OUT)
def test_a_long_statement_takes_time_in_proportion(language: str) -> None:
    """With a scan of the whole rest for every line, these take minutes."""
    whole = statement(4000)
    start = process_time()
    lines = LAID_OUT[language](whole)
    assert process_time() - start < 8.0
    assert "".join(lines).replace(" ", "") == whole.replace(" ", "")
    assert max(map(len, lines)) <= 120 and len(lines) < len(whole) / 50


def test_where_a_statement_breaks() -> None:
    """Behind a comma before an operator, before an operator before a factor; behind `=` where nothing else fits."""
    assert wrapped("x := Clamp(first*second - third, fourth + fifth*sixth);", 34) == [
        "x := Clamp(first*second - third,", "    fourth + fifth*sixth);",
    ]  # fmt: skip
    assert wrapped("x := first + second*third*fourth;", 24) == ["x := first", "    + second*third", "    *fourth;"]
    assert in_c([f"const double x = {'a' * 100};"]) == ["const double x =", f"    {'a' * 100};"]
    assert in_c([f'say("a, b - {"c" * 90}", first, second, third);'])[0].endswith('",')
