"""Names of the library, and names with another meaning, which the generator refuses."""

import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from derive.command.line import main
from derive.description.catalogue import MECHANISMS
from derive.description.mechanism import DescriptionError
from derive.emit.language import TEMPLATES
from derive.emit.plcopen.objects import Object, objects_of
from derive.emit.st.contract import load
from derive.emit.st.names import TEMPLATE_LOCALS, parameter_name, spellings
from derive.emit.st.reserved import clash, refuse_clashes, reserved
from derive.ir.program import Status
from tests.harness import ast
from tests.harness.contract import INTERFACES
from tests.harness.faults import Place, StError
from tests.harness.library import Library, compile_st
from tests.harness.names import C_MACROS, KEYWORDS, check_name
from tests.text import values
from tests.text.contract.blocks import FILES, UNITS

SCARA = MECHANISMS / "kin_scara2_z.py"
REMEDY = "choose another name for the mechanism, parameter, joint or branch that it is made of"


def block(name: str, variable: str = "x") -> tuple[Object, ...]:
    return objects_of(
        f"FUNCTION_BLOCK {name}\nVAR_INPUT\n  {variable} : LREAL := 0.0;  // One\nEND_VAR\nEND_FUNCTION_BLOCK\n"
    )


IEC = """
CONFIGURATION RESOURCE NAMESPACE CLASS USING OVERLAP INTERVAL PRIORITY SINGLE NON_RETAIN REF_TO CHAR WCHAR EN ENO
LDATE_AND_TIME LTIME_OF_DAY FUNCTION_BLOCK END_PROGRAM VAR_TEMP TASK WITH
"""
DIALECTS = """
R S ADD SUB MUL DIV MOD GT GE EQ NE LE LT LD LDN ST STN CAL CALC CALCN RET RETC RETCN JMP JMPC JMPCN ANDN ORN XORN
AND_THEN OR_ELSE INDEXOF PARAMS ATAN2 CHAR_TO TO_CHAR WCHAR_TO TO_WCHAR CHAR_TO_INT TO_BOOL ANY_NUM ANY_REAL
"""


@pytest.mark.parametrize("name", [*IEC.split(), *DIALECTS.split(), *sorted(C_MACROS), *sorted(INTERFACES)])
def test_a_name_with_another_meaning_is_known(name: str) -> None:
    """The words of the standard, of dialects, of C and of the libraries are known, in whatever case."""
    assert clash(name) is not None and clash(name.lower()) is not None


@pytest.mark.parametrize("name", [*IEC.split(), *DIALECTS.split()])
def test_the_harness_refuses_it(name: str) -> None:
    """The harness refuses a declaration of every word of the list; grammars of their own refuse some before."""
    with pytest.raises(StError):
        check_name(name, Place("probe", 1))


def test_one_list_is_for_both() -> None:
    """The harness refuses what the compiler avoids."""
    assert {word.lower() for word in KEYWORDS | C_MACROS} == reserved()


def test_a_parameter_of_a_private_method_is_spelled_around_them() -> None:
    assert [parameter_name(n) for n in ("single", "r", "lowest_a1")] == ["singleValue", "rValue", "lowestA1"]


def test_temporaries_are_spelled_around_them() -> None:
    assert spellings(("nan", "step", "heading"), ()) == {"nan": "nanValue", "step": "stepValue", "heading": "heading"}
    assert {"nan", "step", "to", "dint"} <= reserved()


@pytest.mark.parametrize(
    ("objects", "message"),
    [
        (block("Mine", "dInt"), "a/b.st: Mine declares dInt, which is a word of IEC 61131-3"),
        (block("Mine", "EFAULT"), "Mine declares EFAULT, which is a macro of the C compilers"),
        (block("Mine", "trafo"), "Mine declares trafo, which is a name of the SoftMotion libraries"),
        (block("Kin_Coupled"), "Kin_Coupled declares Kin_Coupled, which is a name of the SoftMotion libraries"),
        (block("SMC_Robot"), "SMC_Robot declares SMC_Robot, which is a name of the SoftMotion libraries"),
        (block("Mine", "softkin_root"), "Mine declares softkin_root, which is an object of its own"),
    ],
)
def test_a_clash_is_one_sentence(objects: tuple[Object, ...], message: str) -> None:
    shared = objects_of("FUNCTION Softkin_Root : LREAL\nVAR\n  y : LREAL;\nEND_VAR\n\ny := 1.0;\nEND_FUNCTION\n")
    with pytest.raises(DescriptionError, match=re.escape(message)) as refusal:
        refuse_clashes({"a/b.st": objects, "softkin/Softkin_Root.st": shared})
    assert str(refusal.value).endswith(REMEDY) and "\n" not in str(refusal.value)


def test_a_name_in_a_method_is_seen_too() -> None:
    head = "FUNCTION_BLOCK Mine\nVAR\n  x : LREAL;\nEND_VAR\n\n"
    text = head + "METHOD PUBLIC Run\nVAR\n  nan : LREAL;\nEND_VAR\n\nnan := x;\n"
    with pytest.raises(DescriptionError, match=r"Mine\.Run declares nan, which is a macro"):
        refuse_clashes({"a/b.st": objects_of(text + "END_METHOD\nEND_FUNCTION_BLOCK\n")})


def test_two_objects_of_one_name() -> None:
    with pytest.raises(DescriptionError, match=r"b\.st: the name MINE is taken by a\.st"):
        refuse_clashes({"a.st": block("Mine"), "b.st": block("MINE")})


def generated(tmp_path: Path, capsys: pytest.CaptureFixture[str], **changes: str) -> str:
    """What `generate` says of a description in which words are replaced."""
    text = SCARA.read_text(encoding="utf-8")
    for old, new in changes.items():
        assert re.search(rf"\b{old}\b", text), old
        text = re.sub(rf"\b{old}\b", new, text)
    folder = tmp_path / "mechanisms"
    folder.mkdir()
    (folder / "mine.py").write_text(text, encoding="utf-8")
    assert main(["generate", "--output", str(tmp_path / "out"), "--mechanisms", str(folder)]) == 1
    assert not (tmp_path / "out").exists()
    return capsys.readouterr().err


@pytest.mark.slow
def test_a_mechanism_with_the_name_of_a_block_of_softmotion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = generated(tmp_path, capsys, CODESYS="SINSEGYE")
    wanted = "scara/Kin_Scara2_Z.st: Kin_Scara2_Z declares Kin_Scara2_Z, which is a name of the SoftMotion libraries"
    assert said == f"error: {wanted}: {REMEDY}\n"


def test_a_parameter_whose_input_is_a_keyword(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A length `int` would be the input dInt, and DINT is a type: it is called otherwise, and the command says so."""
    folder, out = tmp_path / "mechanisms", tmp_path / "out"
    folder.mkdir()
    text = re.sub(r"\barm_length_1\b", "int", SCARA.read_text(encoding="utf-8"))
    (folder / "mine.py").write_text(text, encoding="utf-8")
    assert main(["generate", "--output", str(out), "--mechanisms", str(folder)]) == 0
    told = "The parameter int is called dIntLength here, because dInt is a word of IEC 61131-3 or of a dialect of it."
    assert f"    note: Structured Text: {told}\n" in capsys.readouterr().out
    block = (out / "st" / "scara" / "Softkin_Scara2_Z.st").read_text(encoding="utf-8")
    assert "dIntLength : LREAL" in block and told in " ".join(block.split())
    assert " int: float," in (out / "python" / "softkin" / "scara2_z.py").read_text("utf-8")


def test_the_names_of_template_variables_are_declared_in_templates() -> None:
    """A name that no template of a method declares would only make other names longer."""
    texts = [path.read_text(encoding="utf-8") for path in (TEMPLATES / "st" / "methods").glob("*.st.j2")]
    declared = {name.lower() for text in texts for name in re.findall(r"^ +([A-Za-z]\w*) : ", text, re.MULTILINE)}
    assert declared >= TEMPLATE_LOCALS


LIST = "softkin/Softkin_Names.st"
CONSTANTS = {one.name: one for group in load().names for one in group.constants}
SCARA_TEXT, WRIST, TOOL = "scara/Softkin_Scara2_Z.st", "orientation/Softkin_Wrist3.st", "orientation/Softkin_Tool.st"
STRANGE = "SMC_MODULO_AXIS_PERIOD_NOT_360"
"""An error that no block returns."""


def changed(name: str, value: str) -> str:
    """The list in which one constant has another value of the same type."""
    one = CONSTANTS[name]
    line = f"  {name} : {one.type} := {one.value};"
    assert FILES[LIST].split("\n").count(line) == 1
    given = value if one.type == "BOOL" else f"{one.type}.{value}"
    return FILES[LIST].replace(line, f"  {name} : {one.type} := {given};")


@cache
def library(name: str, value: str, *units: str) -> Library:
    """Units and what they share, with one line of the list changed."""
    texts = {file: text for file, text in FILES.items() if file.startswith("softkin/") or file in units}
    return compile_st({**texts, LIST: changed(name, value)})


def test_the_list_is_the_contract() -> None:
    """The list declares every constant of the contract once; those that no document names say so."""
    (found,) = (d for d in compile_st({LIST: FILES[LIST]}).objects.values() if isinstance(d, ast.Globals))
    assert found.constant and found.pragmas == ("{attribute 'qualified_only'}",)
    assert [v.name for v in found.variables] == list(CONSTANTS)
    doubtful = {v.name for v in found.variables if "not documented" in v.comment}
    assert doubtful == {"NotInitialized", "BadInput", "LinearAxis", "ActiveWithoutTurn"}
    errors = {c.value.split(".")[-1] for c in load().names[0].constants}
    assert errors == {status.value for status in Status}


def test_every_constant_is_used() -> None:
    text = "\n".join(text for file, text in FILES.items() if file != LIST)
    assert set(re.findall(r"Softkin_Names\.(\w+)", text)) == set(CONSTANTS)


@pytest.mark.slow
def test_every_block_follows_a_changed_line() -> None:
    """Before Initialize every block answers with the error that the changed line names."""
    found = library("NotInitialized", STRANGE, *UNITS)
    frame = values.meaningless(found, values.FRAME_TYPE)
    for unit in UNITS:
        block = found.new(unit.split("/")[1].removesuffix(".st"))
        data, axes = found.new(values.BYTES_TYPE), found.new(values.AXES_TYPE)
        assert block.call("AxesToCartesian", f=frame, cd=data, a=axes) == STRANGE
        assert block.call("CartesianToAxes", a=axes, f=frame, aRef=axes, cd=data) == STRANGE


def ready(name: str, value: str, unit: str, **inputs: float) -> tuple[Library, Any]:
    """A block that is initialised, with one line of the list changed."""
    found = library(name, value, unit)
    block = found.new(unit.split("/")[1].removesuffix(".st"))
    for key, given in inputs.items():
        setattr(block, key, given)
    assert block.call("Initialize") == "SMC_NO_ERROR"
    return found, block


def inverse(found: Library, block: Any, x: float, y: float = 0.0) -> str:
    """What CartesianToAxes answers for a frame at a place."""
    frame = values.frame(found, (x, y, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    axes, data = found.new(values.AXES_TYPE), values.configuration(found, (1,))
    answer: str = block.call("CartesianToAxes", a=axes, f=frame, aRef=found.new(values.AXES_TYPE), cd=data)
    return answer


ARMS = {"dArmLength1": 300.0, "dArmLength2": 250.0}


@pytest.mark.parametrize(("name", "x"), [("Unreachable", 1000.0), ("BadInput", float("nan"))])
def test_an_error_is_the_one_of_the_list(name: str, x: float) -> None:
    assert inverse(*ready(name, STRANGE, SCARA_TEXT, **ARMS), x) == STRANGE


def test_success_is_the_one_of_the_list() -> None:
    """What functions of the libraries answer is compared with the list: where it names another success, Initialize
    refuses.
    """
    found = library("NoError", STRANGE, SCARA_TEXT)
    block = found.new("Softkin_Scara2_Z")
    assert block.call("Initialize") == "SMC_TRAFO_NOT_INITIALIZED"


@pytest.mark.parametrize(("name", "axis"), [("RotaryAxis", 0), ("LinearAxis", 2)])
def test_a_type_of_axis_is_the_one_of_the_list(name: str, axis: int) -> None:
    other = {"RotaryAxis": "Linear", "LinearAxis": "Rotary"}[name]
    found, block = ready(name, other, SCARA_TEXT, **ARMS)
    properties = found.new("TRAFO.Axis_Properties")
    block.call("GetAxisProperties", props=properties, udiAxis=axis)
    assert properties.eType == other


def test_a_freedom_is_the_one_of_the_list() -> None:
    found, block = ready("TurningOrientation", "three", SCARA_TEXT, **ARMS)
    image = found.new(values.IMAGE_TYPE)
    block.call("GetOrientationImage", oriInfo=image)
    assert image.dof == "three"


@pytest.mark.parametrize(
    ("name", "value", "unit", "wanted"),
    [
        ("MachineFrame", "Flange", WRIST, ("Flange", True)),
        ("FlangeFrame", "MCS", TOOL, ("MCS", False)),
        ("ActiveWithoutTurn", "TRUE", TOOL, ("Flange", True)),
    ],
)
def test_a_frame_is_the_one_of_the_list(name: str, value: str, unit: str, wanted: tuple[str, bool]) -> None:
    """The frame of an orientation image, and whether it is active, are what the list names."""
    found, block = ready(name, value, unit)
    identity = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    base = found.new(values.IMAGE_TYPE)
    found.set_rotation(base.mOriZero, identity)
    _, outputs = block.call_with_outputs(
        "GetOrientationImageWithOri",
        oriInfo=found.new(values.IMAGE_TYPE),
        csOriKin="MCS",
        bActive=False,
        mR_flange=values.matrix(found, identity),
        aRef=values.axes(found, ()),
        cd=values.configuration(found, ()),
        oriInfoBase=base,
    )
    assert (outputs["csOriKin"], outputs["bActive"]) == wanted
