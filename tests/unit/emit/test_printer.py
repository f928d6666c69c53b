"""Printed expressions, long statements and whole programs: run, against the reference semantics; nothing is lost."""

import ast
from time import process_time

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from softkin import _array, _scalar
from softkin._types import Status as Code

from derive.command.catalogue import OUTPUT
from derive.emit.c.printer import laid_out as in_c
from derive.emit.javascript.printer import laid_out as in_javascript
from derive.emit.python.arrays import array_body
from derive.emit.python.layout import WIDTH, UnformattedError, assigned, formatted
from derive.emit.python.printer import ArrayPrinter, ScalarPrinter, literal, spelled
from derive.emit.python.program import Argument, Method, scalar_body
from derive.emit.st.layout import wrapped
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate, run
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, Wrap
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.symbols import real
from derive.pipeline import LANGUAGES, WRITTEN, derive_one, files_of, languages
from tests.mechanisms import named

NAMES = ("first", "second", "third")
LEAVES = st.sampled_from(
    [*map(real, NAMES), DEGREE, sp.Integer(2), sp.Integer(-3), sp.Rational(1, 3), sp.Float("1e-12")]
)


def _le(left: sp.Expr, right: sp.Expr) -> sp.Basic:
    return sp.Le(left, right, evaluate=False)


def _gt(left: sp.Expr, right: sp.Expr) -> sp.Basic:
    return sp.Gt(left, right, evaluate=False)


def _grown(parts: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    condition = st.builds(lambda a, b, c, d: sp.And(_le(a, b), sp.Or(_gt(c, d), _gt(a, d))), parts, parts, parts, parts)
    return st.one_of(
        st.builds(lambda a, b: a + b, parts, parts),
        st.builds(lambda a, b: a - b, parts, parts),
        st.builds(lambda a, b: a * b, parts, parts),
        st.builds(lambda a, b: a / Select(_gt(b, sp.Integer(1)), b, sp.Integer(1)), parts, parts),
        st.builds(lambda a: a**2, parts),
        st.builds(lambda f, a: f(a), st.sampled_from([sp.sin, sp.cos, sp.Abs, Root]), parts),
        st.builds(lambda f, a, b: f(a, b), st.sampled_from([Atan2, NearestPeriod]), parts, parts),
        st.builds(lambda c, a, b: Select(c, a, b), condition, parts, parts),
    )


EXPRESSIONS = st.recursive(LEAVES, _grown, max_leaves=12)
VALUES = st.fixed_dictionaries({name: st.sampled_from([0.0, 1.0, -1.0, 0.3, 2.5, -7.0, 200.0]) for name in NAMES})


def _namespace(module: object) -> dict[str, object]:
    return {**vars(module), "Status": Code}


@settings(deadline=None)
@given(expression=EXPRESSIONS, values=VALUES)
def test_expressions_mean_the_same_in_print(expression: sp.Expr, values: dict[str, float]) -> None:
    with np.errstate(all="ignore"):
        expected = float(evaluate(expression, {k: np.asarray(v) for k, v in values.items()}))
        scalar = eval(ScalarPrinter().print(expression), _namespace(_scalar), dict(values))
        arrays = {k: np.array([v]) for k, v in values.items()}
        array = eval(ArrayPrinter().print(expression), _namespace(_array), arrays)
    np.testing.assert_allclose(scalar, expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(array, expected, rtol=1e-9, atol=1e-9)


@given(value=st.floats(allow_nan=False, allow_infinity=False))
def test_literals_are_exact(value: float) -> None:
    assert float(literal(value)) == value
    assert not literal(value).lstrip("-").isdigit()


def test_names_of_python_are_avoided() -> None:
    assert [spelled(n) for n in ("lambda", "root", "axes", "link_length_1")] == [
        "lambda_",
        "root_",
        "axes_",
        "link_length_1",
    ]


@pytest.mark.long
@settings(deadline=None, max_examples=6)
@given(expressions=st.lists(EXPRESSIONS, min_size=20, max_size=40))
def test_laid_out_statements_mean_the_same(expressions: list[sp.Expr]) -> None:
    printers = (ScalarPrinter(), ArrayPrinter())
    lines = [f"        result = {printer.print(e)}" for printer in printers for e in expressions]
    text = "\n".join(["def f(first, second, third):", "    if first:", *lines])
    laid_out = formatted({"folder/a.py": text, "b.txt": text})
    assert laid_out["b.txt"] == text
    found = laid_out["folder/a.py"]
    assert found != text and ast.dump(ast.parse(found)) == ast.dump(ast.parse(text))
    assert all(len(line) <= WIDTH or len(line.split()) <= 3 for line in found.splitlines())


def test_what_is_no_python_is_not_laid_out() -> None:
    with pytest.raises(UnformattedError, match="wrong.py"):
        formatted({"right.py": "a = 1\n", "wrong.py": "a = (\n"})


@given(names=st.lists(st.from_regex("[a-z_]{1,40}", fullmatch=True), unique=True, max_size=20))
def test_values_are_assigned_in_lines_that_fit(names: list[str]) -> None:
    lines = assigned({name: f"k.{name}" for name in names})
    pairs = [pair for line in lines for pair in zip(*(side.split(", ") for side in line.split(" = ")), strict=True)]
    assert pairs == [(name, f"k.{name}") for name in names]
    assert all(8 + len(line) <= WIDTH for line in lines)
    assert len(lines) <= max(1, len(names))


X, Y = real("axis_x"), real("axis_y")
PROGRAM = Program(
    "demo",
    (X, Y, real("scale")),
    (
        Require(sp.Le(sp.Abs(X), 100), Status.BAD_INPUT, "finite"),
        Require(sp.Le(sp.Abs(Y), 100), Status.BAD_INPUT, "finite"),
        Let(real("size"), Root(X**2 + Y**2), "the distance from the origin"),
        Require(sp.Gt(real("size"), 1), Status.UNREACHABLE),
        Let(real("turned"), Select(sp.And(X > 0, Y > 0), Wrap(Atan2(Y, X)), -real("size")) * real("scale")),
    ),
    (Output("size", real("size")), Output("turned", real("turned"))),
)
METHOD = Method("demo", "", PROGRAM, (Argument("axes", "Reals", ("axis_x", "axis_y")),), "Reals", ("size", "turned"))


class _Machine:
    class constants:
        scale = 2.0

    _constants = constants


def _compiled(body: list[str], module: object) -> object:
    space = _namespace(module)
    exec("\n".join(["def demo(self, axes):", *(f"    {line}" for line in body)]), space)
    return space["demo"]


@settings(deadline=None)
@given(x=st.floats(allow_nan=True), y=st.floats(-150.0, 150.0))
def test_programs_mean_the_same_in_print(x: float, y: float) -> None:
    outputs, status = run(PROGRAM, {"axis_x": np.array([x]), "axis_y": np.array([y]), "scale": np.array([2.0])})
    scalar = _compiled(scalar_body(METHOD), _scalar)(_Machine(), (x, y))  # type: ignore[operator]
    with np.errstate(all="ignore"):
        on_arrays = _compiled(array_body(METHOD), _array)
        array, codes = on_arrays(_Machine(), (np.array([x]), np.array([y])))  # type: ignore[operator]
    expected = Code[status[0].name]
    assert codes[0] == expected
    if expected is not Code.OK:
        assert scalar is expected
        return
    np.testing.assert_allclose(scalar, [outputs["size"][0], outputs["turned"][0]], rtol=1e-12)
    np.testing.assert_allclose([a[0] for a in array], scalar, rtol=1e-12)


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


NAME = "Kin_Scara2_Z"


def test_what_is_written_is_what_is_committed() -> None:
    """Its files are those of `generated/`, byte for byte, and the languages that are not committed write it as well."""
    built = derive_one(named(NAME))
    assert built.measured and not built.undrawn
    files = files_of([built], languages(None, wanted=LANGUAGES))
    own = {path: data for path, data in files.items() if "scara2_z" in path.lower()}
    assert {path.split("/")[0] for path in own} == set(LANGUAGES)
    committed = [path for path in own if path.startswith(WRITTEN)]
    assert len(committed) >= 8
    for path in committed:
        assert own[path] == (OUTPUT / path).read_bytes(), path
