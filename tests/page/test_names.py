"""Names on pages as one reads them, also of machines of a user's own, and the formulas of MathML."""

import re
from collections.abc import Iterator
from functools import cache
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.drawing.pose import nominal_machine
from derive.emit.page.mathml import WIDTH, MathML, broken
from derive.emit.page.names import has_block, spelling_of
from derive.emit.page.page import page_of
from derive.emit.python.entries import module_name
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, Wrap
from derive.ir.program import Solve, shared
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import languages
from derive.report.derived import derived_of
from derive.report.singular_poses import SINGULAR, singular_pose
from tests.machines.collection import MACHINES
from tests.machines.guided import GUIDED
from tests.machines.odd_names import ODD
from tests.mechanisms import kinematics_of, named
from tests.page.made import NAMES, page
from tests.page.reading import every, names_of, parsed, section, value_of
from tests.text.units import text_of

PYTHON = OUTPUT / "python" / "softkin"
PICTURED = ("Kin_Scara4_ZCcoupled_Type1", "Kin_P2C_Type1")
_INPUT = re.compile(r"\b[dxi][A-Z]\w*")
_COLUMNS = 8


def _machine(name: str) -> Mechanism:
    if name in NAMES:
        return named(name)
    return validate(ODD[name].mechanism()) if name in ODD else MACHINES[name]


@cache
def _texts(name: str) -> tuple[str, str, str]:
    """The page, the block and the module in Python."""
    mechanism = _machine(name)
    kinematics = kinematics_of(mechanism)
    has_pictures = name in (*PICTURED, *ODD)
    text = page_of(mechanism, kinematics).text if has_pictures or name not in NAMES else page(name).text
    if name in NAMES:
        return text, text_of(mechanism), (PYTHON / f"{module_name(name)}.py").read_text(encoding="utf-8")
    python, st = (languages(wanted=(one,))[0].part(kinematics) for one in ("python", "st"))
    assert python is not None
    return text, (st or {"text": ""})["text"], "\n".join(python["files"].values())


def _rows(text: str) -> list[list[str]]:
    rows = ([str("".join(cell.itertext())) for cell in row] for row in every(section(parsed(text), "machine"), "tr"))
    return [row for row in rows if len(row) == _COLUMNS and row[0] != "Parameter"]


def _declared(block: str) -> list[str]:
    inputs = re.search(r"^ *VAR_INPUT\b(.*?)^ *END_VAR", block, re.MULTILINE | re.DOTALL)
    return re.findall(r"^ *(\w+) : (?:LREAL|BOOL|INT)\b", inputs[1], re.MULTILINE) if inputs else []


@pytest.mark.broad
@pytest.mark.slow(" ")  # machines that are in no catalogue
@pytest.mark.parametrize("name", (*NAMES, *ODD, "arm on a track"))
def test_every_name_is_one_of_the_block(name: str) -> None:
    """Those of inputs, which are keywords in Python as well; those that programs bind, and what they are there."""
    _confirm_inputs(name)
    if has_block(kinematics_of(_machine(name))):
        _confirm_programs(name)


def _confirm_inputs(name: str) -> None:
    text, block, module = _texts(name)
    rows, kinematics = _rows(text), kinematics_of(_machine(name))
    declared = _declared(block)
    assert [row[7] for row in rows] == (declared if has_block(kinematics) else ["–"] * len(rows))
    assert len(rows) == len(kinematics.parameters)
    words = set(re.findall(r"\w+", block))
    assert not block or set(_INPUT.findall(re.sub(r"<[^>]*>", " ", text))) <= words
    keywords = re.search(r"def __init__\(\s*self,\s*\*,(.*?)\) -> None", module, re.DOTALL)
    assert keywords is not None or not rows
    assert keywords is None or [row[6] for row in rows] == re.findall(r"(\w+): (?:float|bool|int)", keywords[1])


def _confirm_programs(name: str) -> None:
    text, block, _ = _texts(name)
    kinematics = kinematics_of(_machine(name))
    words, spell = set(re.findall(r"\w+", block)), spelling_of(kinematics)
    known = {spell(n) for n in (*(o.name for o in kinematics.setup.outputs), *_of_loops(kinematics))}
    # A value that is a result itself has the name of the result in the block: `v.dZ := a.a2 - axes[2].offset`.
    results = (*kinematics.forward.outputs, *kinematics.singularity.outputs)
    known |= {spell(n) for o in results for n in (o.name, str(o.value)) if n.isidentifier()}
    shared_by_methods = [f"shared-{p.name}" for p in kinematics.shared]
    bound = set(_bound(text, ("inverse-program", "forward-program", "singularities", "jacobian", *shared_by_methods)))
    own = {one for one in bound - known if not re.fullmatch(r"J\d+", one)}
    assert own <= words | {one for one, _ in spell.places}
    assert own or not kinematics.margins
    read = {re.findall(r"\w+", place)[0] for _, place in spell.places}
    if all(o.value == 0 for o in kinematics.bias.outputs):
        read -= {"aSpeeds"}  # slides alone: the block reads no speeds
    assert read <= words or not kinematics.mechanism.joints


def _bound(text: str, anchors: tuple[str, ...]) -> Iterator[str]:
    tree = parsed(text)
    headings = {e.get("id") for e in tree.iter()}
    for anchor in anchors:
        if anchor in headings:
            yield from names_of(li for program in every(section(tree, anchor), "ol", "program") for li in program)


def _of_loops(kinematics: Kinematics) -> Iterator[str]:
    """The unknowns of linear equations: the block keeps them in an array."""
    for program in (*kinematics.programs, *shared(kinematics.programs)):
        for statement in program.body:
            yield from (n.name for n in statement.names) if isinstance(statement, Solve) else ()


@pytest.mark.slow
def test_an_awkward_name_is_among_them() -> None:
    """A length that is called like a limit has another name in each language: else nothing above would be asked."""
    for name, odd in ODD.items():
        shown = {cell for row in _rows(_texts(name)[0]) for cell in row[6:]}
        assert shown >= {*odd.python.values(), *odd.text.values()}


OWN = {name: MACHINES[name] for name in ("rail and arm with two links", "arm with four axes", "arm on a track")}
OWN |= {name: MACHINES[name] for name in ("SCARA that bends to the left alone",)}
OWN |= {name: GUIDED[name] for name in ("Z3 head with slides",)}


@cache
def _kinematics(name: str) -> Kinematics:
    return build(OWN[name])


@cache
def _text(name: str) -> str:
    return page_of(OWN[name], _kinematics(name), has_pictures=False).text


def _words(elements: list[ET.Element]) -> str:
    return " ".join("".join(e.itertext()) for e in elements)


@pytest.mark.slow
@pytest.mark.parametrize("name", OWN)
def test_the_page_is_whole(name: str) -> None:
    """Every step, every margin, every axis by its name."""
    page, kinematics = parsed(_text(name)), _kinematics(name)
    derived = derived_of(_kinematics(name).solution)
    shown = [s.get("id") for s in every(section(page, "derivation"), "section", "step")]
    steps = [route.steps for route in (*derived.inverse, *([derived.forward] if derived.forward else []))]
    assert len(shown) == sum(map(len, steps)) > 1
    told = [s.get("id") for s in every(section(page, "singularities"), "section")]
    assert told == [f"margin-{m.name}" for m in kinematics.margins]
    rows = ["".join(next(iter(row)).itertext()) for row in every(section(page, "machine"), "tr")]
    assert {j.name for j in kinematics.mechanism.joints} <= set(rows)


@pytest.mark.slow
def test_a_machine_without_a_block() -> None:
    """Seven axes: no name of a block is told, and the programs are those of Python."""
    text = _text("arm on a track")
    assert "SolveBranch" not in text and "As the Python package computes them" in text
    assert not spelling_of(_kinematics("arm on a track")).places


@pytest.mark.slow
def test_what_is_special_is_told() -> None:
    """Held axes, the one of two solutions, and what the task does not command."""
    held = _words(section(parsed(_text("rail and arm with two links")), "derivation"))
    assert "held, where the reference has them" in held
    alone = _words(section(parsed(_text("SCARA that bends to the left alone")), "derivation"))
    assert "This machine has one of the two alone: the determinant is negative" in alone
    guided = _words(section(parsed(_text("Z3 head with slides")), "derivation"))
    assert "What the task does not command: x, y, twist" in guided and "guide" in guided


@pytest.mark.slow
def test_a_singular_pose_of_ones_own() -> None:
    """The elbow of a SCARA that is in no catalogue."""
    name = "SCARA that bends to the left alone"
    machine = nominal_machine(_kinematics(name))
    (margin,) = machine.kinematics.margins
    found = singular_pose(
        machine, derived_of(_kinematics(name).solution), margin.name, tuple(j.nominal for j in OWN[name].joints)
    )
    assert found is not None and found.value <= SINGULAR
    assert min(abs(found.axes[1] % 360.0 - straight) for straight in (0.0, 180.0, 360.0)) < 1e-3


IDENTIFIERS = ("link_length_1", "cos_a2", "sin_a2", "x", "a_long_name_of_a_distance_that_fills_lines")
SYMBOLS = tuple(map(real, IDENTIFIERS))
VALUES = {name: np.asarray(value) for name, value in zip(IDENTIFIERS, (1.7, 0.6, -0.8, 2.3, -3.1), strict=True)}
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
