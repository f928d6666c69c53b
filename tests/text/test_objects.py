"""The reading of an emitted text as objects, and of a declaration as what it declares."""

import pytest

from derive.emit.plcopen.declaration import declaration_of
from derive.emit.plcopen.objects import Object, as_text, objects_of

TEXT = "FUNCTION_BLOCK Block\n\nMETHOD PUBLIC Nothing\nEND_METHOD\nEND_FUNCTION_BLOCK\n"


def test_an_object_without_an_end_is_refused() -> None:
    """An object without its closing line is refused."""
    with pytest.raises(ValueError, match="'METHOD PUBLIC Nothing' has no END_METHOD"):
        objects_of(TEXT.replace("METHOD PUBLIC Nothing\nEND_METHOD", "METHOD PUBLIC Nothing"))


def test_text_in_no_object_is_refused() -> None:
    """Text outside of all objects is refused."""
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
    """A declaration with an unknown head is refused."""
    with pytest.raises(ValueError, match="not a head of an object"):
        declaration_of("FUNCTION_BLOCK Robot ABSTRACT\nVAR\nEND_VAR")


@pytest.mark.parametrize("line", ["  a b : LREAL;", "  a : LREAL", "a : LREAL;", "  a : LREAL; b : LREAL;"])
def test_a_declaration_it_cannot_read_is_refused(line: str) -> None:
    """A line that declares no variables, or those of two types, is refused."""
    with pytest.raises(ValueError, match="not a declaration of variables"):
        declaration_of(f"FUNCTION F : BOOL\nVAR\n{line}\nEND_VAR")
