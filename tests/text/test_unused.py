"""Nothing is declared that is not used: no variable that nothing reads, no output that nothing assigns."""

import re

import pytest

from tests.harness import ast
from tests.harness.parse import parse
from tests.harness.unused import unused
from tests.text.contract.blocks import FILES


@pytest.mark.parametrize("file", FILES)
def test_everything_declared_is_used(file: str) -> None:
    """Every object of every file uses what it declares."""
    assert [one for declared in parse(FILES[file], file) for one in unused(declared)] == []


@pytest.mark.parametrize("name", ["Softkin_Kinematics", "Softkin_SelfTest"])
def test_what_the_base_declares_is_read_by_a_block(name: str) -> None:
    """No variable of a base block is there for nobody."""
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
    """The lint finds every kind of thing that is not used."""
    old, new, wanted = PLANTED[case]
    text = _BLOCK if case != "an instance variable that is only written" else _BLOCK.replace("e := kept", "e := 1.0")
    assert old in text
    (clean,), (spoiled,) = parse(_BLOCK, "Kin.st"), parse(text.replace(old, new), "Kin.st")
    assert list(unused(clean)) == []
    assert wanted in list(unused(spoiled))
