"""Names on pages as one reads them, also of machines of a user's own."""

import re
from collections.abc import Iterator
from functools import cache
from xml.etree import ElementTree as ET

import pytest

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.drawing.pose import nominal_machine
from derive.emit.page.names import has_block, spelling_of
from derive.emit.page.page import page_of
from derive.emit.python.entries import module_name
from derive.ir.program import Solve, shared
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
from tests.page.reading import every, names_of, parsed, section
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
    """The inputs of the first block of a text."""
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
    """The names that programs of a page bind."""
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
