"""The functions that touch the opaque matrix of the controller's library, and the order in which it stores entries."""

from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from tests.harness.library import Library, compile_st
from tests.text.comparisons import POSELESS
from tests.text.controller import OK, Controller
from tests.text.pairs import Pair, comparisons_of
from tests.text.samples import NO_TURN
from tests.text.units import compiled, shared_texts

NUMBERS = [float(n) for n in range(1, 10)]
ROWS = ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0))
UNTOUCHED = [0.5] * 9
FINDER = "Softkin_FindMatrixOrder.st"
ORDERS = {"rows": "Rows", "columns": "Columns"}


@cache
def library(order: str, matrix_size: int) -> Library:
    """The shared objects for a library that stores matrices in an order."""
    return compile_st(shared_texts(), order, matrix_size)


def matrix(made: Library, rows: tuple[tuple[float, ...], ...]) -> Any:
    """A rotation matrix of the controller."""
    value = made.new("SM3M.SMC_Matrix3")
    made.set_rotation(value, rows)
    return value


@pytest.mark.parametrize("order", ORDERS)
def test_the_order_is_found(order: str) -> None:
    """The storage order of the matrix is found, by rows and by columns."""
    assert library(order, 72).function("Softkin_FindMatrixOrder")() == ORDERS[order]


@pytest.mark.parametrize("size", [36, 80])
def test_no_order_where_the_size_differs(size: int) -> None:
    """A matrix of another size has an unknown order."""
    assert library("rows", size).function("Softkin_FindMatrixOrder")() == "Unknown"


@pytest.mark.parametrize("order", ORDERS)
def test_read_and_write(order: str) -> None:
    """Reading a matrix and writing it give back the rotation, in both storage orders."""
    made = library(order, 72)
    found = [0.0] * 9
    assert made.function("Softkin_ReadMatrix")(m=matrix(made, ROWS), aElements=found, eOrder=ORDERS[order]) is True
    assert found == NUMBERS
    written = matrix(made, NO_TURN)
    assert made.function("Softkin_WriteMatrix")(m=written, aElements=NUMBERS, eOrder=ORDERS[order]) is True
    assert made.get_rotation(written) == ROWS


@pytest.mark.parametrize(("size", "order"), [(72, "Unknown"), (36, "Rows"), (80, "Rows"), (80, "Columns")])
def test_nothing_is_touched_where_the_matrix_is_not_known(size: int, order: str) -> None:
    """With an unknown order reading and writing return FALSE and change nothing."""
    made = library("rows", size)
    found, value = UNTOUCHED[:], matrix(made, ROWS)
    assert made.function("Softkin_ReadMatrix")(m=value, aElements=found, eOrder=order) is False
    assert made.function("Softkin_WriteMatrix")(m=value, aElements=NUMBERS[::-1], eOrder=order) is False
    assert (found, made.get_rotation(value)) == (UNTOUCHED, ROWS)


BROKEN = {
    "a library that multiplies the other way round": (
        "(product, rotation, translation)",
        "(product, translation, rotation)",
    ),
    "a second function that disagrees": ("ABS(angle - 30.0)", "ABS(angle + 30.0)"),
    "a second function that fails": ("Softkin_Names.NoError THEN", "Softkin_Names.InvalidCoupling THEN"),
}


@cache
def misbehaving(name: str) -> Library:
    """A changed text, because the stand-in for the library cannot misbehave."""
    right, wrong = BROKEN[name]
    texts = dict(shared_texts())
    changed = texts[FINDER].replace(right, wrong)
    assert changed != texts[FINDER]
    return compile_st({**texts, FINDER: changed})


@pytest.mark.parametrize("name", BROKEN)
def test_no_order_where_the_library_behaves_otherwise(name: str) -> None:
    """A library whose functions behave differently has an unknown order."""
    assert misbehaving(name).function("Softkin_FindMatrixOrder")() == "Unknown"


def test_the_body_for_nine_fields_is_right() -> None:
    """The statements that stand in a comment read and write a matrix whose elements have names."""
    places = [(row, column) for row in (1, 2, 3) for column in (1, 2, 3)]
    fields = "".join(f"  field{row}{column} : LREAL;\n" for row, column in places)
    texts = {"Nine.st": f"TYPE Nine :\nSTRUCT\n{fields}END_STRUCT\nEND_TYPE\n"}
    for name in ("Softkin_ReadMatrix", "Softkin_WriteMatrix"):
        head, _, body = shared_texts()[f"{name}.st"].replace("SM3M.SMC_Matrix3", "Nine").partition(f"{name} := FALSE;")
        _, other = body.split("to field33.\n")
        declaration = head.replace("  copy : Nine;\n  view : POINTER TO ARRAY[0..8] OF LREAL;\n", "  unused : BOOL;\n")
        texts[f"{name}.st"] = declaration + other.replace("// Softkin", "Softkin").replace("// a", "a").replace(
            "// m", "m"
        )
    made = compile_st({**texts, "Softkin_MatrixOrder.st": shared_texts()["Softkin_MatrixOrder.st"]})
    written = made.new("Nine")
    assert made.function("Softkin_WriteMatrix")(m=written, aElements=NUMBERS, eOrder="Rows")
    assert [getattr(written, f"field{row}{column}") for row, column in places] == NUMBERS
    found = [0.0] * 9
    assert made.function("Softkin_ReadMatrix")(m=written, aElements=found, eOrder="Rows") and found == NUMBERS


FEW = 4
MACHINES = ("nominal", "random 2", "other", "limited")


def by_columns(pair: Pair) -> Controller:
    """The block with a library that stores its matrices the other way, which Initialize finds."""
    controller = Controller(compiled(pair.mechanism, "columns"), pair.mechanism)
    assert controller.initialise(pair.robot.parameters) == OK
    assert controller.block.matrixOrder.lower() == "columns"
    return controller


@pytest.mark.broad
@pytest.mark.long("Hexapod", "Scara4")
def test_every_method_answers_the_same_by_columns(pairs: tuple[Pair, ...]) -> None:
    """Every method gives the same answers for matrices that are stored by columns."""
    compared = [pair for pair in pairs if pair.machine.label in MACHINES]
    assert len(compared) == 3
    for pair in compared:
        controller = by_columns(pair)
        other = replace(pair, controller=controller)
        for sample in pair.regular[:FEW]:
            assert controller.forward(sample.axes) == pair.controller.forward(sample.axes)
            for method, compare in comparisons_of(pair.mechanism).items():
                if method not in POSELESS and method.lower() in controller.methods:
                    compare(other, sample)
