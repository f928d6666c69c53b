"""Every rule of the dialect is shown by a small text that breaks only that rule."""

from collections.abc import Callable

import pytest

from tests.harness.library import StError, compile_st

FUNCTION = "FUNCTION Probe : BOOL\nVAR\n{variables}\nEND_VAR\nProbe := TRUE;\n{body}\nEND_FUNCTION\n"
BLOCK = """FUNCTION_BLOCK Probe
VAR_INPUT dIn : LREAL; END_VAR
VAR_OUTPUT vOut : SMC_Vector3D; END_VAR
VAR nOwn : DINT; END_VAR
{members}
END_FUNCTION_BLOCK
"""
VARIABLES = """ x : LREAL; b : BOOL; n : DINT; u : UINT; i : INT; y : BYTE; line : STRING(10);
 arr : ARRAY[0..2] OF LREAL; m : SMC_Matrix3; fr : SMC_Frame; a : AXISPOS_REF; e : SMC_ERROR;
 p : POINTER TO ARRAY[0..8] OF LREAL; os : OrientationSpace;
 vs : ARRAY[0..2] OF SMC_Vector3D; frames : POINTER TO ARRAY[0..0] OF SMC_Frame;"""
CALLEE = """
FUNCTION Callee : LREAL
VAR_INPUT x : LREAL; END_VAR
VAR_IN_OUT v : SMC_Vector3D; END_VAR
VAR_OUTPUT d : LREAL; END_VAR
Callee := x;
END_FUNCTION
"""


def refused(text: str) -> str:
    with pytest.raises(StError) as caught:
        compile_st({"probe.st": text})
    assert str(caught.value).startswith("probe.st:")
    return str(caught.value)


BODIES = {
    "missing semicolon": ("x := 1.0\nn := 1;", "missing ';'"),
    "unbalanced END_IF": ("IF b THEN\n x := 1.0;\n", "END_IF"),
    "END_IF too many": ("IF b THEN\n x := 1.0;\nEND_IF\nEND_IF", "syntax error"),
    "undeclared name": ("x := z;", "undeclared name z"),
    "undeclared function": ("x := Foo(1.0);", "undeclared function Foo"),
    "unknown field": ("a.a6 := 1.0;", "no field a6"),
    "unknown enum member": ("e := SMC_ERROR.SMC_FOO;", "no member SMC_FOO"),
    "unknown enum member qualified": ("b := os.dof = TRAFO.OrientationDOF.two;", "no member two"),
    "unqualified member of a closed enum": ("os.dof := three;", "undeclared name three"),
    "enum of another type": ("e := TRAFO.OrientationDOF.one;", "does not fit"),
    "enum from integer": ("e := 0;", "does not fit"),
    "field of the opaque matrix": ("x := m.r11;", "not known"),
    "index of the opaque matrix": ("x := m[0];", "no index"),
    "real from BOOL": ("x := b;", "BOOL does not fit LREAL"),
    "BOOL from real": ("b := x;", "LREAL does not fit BOOL"),
    "BOOL from integer literal": ("b := 1;", "does not fit BOOL"),
    "narrowing": ("n := x;", "LREAL does not fit DINT"),
    "real literal to integer": ("n := 1.0;", "LREAL does not fit DINT"),
    "real literal without a point": ("x := 1E5;", "needs a decimal point"),
    "real literal too large": ("x := 1.0E400;", "too large"),
    "integer division as a real": ("x := 1 / 2;", "DINT does not fit LREAL"),
    "integer to real": ("x := n;", "DINT does not fit LREAL"),
    "mixed arithmetic": ("x := x * n;", "not allowed"),
    "signed to unsigned": ("u := i;", "INT does not fit UINT"),
    "unsigned to signed of the same size": ("i := u;", "UINT does not fit INT"),
    "integer narrowing": ("i := n;", "DINT does not fit INT"),
    "BYTE is no number": ("n := y;", "BYTE does not fit DINT"),
    "arithmetic on BYTE": ("y := y + y;", "not allowed"),
    "literal too large": ("y := 256;", "does not fit BYTE"),
    "negative literal to unsigned": ("u := -1;", "does not fit UINT"),
    "string to number": ("x := line;", "does not fit LREAL"),
    "struct of another type": ("a := fr;", "does not fit"),
    "comparison of structs": ("b := a = a;", "not allowed"),
    "order of BOOL": ("b := b < b;", "not allowed"),
    "AND of numbers": ("n := n AND n;", "not allowed"),
    "NOT of a number": ("b := NOT n;", "does not take"),
    "MOD of reals": ("x := x MOD 2.0;", "not allowed"),
    "condition not BOOL": ("IF n THEN x := 1.0; END_IF", "not BOOL"),
    "WHILE": ("WHILE b DO x := 1.0; END_WHILE", "while_statement is not part of the dialect"),
    "CASE over a range": ("CASE n OF 1..2: i := 1; END_CASE", "is not part of the dialect"),
    "a literal of base 16": ("n := 16#FF;", "16#FF is not part of the dialect"),
    "FOR over a real": ("FOR x := 0 TO 3 DO n := 1; END_FOR", "FOR"),
    "FOR bound of wrong type": ("FOR n := 0 TO x DO b := TRUE; END_FOR", "does not fit"),
    "FOR step 0": ("FOR n := 0 TO 3 BY 0 DO b := TRUE; END_FOR", "BY"),
    "EXIT outside a loop": ("EXIT;", "EXIT"),
    "CASE over a real": ("CASE x OF 1: n := 1; END_CASE", "CASE"),
    "CASE label of wrong type": ("CASE e OF 1: n := 1; END_CASE", "label"),
    "CASE label twice": ("CASE n OF 1: n := 1; 1: n := 2; END_CASE", "twice"),
    "CASE label not constant": ("CASE n OF i: n := 1; END_CASE", "constant"),
    "index outside": ("arr[3] := 1.0;", "outside"),
    "index not an integer": ("arr[x] := 1.0;", "cannot be an index"),
    "index of a scalar": ("x[0] := 1.0;", "no index"),
    "wrong number of indices": ("arr[0, 1] := 1.0;", "needs 1 indices"),
    "dereference of a number": ("x := n^;", "no pointer"),
    "pointer to the wrong memory": ("p := ADR(n);", "does not fit"),
    "pointer to an array of another structure": ("frames := ADR(vs);", "does not fit"),
    "number to pointer": ("p := 0;", "does not fit"),
    "too few arguments": ("x := Callee(1.0);", "argument v of Callee is missing"),
    "too many arguments": ("x := Callee(1.0, fr.vT, x);", "too many arguments"),
    "wrong name": ("x := Callee(x := 1.0, v := fr.vT, w := x);", "no parameter w"),
    "given twice": ("x := Callee(x := 1.0, x := 1.0, v := fr.vT);", "given twice"),
    "wrong argument type": ("x := Callee(b, fr.vT);", "does not fit"),
    "in-out that is no variable": ("x := Callee(1.0, 2.0);", "needs a variable"),
    "in-out of another type": ("x := Callee(1.0, a);", "not a"),
    "output with :=": ("x := Callee(x := 1.0, v := fr.vT, d := x);", "=>"),
    "input with =>": ("x := Callee(x => x, v := fr.vT);", ":="),
    "output of another type": ("x := Callee(x := 1.0, v := fr.vT, d => n);", "not a"),
    "no result": ("b := Silent();", "nothing does not fit"),
    "number of arguments of a builtin": ("x := SQRT(x, x);", "wrong number of arguments"),
    "type of a builtin": ("x := SQRT(b);", "does not take"),
    "conversion of the wrong type": ("n := INT_TO_DINT(x);", "does not take"),
    "conversion that does not exist": ("n := LREAL_TO_FOO(x);", "undeclared function"),
    "ATAN2": ("x := ATAN2(x, x);", "ATAN2"),
    "FLOOR": ("x := FLOOR(x);", "FLOOR"),
    "EXPT": ("x := EXPT(x, 2.0);", "EXPT"),
    "power": ("x := x ** 2.0;", "**"),
    "AND_THEN": ("b := b AND_THEN b;", "AND_THEN"),
    "OR_ELSE": ("b := b OR_ELSE b;", "OR_ELSE"),
    "CONTINUE": ("FOR n := 0 TO 3 DO CONTINUE; END_FOR", "CONTINUE"),
    "nested comment": ("(* a (* b *) c *)", "nested comment"),
    "chained assignment": ("x := x := 1.0;", "syntax error"),
    "assignment to a call": ("Callee(1.0, fr.vT) := 1.0;", "not a variable"),
    "assignment to an enum member": ("SMC_ERROR.SMC_NO_ERROR := e;", "not a variable"),
    "assignment to a global constant": ("SM3M.SMC_MAX_VEC_DIM := 3;", "constant"),
    "recursion": ("b := Probe();", "calls itself"),
    "THIS in a function": ("x := THIS^.x;", "THIS"),
    "a name with two underscores": ("x__y := 1.0;", "double underscore"),
}


READER = """
FUNCTION Reader : LREAL
VAR_IN_OUT CONSTANT v : LREAL; w : ARRAY[0..8] OF LREAL; END_VAR
Reader := v + w[0];
END_FUNCTION
VAR_GLOBAL CONSTANT
  LARGEST : LREAL := 1.0;
END_VAR
"""
READ = {
    "a literal": ("1.0", "many"),
    "an expression": ("x + 1.0", "many"),
    "a negative": ("-x", "many"),
    "a result of a function": ("SQRT(x)", "many"),
    "the result of the function itself": ("Probe", "many"),
    "a constant": ("ONE", "many"),
    "an element of a constant": ("TABLE[0]", "many"),
    "a constant array": ("x", "TABLE"),
    "a global constant": ("LARGEST", "many"),
    "what a pointer points to": ("x", "p^"),
    "an element behind a pointer": ("p^[0]", "many"),
}
"""What a VAR_IN_OUT CONSTANT does not take."""


def reading(v: str, w: str) -> str:
    variables = "  x : LREAL; many : ARRAY[0..8] OF LREAL; f : SMC_Frame; p : POINTER TO ARRAY[0..8] OF LREAL;"
    constants = "  ONE : LREAL := 1.0; TABLE : ARRAY[0..8] OF LREAL := [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];"
    head = f"FUNCTION Probe : LREAL\nVAR CONSTANT\n{constants}\nEND_VAR\nVAR\n{variables}\nEND_VAR\n"
    return f"{READER}{head}p := ADR(many);\nProbe := 1.0;\nx := Reader(v := {v}, w := {w});\nEND_FUNCTION\n"


@pytest.mark.parametrize("name", READ)
def test_a_constant_reference_needs_a_variable(name: str) -> None:
    assert "needs a variable" in refused(reading(*READ[name]))


@pytest.mark.parametrize("v", ["x", "many[3]", "f.vT.dX"])
def test_a_constant_reference_takes_a_variable(v: str) -> None:
    """A variable, an element and a member are taken, and so is a reference that is handed on."""
    relay = reading(v, "many").replace("FUNCTION Probe", "FUNCTION Relay", 1)
    handed = "FUNCTION Handed : LREAL\nVAR_IN_OUT CONSTANT v : LREAL; w : ARRAY[0..8] OF LREAL; END_VAR\n"
    handed += "Handed := Reader(v := v, w := w);\nEND_FUNCTION\n"
    compile_st({"probe.st": relay.replace("Probe :=", "Relay :=") + handed})


VARIABLES_REFUSED = {
    "unknown type": ("x : FOO;", "unknown type FOO"),
    "unknown type of a namespace": ("x : TRAFO.FOO;", "unknown type TRAFO.FOO"),
    "initial value of wrong type": ("x : DINT := 1.0;", "initial value"),
    "initial value not constant": ("x : DINT; y : DINT := x;", "not constant"),
    "array initialised half": ("x : ARRAY[0..2] OF LREAL := [1.0, 2.0];", "do not fill"),
    "empty array": ("x : ARRAY[1..0] OF LREAL;", "empty array"),
    "bound not constant": ("n : DINT; x : ARRAY[0..n] OF LREAL;", "constant"),
    "duplicate": ("x : LREAL; X : BOOL;", "duplicate name X"),
    "the name of the function": ("probe : LREAL;", "duplicate name probe"),
    "double underscore": ("x__y : LREAL;", "double underscore"),
    "keyword": ("Public : LREAL;", "word of the language"),
    "builtin": ("Abs : LREAL;", "word of the language"),
    "C macro EFAULT": ("eFault : LREAL;", "macro"),
    "C macro NAN": ("nan : LREAL;", "macro"),
    "C macro INFINITY": ("Infinity : LREAL;", "macro"),
    "C macro HUGE_VAL": ("HUGE_VAL : LREAL;", "macro"),
    "REFERENCE TO": ("x : REFERENCE TO LREAL;", "REFERENCE"),
    "struct initialiser": ("x : SMC_Vector3D := (dX := 1.0);", "structure_initializer"),
    "AT address": ("x AT %MD0 : LREAL;", "AT"),
}


def method(body: str, sections: str = "", name: str = "Act", result: str = "") -> str:
    return f"METHOD PUBLIC {name}{result}\n{sections}\n{body}\nEND_METHOD\n"


IN_OUT = "VAR_IN_OUT CONSTANT v : SMC_Vector3D; m : SMC_Matrix3; k : LREAL; END_VAR"
TAKES = method("w.dX := 1.0;", "VAR_IN_OUT w : SMC_Vector3D; END_VAR", "Takes")
POINTER = "VAR p : POINTER TO ARRAY[0..8] OF LREAL; END_VAR"

MEMBERS = {
    "write to a constant in-out": (method("k := 1.0;", IN_OUT), "VAR_IN_OUT CONSTANT k"),
    "write to a field of a constant in-out": (method("v.dX := 1.0;", IN_OUT), "VAR_IN_OUT CONSTANT v"),
    "constant in-out handed on": (TAKES + method("Takes(w := v);", IN_OUT), "VAR_IN_OUT CONSTANT v"),
    "address of a constant in-out": (method("p := ADR(m);", IN_OUT + "\n" + POINTER), "VAR_IN_OUT CONSTANT m"),
    "write to a constant": (method("c := 2.0;", "VAR CONSTANT c : LREAL := 1.0; END_VAR"), "constant c"),
    "write to an input": (method("dIn := 1.0;"), "a method writes the input dIn"),
    "Initialize writes an input": (method("dIn := 1.0;", name="Initialize"), "a method writes the input dIn"),
    "write to an input through THIS": (method("THIS^.dIn := 1.0;"), "a method writes the input dIn"),
    "write to the instance": (method("nOwn := 1;"), "only Initialize and AxisSettings may write"),
    "write to the instance through THIS": (method("THIS^.nOwn := 1;"), "only Initialize and AxisSettings may write"),
    "FOR over an instance variable": (
        method("FOR nOwn := 0 TO 1 DO ; END_FOR"),
        "only Initialize and AxisSettings may write",
    ),
    "body of a block with methods writes": ("nOwn := 1;\n" + method(";"), "the body of a block with methods"),
    "a local hides a variable": (method(";", "VAR NOWN : DINT; END_VAR"), "hides a member"),
    "a local hides a method": (TAKES + method(";", "VAR takes : DINT; END_VAR"), "hides a member"),
    "the same method twice": (TAKES + TAKES, "duplicate name Takes"),
    "result never assigned": (method(";", result=" : BOOL"), "never assigns"),
    "unknown method": (method("THIS^.Foo();"), "no method Foo"),
    "unknown member": (method("IF THIS^.foo THEN ; END_IF"), "no field foo"),
    "SUPER without a base": (method("SUPER^.Act();"), "SUPER"),
    "METHOD without an end": ("METHOD Act\n;\n", "METHOD without END_METHOD"),
    "property without GET": ("PROPERTY PUBLIC Q : UDINT\nEND_PROPERTY", "syntax error"),
    "getter that writes": (
        "PROPERTY PUBLIC Q : DINT\nGET\nnOwn := 1;\nQ := 1;\nEND_GET\nEND_PROPERTY",
        "only Initialize",
    ),
}


def test_a_block_that_runs_by_its_body_may_write() -> None:
    """Where all methods are private or protected, body and methods write; an input is written by none, and one public
    method, of the block or of its base, brings the rule back.
    """
    closed = method("nOwn := 1;").replace("PUBLIC", "PROTECTED") + "Act();\nnOwn := nOwn + 1;\n"
    library = compile_st({"probe.st": BLOCK.format(members=closed)})
    probe = library.new("Probe")
    probe()
    assert probe.nOwn == 2
    writes_input = method("dIn := 1.0;").replace("PUBLIC", "PROTECTED")
    assert "a method writes the input dIn" in refused(BLOCK.format(members=writes_input))
    for public in (method(";", name="Open"), "PROPERTY PUBLIC Q : DINT\nGET\nQ := 1;\nEND_GET\nEND_PROPERTY\n"):
        assert "only Initialize and AxisSettings may write" in refused(BLOCK.format(members=public + closed))
    base = BLOCK.format(members=method(";", name="Open"))
    derived = "FUNCTION_BLOCK Derived EXTENDS Probe\nMETHOD PROTECTED Act\nnOwn := 1;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
    assert "only Initialize and AxisSettings may write" in refused(base + derived)


INNER = BLOCK.format(members=method(";", name="Hidden").replace("PUBLIC", "PRIVATE"))
USER = "FUNCTION_BLOCK User\nVAR\n fb : Probe;\nEND_VAR\n{body}\nEND_FUNCTION_BLOCK\n"

INSTANCES = {
    "private method": ("fb.Hidden();", "private"),
    "local variable of another instance": ("IF fb.nOwn = 1 THEN ; END_IF", "local variable"),
    "output of another instance": ("fb.vOut := fb.vOut;", "no input"),
    "part of an output of another instance": ("fb.vOut.dX := 1.0;", "no input"),
    "unknown input": ("fb(foo := 1.0);", "no parameter foo"),
    "input of wrong type": ("fb(dIn := TRUE);", "does not fit"),
    "assignment of an instance": ("fb := fb;", "cannot be assigned"),
}


OBJECTS = {
    "the same object twice": (BLOCK.format(members="") * 2, "duplicate name Probe"),
    "the name of a library type": ("TYPE Axispos_Ref : STRUCT x : LREAL; END_STRUCT END_TYPE", "duplicate name"),
    "duplicate field": ("TYPE T1 : STRUCT x : LREAL; X : LREAL; END_STRUCT END_TYPE", "duplicate name X"),
    "duplicate enum member": ("TYPE T1 : (one, One); END_TYPE", "duplicate name One"),
    "keyword as enum member": ("TYPE T1 : (one, Exit); END_TYPE", "word of the language"),
    "macro as enum member": ("TYPE T1 : (one, EOF); END_TYPE", "macro"),
    "unknown base": ("FUNCTION_BLOCK B EXTENDS Foo\nEND_FUNCTION_BLOCK", "unknown base block Foo"),
    "unknown interface": ("FUNCTION_BLOCK B IMPLEMENTS TRAFO.Foo\nEND_FUNCTION_BLOCK", "unknown interface TRAFO.Foo"),
    "no end": ("FUNCTION_BLOCK B\nVAR\nEND_VAR\n", "without END_FUNCTION_BLOCK"),
    "text between objects": ("x := 1;\n" + BLOCK.format(members=""), "outside an object"),
    "interface of its own": ("INTERFACE I1\nEND_INTERFACE", "INTERFACE"),
}


SILENT = "FUNCTION Silent\nVAR\n q : BOOL;\nEND_VAR\nq := TRUE;\nEND_FUNCTION\n"
AROUND: dict[str, tuple[dict[str, tuple[str, str]], Callable[[str], str]]] = {
    "a body": (BODIES, lambda body: CALLEE + SILENT + FUNCTION.format(variables=VARIABLES, body=body)),
    "a declaration": (VARIABLES_REFUSED, lambda variables: FUNCTION.format(variables=variables, body="")),
    "a member": (MEMBERS, lambda members: BLOCK.format(members=members)),
    "a use of an instance": (INSTANCES, lambda body: INNER + USER.format(body=body)),
    "an object": (OBJECTS, str),
}
"""What breaks a rule, with the message, and the text around it."""


@pytest.mark.parametrize(("part", "name"), [(part, name) for part, (rules, _) in AROUND.items() for name in rules])
def test_what_breaks_a_rule_is_refused(part: str, name: str) -> None:
    rules, whole = AROUND[part]
    text, message = rules[name]
    assert message in refused(whole(text))


def test_the_message_names_file_and_line() -> None:
    text = FUNCTION.format(variables="x : LREAL;", body="\n\nx := y;")
    assert refused(text) == "probe.st:8: undeclared name y"


def test_the_line_of_a_member_is_right() -> None:
    text = BLOCK.format(members="(* note\n *)\n" + method("\nnOwn := TRUE;"))
    assert refused(text).startswith("probe.st:10: ")
