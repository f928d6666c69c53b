"""Every name on a page is one of the block or of the class in Python, whatever a machine calls its inputs."""

import re
from collections.abc import Iterator
from functools import cache

import pytest

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.emit.page.names import has_block, spelling_of
from derive.emit.page.page import page_of
from derive.emit.python.entries import module_name
from derive.ir.program import FindRoot, Program, Solve, shared
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import languages
from tests.machines.collection import MACHINES
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
    shared_by_methods = [f"shared-{p.name}" for p in kinematics.shared if _is_written(p)]
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


def _is_written(program: Program) -> bool:
    """Whether the block has a method with its statements: a search for roots is written in the block by itself."""
    return not any(isinstance(s, FindRoot) for s in program.body)


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
