"""The meaning of texts that are right."""

from typing import Any

import pytest

from tests.harness.library import Cell, Library, compile_st


def library(text: str, **options: Any) -> Library:
    return compile_st({"sample.st": text}, **options)


def function(body: str, result: str = "LREAL", inputs: str = "", variables: str = "b : BOOL;") -> Any:
    text = f"""FUNCTION Probe : {result}
VAR_INPUT {inputs} END_VAR
VAR {variables} END_VAR
{body}
END_FUNCTION"""
    return library(text).function("Probe")


def test_names_ignore_case() -> None:
    text = """FUNCTION_BLOCK Arm
VAR_INPUT dLinkLength1 : lreal := 2.0; END_VAR
METHOD PUBLIC Twice : LREAL
twice := DLINKLENGTH1 + this^.dlinklength1;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK User
VAR_OUTPUT y : LREAL; END_VAR
VAR fb : ARM; END_VAR
Y := FB.TWICE();
END_FUNCTION_BLOCK"""
    lib = library(text)
    user = lib.new("user")
    user()
    assert user.y == 4.0
    assert lib.new("ARM").call("TWICE") == 4.0


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("7 / 2", 3), ("-7 / 2", -3), ("n / 2", -3), ("n MOD 4", -3), ("7 MOD -4", 3), ("2 + 3 * 4", 14),
        ("(2 + 3) * 4", 20), ("n - -3", -4), ("10 - 3 - 2", 5), ("n -1", -8), ("ABS(n)", 7), ("MAX(n, 3, 5)", 5),
        ("MIN(n, 3)", -7), ("LIMIT(0, n, 9)", 0), ("LIMIT(0, 12, 9)", 9), ("SEL(TRUE, 1, 2)", 2),
        ("SEL(FALSE, 1, 2)", 1), ("1_000", 1000), ("SIZEOF(SMC_Matrix3)", 72),
        ("SIZEOF(SM3M.SMC_Frame)", 96), ("SIZEOF(LREAL)", 8), ("SIZEOF(a)", 12), ("SIZEOF(AXISPOS_REF)", 48),
        ("SM3M.SMC_MAX_VEC_DIM - 1", 5), ("SMC_MAX_VEC_DIM", 6), ("BYTE_TO_DINT(y)", 200), ("DINT_TO_INT(n)", -7),
    ],
)  # fmt: skip
def test_integer_expressions(expression: str, value: int) -> None:
    variables = "n : DINT := -7; a : ARRAY[0..2] OF DINT; y : BYTE := 200;"
    assert function(f"Probe := {expression};", "DINT", variables=variables)() == value


@pytest.mark.parametrize(
    ("given", "nearest", "cut"),
    [(0.5, 1, 0), (1.5, 2, 1), (2.5, 3, 2), (-0.5, -1, 0), (-2.5, -3, -2), (2.4, 2, 2), (0.49999999999999994, 0, 0)],
)
def test_rounding(given: float, nearest: int, cut: int) -> None:
    """A conversion to an integer rounds to the nearest number, and TRUNC cuts off the fraction."""
    assert function("Probe := LREAL_TO_DINT(x);", "DINT", "x : LREAL;")(given) == nearest
    assert function("Probe := TRUNC(x);", "DINT", "x : LREAL;")(given) == cut


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("NOT b = FALSE", True), ("TRUE OR TRUE AND FALSE", True), ("TRUE XOR TRUE AND FALSE", True),
        ("NOT (1 < 2) OR 2 >= 2", True), ("1.0 <> 1", False), ("b XOR TRUE", False), ("INT_TO_BOOL(3)", True),
        ("e = SMC_ERROR.SMC_NO_ERROR", True), ("e <> SM3_Error.SMC_Error.SMC_TRAFO_INVALID_COUPLING", True),
        ("d = TRAFO.OrientationDOF.zero", True), ("p = 0", True), ("'a' = 'a'", True), ("(y AND 3) = 2", True),
        ("NOT y = 249", True),
    ],
)  # fmt: skip
def test_conditions(expression: str, value: bool) -> None:
    variables = (
        "b : BOOL := TRUE; e : SMC_Error; d : OrientationDOF; p : POINTER TO ARRAY[0..8] OF LREAL; y : BYTE := 6;"
    )
    # NOT binds tighter than =, as the operators of a sign do.
    assert function(f"Probe := {expression};", "BOOL", variables=variables)() is value


def test_numbers_keep_their_type() -> None:
    """An integer literal that is assigned to LREAL becomes a real number."""
    assert function("Probe := 1;")() == 1.0
    assert isinstance(function("Probe := SEL(b, 1, 2.0);")(), float)
    assert function("Probe := -x * 2;", inputs="x : LREAL;")(1.5) == -3.0
    assert function("Probe := 1.0 / 2;")() == 0.5


def test_loops_and_exit() -> None:
    variables = "i : INT; j : INT; sum : DINT;"
    text = """FOR i := 1 TO 10 DO
    FOR j := 10 TO 1 BY -3 DO
        IF j < 5 THEN EXIT; END_IF;
        sum := sum + j;
    END_FOR
    CASE i OF
        0: ;
        1, 2: sum := sum + 100;
        3: sum := sum + 1000; EXIT;
    ELSE
        sum := 0;
    END_CASE
END_FOR
Probe := sum;"""
    assert function(text, "DINT", variables=variables)() == 1251


def test_case_over_an_enumeration() -> None:
    text = """CASE d OF
    OrientationDOF.zero: Probe := 1;
    TRAFO.OrientationDOF.one, TRAFO.OrientationDOF.three: Probe := 2;
END_CASE"""
    probe = function(text, "INT", "d : OrientationDOF;")
    assert [probe("zero"), probe("one"), probe("three")] == [1, 2, 2]


def test_return_leaves_at_once() -> None:
    assert (
        function("Probe := 1.0; IF b THEN RETURN; END_IF Probe := 2.0;", inputs="b : BOOL;", variables="")(True) == 1.0
    )


def test_structures_are_copied_by_assignment() -> None:
    text = """u.dX := 1.0; v := u; u.dX := 2.0; Probe := v.dX;
f.vT := v; v.dX := 5.0; Probe := Probe + f.vT.dX;"""
    assert function(text, variables="u : SMC_Vector3D; v : SMC_Vector3D; f : SMC_Frame;")() == 2.0


def test_arrays() -> None:
    variables = (
        "a : ARRAY[0..1, 1..3] OF LREAL; c : ARRAY[0..1, 1..3] OF LREAL; k : ARRAY[0..2] OF DINT := [3(7)]; i : INT;"
    )
    text = """FOR i := 0 TO 1 DO a[i, i + 2] := 5.0; a[i, 1] := 1.0; END_FOR
c := a; a[0, 2] := 0.0;
Probe := 100 * c[0, 2] + 10 * c[1, 3] + c[1, 1] + DINT_TO_LREAL(k[0] + k[2]);"""
    assert function(text, variables=variables)() == 565.0


BY_REFERENCE = """FUNCTION Swap : BOOL
VAR_IN_OUT p : LREAL; q : LREAL; END_VAR
VAR_OUTPUT dSum : LREAL; END_VAR
VAR h : LREAL; END_VAR
h := p; p := q; q := h; dSum := p + q; Swap := TRUE;
END_FUNCTION
FUNCTION Probe : LREAL
VAR_INPUT x : LREAL; v : SMC_Vector3D; END_VAR
VAR y : LREAL := 7.0; a : ARRAY[0..1] OF LREAL; b : BOOL; total : LREAL; i : INT; END_VAR
b := Swap(p := x, q := y, dSum => total);
i := 1;
Swap(v.dX, a[i]);
Swap(p := x, q := v.dY, dSum => a[0]);
Probe := 1000 * x + 100 * y + 10 * total + a[1] + a[0];
END_FUNCTION"""


def test_scalars_by_reference() -> None:
    lib = library(BY_REFERENCE)
    v = lib.new("SMC_Vector3D")
    v.dX, v.dY = 3.0, 4.0
    assert lib.function("Probe")(2.0, v) == 4000 + 200 + 90 + 3 + 11
    assert (v.dX, v.dY) == (3.0, 4.0)  # an input structure is a copy
    one, two = Cell(1.0), Cell(2.0)
    assert lib.function("Swap")(one, two) is True
    assert (one.value, two.value) == (2.0, 1.0)
    assert lib.function("Swap").with_outputs(1.0, 2.0) == (True, {"p": 2.0, "q": 1.0, "dSum": 3.0})


BLOCKS = """FUNCTION_BLOCK Base
VAR_INPUT dIn : LREAL := 1.0; END_VAR
VAR_OUTPUT dOut : LREAL; vOut : SMC_Vector3D; END_VAR
VAR nCalls : DINT; END_VAR
VAR CONSTANT cFactor : LREAL := 3.0; END_VAR
dOut := dIn * cFactor;
vOut.dZ := dOut;
METHOD PUBLIC Weight : LREAL
Weight := 10.0;
END_METHOD
(* note *)
{attribute 'some'}
PROPERTY PUBLIC NumAxes : UDINT
GET
VAR n : UDINT := 4; END_VAR
NumAxes := n;
END_GET
END_PROPERTY
METHOD PUBLIC Total : LREAL
VAR_INPUT k : LREAL := 2.0; END_VAR
VAR_OUTPUT nAxes : UDINT; END_VAR
nAxes := NumAxes;
Total := THIS^.Weight() * k;
END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK Derived EXTENDS Base
VAR nMore : DINT := 5; END_VAR
METHOD PUBLIC Weight : LREAL
Weight := SUPER^.Weight() + 1.0;
END_METHOD
METHOD PUBLIC Initialize
nCalls := nCalls + nMore;
END_METHOD
METHOD PUBLIC Calls : DINT
Calls := nCalls;
END_METHOD
END_FUNCTION_BLOCK
PROGRAM Main
VAR fb : Derived; x : LREAL; n : UDINT; v : SMC_Vector3D; END_VAR
fb(dIn := 4.0, vOut => v);
x := fb.Total(nAxes => n) + v.dZ;
END_PROGRAM"""


def test_blocks_with_a_body() -> None:
    # A body that writes outputs is allowed only in a block without methods that others may call.
    text = """FUNCTION_BLOCK Base
VAR_INPUT dIn : LREAL := 1.0; END_VAR
VAR_IN_OUT dBoth : LREAL; v : SMC_Vector3D; END_VAR
VAR_OUTPUT dOut : LREAL; END_VAR
VAR CONSTANT cFactor : LREAL := 3.0; END_VAR
dOut := dIn * cFactor; dBoth := dBoth + 1.0; v.dX := dBoth;
END_FUNCTION_BLOCK
PROGRAM Main
VAR fb : Base; x : LREAL; y : LREAL := 7.0; w : SMC_Vector3D; END_VAR
fb(dIn := 4.0, dBoth := y, v := w, dOut => x);
fb.dIn := 2.0;
END_PROGRAM"""
    main = library(text).new("Main")
    main()
    assert (main.x, main.y, main.w.dX, main.fb.dIn) == (12.0, 8.0, 8.0, 2.0)


def test_blocks_that_extend_others() -> None:
    text = BLOCKS.replace("dOut := dIn * cFactor;\nvOut.dZ := dOut;\n", "")
    lib = library(text)
    fb = lib.new("Derived")
    assert fb.call("Total") == 22.0
    assert fb.call_with_outputs("Total", k=3.0) == (33.0, {"nAxes": 4})
    assert lib.new("Base").call("Total") == 20.0
    fb.call("Initialize")
    assert (fb.call("Calls"), fb.get("NumAxes"), fb.nCalls) == (5, 4, 5)
    main = lib.new("Main")
    main()
    assert (main.x, main.n) == (22.0, 4)


def test_a_misspelt_attribute_is_no_input() -> None:
    with pytest.raises(AttributeError):
        library("FUNCTION_BLOCK B\nVAR_INPUT x : LREAL; END_VAR\nEND_FUNCTION_BLOCK").new("B").y = 1.0


def test_wrong_arguments_from_python_are_refused() -> None:
    probe = function("Probe := x;", inputs="x : LREAL;")
    for arguments in ((), (1.0, 2.0)):
        with pytest.raises(TypeError):
            probe(*arguments)


def test_texts_see_each_other_in_any_order() -> None:
    user = "FUNCTION A : LREAL\nVAR one : T1; END_VAR\nA := B() + Lists.gc + one.x;\nEND_FUNCTION"
    used = "TYPE T1 : STRUCT x : LREAL := 1.5; END_STRUCT END_TYPE\nFUNCTION B : LREAL\nB := 1.0;\nEND_FUNCTION"
    constants = "{attribute 'qualified_only'}\nVAR_GLOBAL CONSTANT\n gc : LREAL := 2.0;\nEND_VAR"
    lib = compile_st({"a.st": user, "b.st": used, "Lists.st": constants})
    assert lib.function("A")() == 4.5
    assert lib.constant("Lists.gc") == 2.0


def test_declarations_are_kept_for_tests_of_signatures() -> None:
    lib = library(BLOCKS.replace("dOut := dIn * cFactor;\nvOut.dZ := dOut;\n", ""))
    base = lib.objects["Base"]
    assert list(lib.objects) == ["Base", "Derived", "Main"]
    assert [m.name for m in base.methods] == ["Weight", "Total"]
    assert [(p.scope, p.name, p.type) for p in base.methods[1].params] == [
        ("VAR_INPUT", "k", "LREAL"),
        ("VAR_OUTPUT", "nAxes", "UDINT"),
    ]
    assert base.properties[0].comment == "note"
    assert base.properties[0].pragmas == ("{attribute 'some'}",)


def test_a_method_may_change_its_own_copy_of_an_input() -> None:
    assert function("x := x + 1.0; Probe := x;", inputs="x : LREAL;")(1.0) == 2.0


def test_a_long_sum_is_no_problem() -> None:
    assert function("Probe := x" + " + x * 2 - x" * 105 + ";", inputs="x : LREAL;")(1.0) == 106.0


@pytest.mark.parametrize(
    ("expression", "value"), [("x - y - z", -4.0), ("x - (y - z)", 2.0), ("x / y / z", 1 / 6), ("x / (y * z)", 1 / 6),
                              ("(x + y) * z", 9.0), ("x * y + z", 5.0), ("(x - y) / z", -1 / 3), ("-x - y", -3.0)]
)  # fmt: skip
def test_real_operators_associate_as_written(expression: str, value: float) -> None:
    assert function(f"Probe := {expression};", inputs="x : LREAL; y : LREAL; z : LREAL;")(1.0, 2.0, 3.0) == value
