"""The flat profile: a block has all its methods, extends nothing, and answers what the block with a base answers."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from derive.description.mechanism import Mechanism
from derive.emit.plcopen.objects import Object, as_text, objects_of
from derive.emit.softmotion.library import flattened
from tests.codesys.parts import parts_of
from tests.codesys.plcopen_reader import NAMESPACE, wholes
from tests.codesys.plcopen_reader import parse as parse_xml
from tests.codesys.test_plcopen import errors
from tests.harness import ast
from tests.harness.blark_grammar import parse_with_blark
from tests.harness.contract import header
from tests.harness.library import Library, compile_st
from tests.harness.parse import parse
from tests.harness.pieces import split
from tests.harness.unused import unused
from tests.mechanisms import catalogue
from tests.text.comparisons import COMPARISONS
from tests.text.controller import OK, Controller
from tests.text.pairs import POSITION_KINEMATICS, pairs_of
from tests.text.test_portable import lint
from tests.text.test_profiles import BLOCK, rendered
from tests.text.units import FOLDER, compiled, file_of, shared_texts, text_of

BASE = "Softkin_Kinematics"


def objects_in(text: str) -> tuple[Object, ...]:
    """The objects of a file, without its preamble and its rulers."""
    lines = text.split("\n")
    start = next(at for at, line in enumerate(lines) if line.startswith("// ===="))
    bare = (re.sub(r"  // =+$", "", line) for line in lines[start:] if not line.startswith("// ===="))
    return objects_of("\n".join(bare))


@cache
def base() -> Object:
    (found,) = objects_in(shared_texts()[f"{BASE}.st"])
    return found


@cache
def flat_text(mechanism: Mechanism) -> str:
    """The unit as the flat profile writes it, without its preamble."""
    return flat_of(text_of(mechanism))


def flat_of(text: str) -> str:
    return as_text(flattened(objects_in(text), base()))


def flat_texts(mechanism: Mechanism) -> Mapping[str, str]:
    """The unit and the objects that all units share."""
    shared = {name: text for name, text in shared_texts().items() if name != f"{BASE}.st"}
    return {**shared, file_of(mechanism): flat_text(mechanism)}


@cache
def flat_library(mechanism: Mechanism) -> Library:
    return compile_st(flat_texts(mechanism))


pytestmark = pytest.mark.slow

MECHANISMS = {m.name: m for _, m in catalogue()}
KINDS = {
    "Kin_Scara4_ZCcoupled_Type1": "a serial arm with turns, drives with limits, and a coupled axis",
    "Softkin_Delta_C": "a loop of rods in space",
    "Kin_P2C_Type1": "a loop in a plane",
    "Kin_Hexapod": "a plate by Newton's method",
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": "an arm that is searched along",
    "Kin_Wrist2": "an orientation kinematics, for a coupling",
    "Kin_Scara2_Z": "a position kinematics, for a coupling",
    "Kin_Tool": "a kinematics without axes",
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_a_flat_block_is_whole_and_clean(name: str) -> None:
    """It extends nothing, has every method of the block and of its base with the identical text, and the inputs in the
    order that they had; and it is portable.
    """
    mechanism = MECHANISMS[name]
    text = flat_text(mechanism)
    (flat, *others), (before, *same) = (objects_in(t) for t in ("// ====\n" + text, text_of(mechanism)))
    assert others == same and BASE not in text
    assert flat.declaration.count("VAR_INPUT") == before.declaration.count("VAR_INPUT") == 1
    inputs = re.compile(r"^VAR_INPUT$.*?^END_VAR$", re.DOTALL | re.MULTILINE)
    assert inputs.search(flat.declaration)[0] == inputs.search(before.declaration)[0]  # type: ignore[index]
    members = {m.name: m for m in flat.members}
    own = {m.name: m for m in before.members}
    assert len(members) == len(flat.members)
    assert members == {m.name: m for m in base().members} | own
    assert lint(text) == []


@pytest.mark.parametrize("name", MECHANISMS)
def test_the_file_of_a_mechanism_has_the_flat_block(name: str) -> None:
    """What an import of one mechanism brings needs no base, and is this text."""
    mechanism = MECHANISMS[name]
    read = wholes(parse_xml(FOLDER / mechanism.family / f"{mechanism.block_name}.xml"))
    assert BASE not in read
    wanted = {(p.kind, p.path): p for p in parts_of(flat_text(mechanism))}
    wholly = (p for own in {path.split(".")[0] for _, path in wanted} for p in (read[own].own, *read[own].members))
    texts = {(p.kind, p.path): (p.declaration, p.implementation) for p in wholly if p.kind != "GET"}
    assert texts == {key: (p.declaration, p.implementation) for key, p in wanted.items() if p.kind != "GET"}


@pytest.mark.parametrize("name", KINDS)
def test_a_flat_block_compiles_alone(name: str) -> None:
    """Without a base it has all that its interfaces want, as the check of the contract says; nothing in it is unused
    but what the base keeps for other geometries; no local variable has the name of a member.
    """
    mechanism = MECHANISMS[name]
    library = flat_library(mechanism)
    block = library.objects[mechanism.block_name]
    inherited = compiled(mechanism).objects
    assert BASE not in library.objects and block.extends is None
    assert block.implements == inherited[mechanism.block_name].implements and block.implements[-1] == "ISoftkin"
    methods = {m.name: (m.access, header(m)) for m in block.methods}
    both = (*inherited[BASE].methods, *inherited[mechanism.block_name].methods)
    assert methods == {m.name: (m.access, header(m)) for m in both}
    kept = {f"{block.name}: {v.name}" for s in inherited[BASE].sections for v in s.variables}
    own = {m.name for m in inherited[mechanism.block_name].methods}
    others = [m for m in inherited[BASE].methods if m.access == "PROTECTED" and m.name not in own]
    kept |= {f"{block.name}.{m.name}: {v.name}" for m in others for s in m.sections for v in s.variables}
    assert set(unused(block)) <= kept


def test_names_of_locals_are_no_members() -> None:
    """In no flat block of the catalogue: the variables of a base's methods would hide them."""
    locals_of_the_base = set()
    (found,) = parse("\n".join(flat_source(base())), BASE)
    assert isinstance(found, ast.Block)
    for method in found.methods:
        locals_of_the_base |= {v.name.lower() for s in method.sections for v in s.variables}
    for mechanism in MECHANISMS.values():
        declared = re.findall(r"^  (\w+(?:, \w+)*) : ", objects_in(text_of(mechanism))[0].declaration, re.MULTILINE)
        members = {name.lower() for names in declared for name in names.split(", ")}
        assert not members & locals_of_the_base, mechanism.name


def flat_source(one: Any) -> Iterator[str]:
    """An object as a text."""
    yield one.declaration
    for member in one.members:
        yield from (member.declaration, member.implementation, "END_METHOD")
    yield "END_FUNCTION_BLOCK"


@pytest.mark.parametrize("name", [name for name in KINDS if MECHANISMS[name] in POSITION_KINEMATICS])
def test_every_method_answers_as_in_python(name: str) -> None:
    """Initialize among them, and what answers before it and after limits of drives."""
    mechanism = MECHANISMS[name]
    for pair in pairs_of(mechanism)[-3:]:
        controller = Controller(flat_library(mechanism), mechanism)
        assert controller.initialise(pair.robot.parameters) == OK
        flat = replace(pair, controller=controller)
        for sample in pair.regular[:3]:
            for method, compare in COMPARISONS.items():
                if method.lower() in controller.methods:
                    compare(flat, sample)


def test_the_second_grammar_reads_a_flat_block() -> None:
    """The block as it is written, without its members: these are those of the block with a base, and of the base."""
    (block, *_) = split(flat_text(MECHANISMS["Kin_Gantry2"]), "Softkin_Gantry2")
    assert block.text.startswith("FUNCTION_BLOCK Softkin_Gantry2 IMPLEMENTS") and len(block.members) > 20
    assert parse_with_blark(block.text, block.kind)


def test_the_profile_writes_these_texts() -> None:
    files = rendered("flat")
    assert set(rendered(None)) - set(files) == {f"softkin/{BASE}.st"}
    assert files[BLOCK].endswith(f"\n{flat_of(rendered(None)[BLOCK])}")
    assert not any(BASE in text for text in files.values())
    shared = {name: text for name, text in files.items() if name.startswith("softkin/") and name.endswith(".st")}
    assert shared == {name: rendered(None)[name] for name in shared}
    assert errors(files["softkin.xml"]) == []
    assert NAMESPACE in files["softkin.xml"]


def test_it_goes_together_with_an_older_library() -> None:
    """Both leave out what they leave out."""
    both, older = rendered("before_4_11+flat"), rendered("before_4_11")
    assert set(older) - set(both) == {f"softkin/{BASE}.st"} and "softkin/ISoftkin.st" not in both
    own = {n: t for n, t in both.items() if n.endswith(".st")}
    block = compile_st(own).objects["Kin_Scara4_ZCcoupled_Type1"]
    assert block.extends is None and not any("AxisSettings" in m.name for m in block.methods)


def test_a_call_of_the_base_is_refused() -> None:
    """A flat block has nothing to call where its method calls that of the base."""
    lines = "METHOD PUBLIC Run\nVAR\n  x : LREAL;\nEND_VAR\n\n{}\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
    above = objects_of("FUNCTION_BLOCK Above\nVAR\n  y : LREAL;\nEND_VAR\n\n" + lines.format("x := y;"))[0]
    head = "// It\nFUNCTION_BLOCK Below EXTENDS Above IMPLEMENTS\n  I1\nVAR_INPUT\n  z : LREAL;\nEND_VAR\n\n"
    with pytest.raises(ValueError, match=r"Below\.Run calls what the base has"):
        flattened(objects_of(head + lines.format("SUPER^.Run();")), above)
    (flat,) = flattened(objects_of(head + lines.format("x := 1.0;")), above)
    assert flat.declaration == (
        "// It\nFUNCTION_BLOCK Below IMPLEMENTS\n  I1\nVAR_INPUT\n  z : LREAL;\nEND_VAR\nVAR\n  y : LREAL;\nEND_VAR"
    )
    assert [m.implementation for m in flat.members] == ["x := 1.0;"]
