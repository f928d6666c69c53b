"""What would stop a PLC is a fault here, with the line where it happens."""

from typing import Any

import pytest

from tests.harness.library import Library, StFault, compile_st

INF, NAN = float("inf"), float("nan")
VARIABLES = """n : DINT; i : INT; u : UDINT; y : BYTE; b : BOOL; arr : ARRAY[1..3] OF LREAL;
p : POINTER TO ARRAY[0..8] OF LREAL; m : SMC_Matrix3; short : ARRAY[0..2] OF LREAL; z : LREAL;"""


def library(body: str, **options: Any) -> Library:
    text = f"""FUNCTION Probe : LREAL
VAR_INPUT x : LREAL; k : DINT; END_VAR
VAR {VARIABLES.replace(chr(10), " ")} END_VAR
Probe := 0.0;
{body}
END_FUNCTION
"""
    return compile_st({"probe.st": text}, **options)


def run(body: str, x: float = 0.0, k: int = 0, **options: Any) -> Any:
    return library(body, **options).function("Probe")(x, k)


FAULTS = {
    "real division": ("Probe := 1.0 / x;", 0.0, 0, "division by zero"),
    "real division by a difference": ("Probe := 1.0 / (x - x);", 2.0, 0, "division by zero"),
    "integer division": ("n := 1 / k;", 0.0, 0, "division by zero"),
    "MOD": ("n := 1 MOD k;", 0.0, 0, "division by zero"),
    "SQRT": ("Probe := SQRT(x);", -1.0, 0, "SQRT of a negative"),
    "SQRT of a tiny negative": ("Probe := SQRT(x);", -1e-300, 0, "SQRT of a negative"),
    "product too large": ("Probe := x * x;", 1e200, 0, "not finite"),
    "sum too large": ("Probe := x + x;", 1e308, 0, "not finite"),
    "quotient too large": ("Probe := x / 1.0E-200;", 1e200, 0, "not finite"),
    "negated product": ("Probe := -(x * x);", 1e200, 0, "not finite"),
    "arithmetic on NaN": ("Probe := x + 1.0;", NAN, 0, "not finite"),
    "arithmetic on infinity": ("Probe := x - x;", INF, 0, "not finite"),
    "infinity hidden by a divisor": ("Probe := 1.0 / (x * x);", 1e200, 0, "not finite"),
    "infinity hidden by a comparison": ("b := x * x > 1.0;", 1e200, 0, "not finite"),
    "infinity hidden by ATAN": ("Probe := ATAN(x * x);", 1e200, 0, "not finite"),
    "infinity hidden by MIN": ("Probe := MIN(x * x, 1.0);", 1e200, 0, "not finite"),
    "infinity hidden by an index": ("arr[LREAL_TO_DINT(x * x)] := 1.0;", 1e200, 0, "not finite"),
    "MAX of NaN": ("Probe := MAX(0.0, x);", NAN, 0, "not finite"),
    "MIN of NaN": ("Probe := MIN(x, 0.0);", NAN, 0, "not finite"),
    "LIMIT of NaN": ("Probe := LIMIT(0.0, x, 1.0);", NAN, 0, "not finite"),
    "ABS of infinity": ("Probe := ABS(x);", INF, 0, "not finite"),
    "SIN of infinity": ("Probe := SIN(x);", INF, 0, "domain"),
    "SIN of NaN": ("Probe := SIN(x);", NAN, 0, "not finite"),
    "NaN to integer": ("n := LREAL_TO_DINT(x);", NAN, 0, "conversion"),
    "too large for DINT": ("n := LREAL_TO_DINT(x);", 2147483647.5, 0, "overflow"),
    "too large for TRUNC": ("n := TRUNC(x);", 2147483648.0, 0, "overflow"),
    "too large for BYTE": ("y := DINT_TO_BYTE(k);", 0.0, 256, "overflow"),
    "negative for BYTE": ("y := DINT_TO_BYTE(k);", 0.0, -1, "overflow"),
    "negative for UDINT": ("u := DINT_TO_UDINT(k);", 0.0, -1, "overflow"),
    "too large for INT": ("i := DINT_TO_INT(k);", 0.0, 32768, "overflow"),
    "integer sum": ("n := k + 1;", 0.0, 2**31 - 1, "overflow"),
    "integer product": ("n := k * k;", 0.0, 65536, "overflow"),
    "integer negation": ("n := -k;", 0.0, -(2**31), "overflow"),
    "integer ABS": ("n := ABS(k);", 0.0, -(2**31), "overflow"),
    "unsigned difference": ("u := u - 1;", 0.0, 0, "overflow"),
    "index too large": ("arr[k] := 1.0;", 0.0, 4, "outside 1..3"),
    "index too small": ("Probe := arr[k];", 0.0, 0, "outside 1..3"),
    "null pointer read": ("Probe := p^[0];", 0.0, 0, "null pointer"),
    "null pointer write": ("p^[0] := 1.0;", 0.0, 0, "null pointer"),
    "pointer index": ("p := ADR(m); p^[k] := 1.0;", 0.0, 9, "outside 0..8"),
    "write beyond the memory": ("p := ADR(short); p^[k] := 1.0;", 0.0, 3, "write beyond"),
    "read beyond the memory": ("p := ADR(short); Probe := p^[k];", 0.0, 3, "read beyond"),
    "endless FOR": ("FOR n := 0 TO 3 DO n := 0; END_FOR", 0.0, 0, "loop"),
    "FOR that steps past its type": ("FOR n := 2147483646 TO 2147483647 DO b := TRUE; END_FOR", 0.0, 0, "overflow"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_stops_the_text_and_names_its_line(name: str) -> None:
    body, x, k, message = FAULTS[name]
    with pytest.raises(StFault, match=message) as caught:
        run(body, x, k)
    assert str(caught.value).startswith("probe.st:5: ")


@pytest.mark.parametrize("garbage", [NAN, INF, -INF])
def test_a_garbage_input_can_be_copied_and_compared(garbage: float) -> None:
    assert run("z := x; b := z > 1.0; b := z = x; IF NOT (x <= 1.0E9) THEN Probe := 1.0; END_IF", garbage) in (0.0, 1.0)


@pytest.mark.parametrize("side", ["b OR (1.0 / x > 0.0)", "(1.0 / x > 0.0) OR b", "(b XOR b) AND (1.0 / x > 0.0)"])
def test_both_sides_of_a_logic_operator_are_evaluated(side: str) -> None:
    """AND and OR evaluate both operands, as the standard allows a controller to do."""
    with pytest.raises(StFault, match="division by zero"):
        run(f"b := TRUE; b := {side};")


def test_a_fault_inside_a_called_function_names_the_inner_line() -> None:
    text = """FUNCTION Inner : LREAL
VAR_INPUT x : LREAL; END_VAR
Inner := 1.0 / x;
END_FUNCTION
FUNCTION Outer : LREAL
VAR_INPUT x : LREAL; END_VAR
Outer := Inner(x);
END_FUNCTION
"""
    with pytest.raises(StFault, match="division by zero") as caught:
        compile_st({"two.st": text}).function("Outer")(0.0)
    assert str(caught.value).startswith("two.st:3: ")


def test_recursion_without_end_is_a_fault() -> None:
    text = """FUNCTION_BLOCK Looping
METHOD PUBLIC Ping : BOOL
Ping := Pong();
END_METHOD
METHOD PUBLIC Pong : BOOL
Pong := Ping();
END_METHOD
END_FUNCTION_BLOCK
"""
    with pytest.raises(StFault, match="recursion"):
        compile_st({"loop.st": text}).new("Looping").call("Ping")


@pytest.mark.parametrize(("size", "reach"), [(36, 4), (72, 9), (80, 9)])
def test_the_size_of_the_matrix_limits_what_a_pointer_reaches(size: int, reach: int) -> None:
    body = "p := ADR(m); FOR n := 0 TO k DO p^[n] := 1.0; END_FOR Probe := DINT_TO_LREAL(SIZEOF(m));"
    assert run(body, k=reach - 1, matrix_size=size) == size
    with pytest.raises(StFault):
        run(body, k=reach, matrix_size=size)
