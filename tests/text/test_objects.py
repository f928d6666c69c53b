"""The reading of an emitted text as objects, and of a declaration as what it declares."""

from __future__ import annotations

import pytest

from derive.emit.plcopen.declaration import declaration_of
from derive.emit.plcopen.objects import Object, as_text, needed, objects_of

TEXT = """\
{attribute 'flag'}
{attribute 'name' := 'A1, A2'}
(*
FUNCTION is a word that may begin a line of a comment.
METHOD PUBLIC too.
*)
FUNCTION_BLOCK Block IMPLEMENTS
  SPACE.One,
  SPACE.Two
VAR_INPUT
  {attribute 'unit' := 'u'}
  dLength : LREAL := 0.0;  // Length: of arm 1
END_VAR
VAR CONSTANT
  // A remark
  LIMITS : ARRAY[0..1, 0..1] OF LREAL;
END_VAR

PROPERTY PUBLIC Count : UDINT
GET
Count := 2;
END_GET
END_PROPERTY

// What it does
METHOD PRIVATE Run : STRING(255)
VAR_IN_OUT CONSTANT
  a : SPACE.AXES;
END_VAR

IF a.x > 0.0 THEN
  Run := Helper('Third');
END_IF
END_METHOD

METHOD PUBLIC Nothing
END_METHOD
END_FUNCTION_BLOCK

// An order
TYPE Order :
(
  First,
  Second
);
END_TYPE
"""


def test_objects() -> None:
    """A text is split into objects with declaration, implementation and members."""
    block, order = objects_of(TEXT)
    assert (block.kind, block.name, block.implementation) == ("FUNCTION_BLOCK", "Block", "")
    assert block.declaration.startswith("{attribute 'flag'}\n") and block.declaration.endswith("OF LREAL;\nEND_VAR")
    count, run, nothing = block.members
    assert count.declaration == "PROPERTY PUBLIC Count : UDINT"
    assert count.members == (Object("GET", "Get", "", "Count := 2;"),)
    assert run.declaration.startswith("// What it does\nMETHOD PRIVATE Run") and run.declaration.endswith("END_VAR")
    assert run.implementation == "IF a.x > 0.0 THEN\n  Run := Helper('Third');\nEND_IF"
    assert (nothing.declaration, nothing.implementation) == ("METHOD PUBLIC Nothing", "")
    assert order.declaration.startswith("// An order\nTYPE Order") and order.declaration.endswith(");\nEND_TYPE")
    assert [part.name for part in block.parts()] == ["Block", "Count", "Get", "Run", "Nothing"]


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


def test_rulers_are_all_that_is_added() -> None:
    """The rulers are the only lines that are added to a text."""
    text = as_text(objects_of(TEXT))
    lines = [line.removesuffix("  // ====") for line in text.split("\n") if line and not line.startswith("// ====")]
    assert lines == [line for line in TEXT.split("\n") if line]
    titles = [line.strip("/= ") for line in text.split("\n") if line.startswith("// ====")]
    assert [title for title in titles if title] == [
        "FUNCTION_BLOCK Block: declaration",
        "PROPERTY Block.Count: declaration",
        "GET Block.Count: implementation",
        "METHOD Block.Run: declaration",
        "METHOD Block.Run: implementation",
        "METHOD Block.Nothing: declaration",
        "TYPE Order: declaration",
    ]


def test_no_closing_line_stands_between_two_rulers() -> None:
    """Between two rulers stands exactly what one pastes into one editor."""
    inside = ""
    for line in as_text(objects_of(TEXT)).split("\n"):
        if line.endswith("===="):
            inside = line.strip("/= ") if line.startswith("// ====") else ""
        elif inside:
            assert line != "GET" and not line.startswith(("END_METHOD", "END_GET", "END_PROPERTY", "END_FUNCTION")), (
                line
            )


def test_declarations() -> None:
    """The interfaces, sections, variables, types and comments of a declaration are read."""
    block, order = objects_of(TEXT)
    declared = declaration_of(block.declaration)
    assert declared.interfaces == ("SPACE.One", "SPACE.Two")
    assert declared.attributes == (("flag", ""), ("name", "A1, A2"))
    given, constant = declared.sections
    assert (given.scope, given.is_constant, constant.scope, constant.is_constant) == ("VAR_INPUT", False, "VAR", True)
    (length,) = given.variables
    assert (length.name, length.type, length.initial, length.comment) == ("dLength", "LREAL", "0.0", "Length: of arm 1")
    assert length.attributes == (("unit", "u"),)
    assert [v.type for v in constant.variables] == ["ARRAY[0..1, 0..1] OF LREAL"]
    assert list(declared.names()) == ["dLength", "LIMITS"]
    assert [declaration_of(m.declaration).returns for m in block.members] == ["UDINT", "STRING(255)", ""]
    assert declaration_of(order.declaration).enumerators == (("First", 0), ("Second", 1))


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


def test_what_a_file_needs() -> None:
    """A file needs the files whose objects its code names, directly or indirectly."""

    def function(name: str, code: str) -> tuple[Object, ...]:
        return objects_of(f"FUNCTION {name} : LREAL\n\n{name} := {code};\nEND_FUNCTION\n")

    files = {
        "unit": objects_of(TEXT),
        "helper": function("Helper", "Root(1.0)"),
        "root": function("Root", "1.0;  // not Unused"),
        "unused": function("Unused", "Helper(2.0)"),
        "third": function("Third", "1.0"),
    }
    assert needed("unit", files) == ("helper", "root", "unit")
    assert needed("unused", files) == ("helper", "root", "unused")
