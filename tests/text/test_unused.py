"""The text as objects: nothing is declared that is not used, and a broken text is noticed."""

import math
import re

import pytest

from derive.emit.plcopen.declaration import declaration_of
from derive.emit.plcopen.objects import Object, as_text, objects_of
from tests.harness import ast
from tests.harness.library import Library, StError, StFault, compile_st
from tests.harness.parse import parse
from tests.harness.unused import unused
from tests.text.breakage import FAULTS, MECHANISM, REFUSED, WRONG, texts
from tests.text.comparisons import COMPARISONS
from tests.text.contract.blocks import FILES
from tests.text.controller import OK, Controller
from tests.text.pairs import Pair, pairs_of


@pytest.mark.parametrize("file", FILES)
def test_everything_declared_is_used(file: str) -> None:
    assert [one for declared in parse(FILES[file], file) for one in unused(declared)] == []


@pytest.mark.parametrize("name", ["Softkin_Kinematics", "Softkin_SelfTest"])
def test_what_the_base_declares_is_read_by_a_block(name: str) -> None:
    texts = [text for text in FILES.values() if f"EXTENDS {name}" in text]
    (base,) = parse(FILES[f"softkin/{name}.st"], name)
    assert isinstance(base, ast.Block)
    names = [v.name for section in base.sections for v in section.variables]
    own = FILES[f"softkin/{name}.st"].split("END_VAR", len(base.sections))[-1]
    assert names and texts
    assert [name for name in names if not any(re.search(rf"\b{name}\b", text) for text in (own, *texts))] == []


_BLOCK = """\
FUNCTION_BLOCK Kin
VAR_INPUT
  dLength : LREAL;
END_VAR
VAR CONSTANT
  HALF : LREAL := 0.5;
  COUNT : INT := 2;
END_VAR
VAR
  kept : LREAL;
END_VAR

METHOD PRIVATE Solve : LREAL
VAR_IN_OUT CONSTANT
  a : LREAL;
END_VAR
VAR_INPUT
  iTurn : INT;
END_VAR
VAR_OUTPUT
  dMissing : LREAL;
END_VAR
VAR
  row : INT;
  list : ARRAY[1..2] OF LREAL;
END_VAR

FOR row := 1 TO COUNT DO
  list[row] := a*HALF;
END_FOR
dMissing := list[iTurn] + kept;
Solve := 1.0;
END_METHOD

METHOD PUBLIC Initialize : LREAL
kept := dLength;
Initialize := kept;
END_METHOD
END_FUNCTION_BLOCK
"""
PLANTED = {
    "an input": ("kept := dLength;", "kept := 1.0;", "Kin: dLength"),
    "a constant": ("a*HALF", "a", "Kin: HALF"),
    "an instance variable that is only written": ("list[iTurn] + kept", "list[iTurn]", "Kin: kept"),
    "a parameter": ("list[row] := a*HALF", "list[row] := HALF", "Kin.Solve: a"),
    "an input of a private method": ("list[iTurn]", "list[1]", "Kin.Solve: iTurn"),
    "an output": ("dMissing := list[iTurn] + kept;", "Solve := list[iTurn] + kept;", "Kin.Solve: dMissing"),
    "a variable": ("  row : INT;\n", "  row : INT;\n  column : INT;\n", "Kin.Solve: column"),
    "a variable that is only written": ("list[iTurn] + kept", "kept + iTurn", "Kin.Solve: list"),
}


@pytest.mark.parametrize("case", PLANTED)
def test_the_lint_sees(case: str) -> None:
    old, new, wanted = PLANTED[case]
    text = _BLOCK if case != "an instance variable that is only written" else _BLOCK.replace("e := kept", "e := 1.0")
    assert old in text
    (clean,), (spoiled,) = parse(_BLOCK, "Kin.st"), parse(text.replace(old, new), "Kin.st")
    assert list(unused(clean)) == []
    assert wanted in list(unused(spoiled))


TEXT = "FUNCTION_BLOCK Block\n\nMETHOD PUBLIC Nothing\nEND_METHOD\nEND_FUNCTION_BLOCK\n"


def test_an_object_without_an_end_is_refused() -> None:
    with pytest.raises(ValueError, match="'METHOD PUBLIC Nothing' has no END_METHOD"):
        objects_of(TEXT.replace("METHOD PUBLIC Nothing\nEND_METHOD", "METHOD PUBLIC Nothing"))


def test_text_in_no_object_is_refused() -> None:
    with pytest.raises(ValueError, match="'x : INT;' stands in no object"):
        objects_of(f"{TEXT}\nx : INT;\n")


def test_a_list_of_global_constants_has_the_name_that_it_is_given() -> None:
    """A list is a declaration alone, with its comment and its pragma; its text does not name it."""
    text = "// Names\n{attribute 'qualified_only'}\nVAR_GLOBAL CONSTANT\n  ONE : INT := 1;\nEND_VAR"
    (found,) = objects_of(f"{text}\n", "Names")
    assert found == Object("VAR_GLOBAL", "Names", text, "")
    assert as_text([found]).count("// ====") == 2 and "END_VAR_GLOBAL" not in as_text([found])
    declared = declaration_of(found.declaration)
    assert declared.attributes == (("qualified_only", ""),) and list(declared.names()) == ["ONE"]
    with pytest.raises(ValueError, match="'VAR_GLOBAL CONSTANT' stands in no object that has a name"):
        objects_of(text)


def test_an_interface_has_declarations_alone() -> None:
    """Its methods have no implementation, and no ruler for one; what it extends is read from its head."""
    head = "// What\nINTERFACE IAsk EXTENDS __SYSTEM.IQueryInterface"
    run = "METHOD Run : BOOL\nVAR_INPUT\n  x : INT;\nEND_VAR\nEND_METHOD"
    (found,) = objects_of(f"{head}\n\n{run}\n\nMETHOD Stop\nEND_METHOD\nEND_INTERFACE\n")
    assert (found.kind, found.name, found.implementation) == ("INTERFACE", "IAsk", "")
    assert declaration_of(found.declaration).extends == "__SYSTEM.IQueryInterface"
    first, stop = found.members
    assert first == Object("METHOD", "Run", "METHOD Run : BOOL\nVAR_INPUT\n  x : INT;\nEND_VAR", "")
    assert declaration_of(first.declaration).returns == "BOOL" and stop.declaration == "METHOD Stop"
    titles = [line.strip("/= ") for line in as_text([found]).split("\n") if line.startswith("// ====")]
    assert [one for one in titles if one] == [
        "INTERFACE IAsk: declaration",
        "METHOD IAsk.Run: declaration",
        "METHOD IAsk.Stop: declaration",
    ]
    assert as_text([found]).endswith("\nEND_INTERFACE\n")


def test_declarations_that_no_block_has_yet() -> None:
    """A base block, a structure, numbered enumerators, and an initial value of several lines."""
    derived = declaration_of(
        "FUNCTION_BLOCK Robot EXTENDS SPACE.Base IMPLEMENTS\n  SPACE.One\nVAR\n  x : INT;\nEND_VAR"
    )
    assert (derived.extends, derived.interfaces) == ("SPACE.Base", ("SPACE.One",))
    assert declaration_of("FUNCTION_BLOCK Robot EXTENDS Base\nVAR\nEND_VAR").extends == "Base"
    pair = declaration_of(
        "{attribute 'a'}\nTYPE Pair :\nSTRUCT\n  x : LREAL;  // One\n  y : LREAL := 1.0;\nEND_STRUCT\nEND_TYPE"
    )
    assert (list(pair.names()), pair.attributes, pair.enumerators) == (["x", "y"], (("a", ""),), ())
    order = declaration_of("TYPE Order :\n(\n  First := 3,\n  Second\n);\nEND_TYPE")
    assert order.enumerators == (("First", 3), ("Second", 4))
    (table,) = declaration_of(
        "PROGRAM P\nVAR\n  t : ARRAY[0..2] OF LREAL := [\n    1.0,\n    2.0, 3.0];\nEND_VAR"
    ).sections
    assert table.variables[0].initial == "[ 1.0, 2.0, 3.0]"


def test_a_head_it_cannot_read_is_refused() -> None:
    with pytest.raises(ValueError, match="not a head of an object"):
        declaration_of("FUNCTION_BLOCK Robot ABSTRACT\nVAR\nEND_VAR")


@pytest.mark.parametrize("line", ["  a b : LREAL;", "  a : LREAL", "a : LREAL;", "  a : LREAL; b : LREAL;"])
def test_a_declaration_it_cannot_read_is_refused(line: str) -> None:
    with pytest.raises(ValueError, match="not a declaration of variables"):
        declaration_of(f"FUNCTION F : BOOL\nVAR\n{line}\nEND_VAR")


def with_text_of(library: Library, label: str) -> Pair:
    """A machine, with another text for its block."""
    (one,) = (t for t in pairs_of(MECHANISM) if t.machine.label == label)
    controller = Controller(library, MECHANISM)
    assert controller.initialise(one.robot.parameters) == OK
    return Pair(one.machine, controller)


def compare(library: Library, *methods: str) -> None:
    """The comparisons of some methods."""
    for label in ("random 1", "limited"):
        one = with_text_of(library, label)
        for sample in one.regular[::2]:
            for method in methods:
                COMPARISONS[method](one, sample)


def test_unbroken_it_compiles_and_agrees() -> None:
    compare(compile_st(texts()), *COMPARISONS)


@pytest.mark.parametrize("name", REFUSED)
def test_a_broken_text_is_refused(name: str) -> None:
    with pytest.raises(StError, match=re.escape(REFUSED[name].said)):
        compile_st(texts(REFUSED[name]))


def test_a_missing_object_is_refused() -> None:
    found = {file: text for file, text in texts().items() if file != "Softkin_Root.st"}
    with pytest.raises(StError, match="undeclared function Softkin_Root"):
        compile_st(found)


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_stops_the_text(name: str) -> None:
    library = compile_st(texts(FAULTS[name]))
    one = with_text_of(library, "random 1")
    with pytest.raises(StFault, match=FAULTS[name].said):
        compare(library, "AxesToCartesian", "CartesianToAxes")
        one.controller.forward((math.inf, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_text_is_noticed(name: str) -> None:
    library = compile_st(texts(WRONG[name]))
    with pytest.raises(AssertionError):
        compare(library, name.split(":")[0])
