"""Names with another meaning are refused by the generator, with one sentence that says what to do."""

import re
from pathlib import Path

import pytest

from derive.command.line import main
from derive.description.catalogue import MECHANISMS
from derive.description.mechanism import DescriptionError
from derive.emit.language import TEMPLATES
from derive.emit.plcopen.objects import Object, objects_of
from derive.emit.st.names import TEMPLATE_LOCALS, parameter_name, spellings
from derive.emit.st.reserved import clash, refuse_clashes, reserved
from tests.harness.contract import INTERFACES
from tests.harness.faults import Place, StError
from tests.harness.names import C_MACROS, KEYWORDS, check_name

SCARA = MECHANISMS / "kin_scara2_z.py"
REMEDY = "choose another name for the mechanism, parameter, joint or branch that it is made of"


def block(name: str, variable: str = "x") -> tuple[Object, ...]:
    """A block of that name, with one input."""
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
    """A parameter of a private method with a reserved name gets another spelling."""
    assert [parameter_name(n) for n in ("single", "r", "lowest_a1")] == ["singleValue", "rValue", "lowestA1"]


def test_temporaries_are_spelled_around_them() -> None:
    """A temporary variable with a reserved name gets another spelling."""
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
    """A name with another meaning is refused with one sentence."""
    shared = objects_of("FUNCTION Softkin_Root : LREAL\nVAR\n  y : LREAL;\nEND_VAR\n\ny := 1.0;\nEND_FUNCTION\n")
    with pytest.raises(DescriptionError, match=re.escape(message)) as refusal:
        refuse_clashes({"a/b.st": objects, "softkin/Softkin_Root.st": shared})
    assert str(refusal.value).endswith(REMEDY) and "\n" not in str(refusal.value)


def test_a_name_in_a_method_is_seen_too() -> None:
    """A reserved name among the variables of a method is refused, too."""
    head = "FUNCTION_BLOCK Mine\nVAR\n  x : LREAL;\nEND_VAR\n\n"
    text = head + "METHOD PUBLIC Run\nVAR\n  nan : LREAL;\nEND_VAR\n\nnan := x;\n"
    with pytest.raises(DescriptionError, match=r"Mine\.Run declares nan, which is a macro"):
        refuse_clashes({"a/b.st": objects_of(text + "END_METHOD\nEND_FUNCTION_BLOCK\n")})


def test_two_objects_of_one_name() -> None:
    """Two objects whose names differ in case alone are refused."""
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
    """A mechanism with the name of a block of SoftMotion is refused, and nothing is written."""
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
