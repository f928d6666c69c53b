"""The shared objects of the Structured Text, each alone: against the reference semantics of the primitives."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from derive.command.catalogue import OUTPUT
from derive.ir import primitives
from derive.ir.constants import COINCIDENT, EDGE
from tests.harness.library import Library, StError, compile_st

TEXTS = {p.name: p.read_text(encoding="utf-8") for p in sorted((OUTPUT / "st" / "softkin").glob("*.st"))}
SCARA = OUTPUT / "st" / "scara" / "Kin_Scara4_ZCcoupled_Type1.st"

lengths = some.floats(-1e9, 1e9)
angles = some.floats(-1e4, 1e4)
radians = some.floats(-100.0, 100.0)


@lru_cache
def library(**options: Any) -> Library:
    """The shared objects and the SCARA, compiled with options."""
    return compile_st({**TEXTS, SCARA.name: SCARA.read_text(encoding="utf-8")}, **options)


def call(name: str, *values: Any) -> Any:
    """What a shared function returns."""
    return library().function(f"Softkin_{name}")(*values)


@given(lengths, lengths)
def test_atan2(y: float, x: float) -> None:
    """Softkin_Atan2 is the arc tangent of two arguments, which ignores the sign of a zero."""
    assert call("Atan2", y, x) == pytest.approx(math.atan2(y + 0.0, x + 0.0), abs=1e-15, rel=1e-15)


@pytest.mark.parametrize("y", [-1.0, -0.0, 0.0, 1.0])
@pytest.mark.parametrize("x", [-1.0, -0.0, 0.0, 1.0])
def test_atan2_on_the_axes_and_diagonals(y: float, x: float) -> None:
    """A zero has no sign: the angle of the negative x axis is pi."""
    assert call("Atan2", y, x) == math.atan2(y + 0.0, x + 0.0)


@given(some.floats(-1e300, 1e300))
def test_root(value: float) -> None:
    """Softkin_Root is the square root, and 0 for a negative number."""
    assert call("Root", value) == math.sqrt(max(0.0, value))


@given(some.floats(-2e9, 2e9))
def test_floor(value: float) -> None:
    """Softkin_Floor is the largest whole number that is not more than its argument."""
    assert call("Floor", value) == math.floor(value)


@given(angles, angles)
def test_nearest_period(value: float, centre: float) -> None:
    """Softkin_NearestPeriod is bit for bit the reference function."""
    assert call("NearestPeriod", value, centre) == primitives.nearest_period(np.float64(value), np.float64(centre))


@given(radians, radians, some.floats(0.0, math.pi))
def test_nearest_on_arc(angle: float, centre: float, half: float) -> None:
    """Softkin_NearestOnArc is the reference function."""
    wanted = primitives.nearest_on_arc(np.float64(angle), np.float64(centre), np.float64(half))
    assert call("NearestOnArc", angle, centre, half) == pytest.approx(float(wanted), abs=1e-12)


@given(some.floats(-1e9, 1e9))
def test_period_number(axis: float) -> None:
    """Softkin_PeriodNumber is the number of the turn of an axis value, or 0 beyond a byte."""
    turns = math.floor((axis + (180.0 + float(EDGE))) / 360.0)
    number = turns + 1 if turns >= 0 else turns
    assert call("PeriodNumber", axis) == (number if abs(number) <= 127 else 0)


@pytest.mark.parametrize(
    ("axis", "number"),
    [(0, 1), (-180, 1), (179.9, 1), (180, 2), (-180.1, -1), (-540, -1), (-541, -2), (126 * 360, 127), (127 * 360, 0)],
)
def test_period_number_at_edges(axis: float, number: int) -> None:
    """An axis value on the edge of a turn belongs to the turn above."""
    assert call("PeriodNumber", float(axis)) == number


@pytest.mark.parametrize("period", range(-127, 128))
def test_a_period_survives_its_byte(period: int) -> None:
    """A period number that is written to a byte is read back."""
    assert call("PeriodOfByte", call("ByteOfPeriod", period)) == period


@pytest.mark.parametrize("period", [-32768, -128, 128, 32767])
def test_a_period_that_no_byte_holds_is_automatic(period: int) -> None:
    """A period number beyond a signed byte is written as automatic."""
    assert call("ByteOfPeriod", period) == 0


@pytest.mark.parametrize(("margin", "byte"), [(1.0, 1), (-1.0, 2), (0.0, 3), (float(COINCIDENT), 3), (-2e-11, 2)])
def test_branch_byte(margin: float, byte: int) -> None:
    """Softkin_BranchByte is 1 or 2 by the sign of the margin, and 3 where branches coincide."""
    assert call("BranchByte", margin) == byte


@pytest.mark.parametrize("order", ["rows", "columns"])
def test_the_storage_order_is_found(order: str) -> None:
    """Whatever the order, a rotation arrives as it is meant."""
    lib = library(order=order)
    assert lib.function("Softkin_FindMatrixOrder")().lower() == order
    rows = tuple(tuple(float(3 * r + c) for c in range(3)) for r in range(3))
    matrix, elements = lib.new("SM3M.SMC_Matrix3"), [float(i) for i in range(9)]
    assert lib.function("Softkin_WriteMatrix")(m=matrix, aElements=elements, eOrder=order.capitalize())
    assert lib.get_rotation(matrix) == rows
    read = [0.0] * 9
    assert lib.function("Softkin_ReadMatrix")(m=matrix, aElements=read, eOrder=order.capitalize())
    assert read == elements


def initialised(**options: Any) -> str:
    """The status of Initialize of a SCARA."""
    kinematics = library(**options).new("Kin_Scara4_ZCcoupled_Type1")
    kinematics(dLinkLength1=325.0, dLinkLength2=225.0)
    return str(kinematics.call("Initialize"))


def test_initialize_refuses_a_library_that_it_cannot_use() -> None:
    """Initialize accepts both storage orders, and refuses matrices and configurations of another size."""
    assert initialised() == initialised(order="columns") == "SMC_NO_ERROR"
    assert initialised(matrix_size=36) == initialised(matrix_size=80) == "SMC_TRAFO_NOT_INITIALIZED"
    assert initialised(max_config_data=3) == "SMC_NO_ERROR"
    with pytest.raises(StError, match="index 3 is outside"):  # too few bytes: the compiler refuses even earlier
        initialised(max_config_data=2)
