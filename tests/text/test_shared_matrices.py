"""Linear equations, rotations and matrices among the functions that all blocks share, held against NumPy."""

import math
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest
from softkin._rotation import made_rotation

from tests import orthonormal
from tests.harness.library import Library, compile_st
from tests.text.comparisons import COMPARISONS, POSELESS
from tests.text.controller import OK, Controller
from tests.text.pairs import Pair
from tests.text.samples import NO_TURN
from tests.text.units import compiled, compiled_shared, shared_texts

LIBRARY = compiled_shared()
NO_NUMBERS = (math.nan, math.inf, -math.inf, 1e300, -1e300, 1.0000001e9, -1.0000001e9)


def solved(matrix: np.ndarray, right: np.ndarray) -> tuple[float, np.ndarray]:
    """The determinant, and the solution: arrays of six rows or of 18, whatever lies beyond the equations."""
    size, columns = right.shape
    rows, wide = (6, 6) if size <= 6 else (18, 10)
    tables = [[[math.nan] * width for _ in range(rows)] for width in (rows, wide)]
    for table, filled in zip(tables, (matrix, right), strict=True):
        for row, values in enumerate(filled.tolist()):
            table[row][: len(values)] = values
    flat = [[value for row in table for value in row] for table in tables]
    function = LIBRARY.function("Softkin_Solve" if rows == 6 else "Softkin_SolveMany")
    determinant = function(*flat, size, columns)
    return determinant, np.array(flat[1]).reshape(rows, wide)[:size, :columns]


@pytest.mark.parametrize("size", [6, 8, 12, 16, 18])
def test_solve(size: int) -> None:
    rng = np.random.default_rng(size)
    for columns in (0, 1, 6):
        for _ in range(20):
            matrix, right = rng.normal(size=(size, size)), rng.normal(size=(size, columns))
            determinant, solution = solved(matrix, right)
            assert determinant == pytest.approx(np.linalg.det(matrix), rel=1e-8, abs=1e-12)
            np.testing.assert_allclose(matrix @ solution, right, atol=1e-8)


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.ones((3, 3)), np.ones((8, 8))])
def test_solve_where_nothing_solves(matrix: np.ndarray) -> None:
    determinant, solution = solved(matrix, np.ones((len(matrix), 2)))
    assert determinant == 0.0
    assert not solution.any()


def test_solve_what_is_no_number() -> None:
    for wrong, k, size in product((math.nan, math.inf, -math.inf, 1e31), range(2), (2, 8)):
        tables = np.eye(size) + 0.25, np.ones((size, 1))
        tables[k][1, 0] = wrong
        determinant, solution = solved(*tables)
        assert determinant == 0.0
        assert not solution.any()


def test_make_rotation() -> None:
    """Turned frames are one and stay as they are; what is one to a few digits is made one, and then stays as it is."""
    make = LIBRARY.function("Softkin_MakeRotation")
    for turned in orthonormal.random_rotations(20, 3):
        exact = turned.ravel().tolist()
        assert make(exact) and exact == turned.ravel().tolist()
        for off in (turned * (1.0 + 2e-13), turned @ np.array([[1.0, 3e-13, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])):
            nearly = off.ravel().tolist()  # beyond the first test, but within the rounding that is no error
            assert make(nearly) and nearly == off.ravel().tolist()
        for off in orthonormal.slightly_off(turned):
            found = off.ravel().tolist()
            assert make(found)
            np.testing.assert_allclose(np.reshape(found, (3, 3)), orthonormal.repaired(off), rtol=0, atol=1e-15)
            again = found[:]
            assert make(again) and again == found


def test_make_rotation_refuses_what_is_none() -> None:
    """Untouched where it is stretched, sheared or mirrored, or holds no numbers; the reason and the amount as in
    Python.
    """
    make, reason = (LIBRARY.function(f"Softkin_{name}") for name in ("MakeRotation", "RotationReason"))
    for turned in orthonormal.random_rotations(5, 3):
        wrong = [*orthonormal.too_far_off(turned), *orthonormal.mirrored(turned), 0.0 * turned, 1e9 * turned]
        for k in range(9):
            for number in NO_NUMBERS:
                wrong.append(turned.copy())
                wrong[-1].flat[k] = number
        for off in wrong:
            found = off.ravel().tolist()
            is_one, outputs = make.with_outputs(found)
            expected = made_rotation(tuple(map(tuple, off.tolist())))
            assert not is_one and repr(found) == repr(off.ravel().tolist())
            assert (reason(outputs["iReason"]), outputs["dMissing"]) == (expected.reason, expected.missing)
    assert reason(0) == ""


def test_relative_rotation() -> None:
    """What the base sees; untouched where one of the two is no rotation."""
    relative = LIBRARY.function("Softkin_RelativeRotation")
    turned = orthonormal.random_rotations(20, 3)
    for base, rotation in zip(turned, turned[::-1], strict=True):
        found = [7.0] * 9
        assert relative(found, base.ravel().tolist(), rotation.ravel().tolist())
        np.testing.assert_allclose(np.reshape(found, (3, 3)), base.T @ rotation, atol=1e-15)
        for one, other in ((2.0 * base, rotation), (base, 2.0 * rotation)):
            found = [7.0] * 9
            assert not relative(found, one.ravel().tolist(), other.ravel().tolist())
            assert found == [7.0] * 9


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
    value = made.new("SM3M.SMC_Matrix3")
    made.set_rotation(value, rows)
    return value


@pytest.mark.parametrize("order", ORDERS)
def test_the_order_is_found(order: str) -> None:
    assert library(order, 72).function("Softkin_FindMatrixOrder")() == ORDERS[order]


@pytest.mark.parametrize("size", [36, 80])
def test_no_order_where_the_size_differs(size: int) -> None:
    assert library("rows", size).function("Softkin_FindMatrixOrder")() == "Unknown"


@pytest.mark.parametrize("order", ORDERS)
def test_read_and_write(order: str) -> None:
    made = library(order, 72)
    found = [0.0] * 9
    assert made.function("Softkin_ReadMatrix")(m=matrix(made, ROWS), aElements=found, eOrder=ORDERS[order]) is True
    assert found == NUMBERS
    written = matrix(made, NO_TURN)
    assert made.function("Softkin_WriteMatrix")(m=written, aElements=NUMBERS, eOrder=ORDERS[order]) is True
    assert made.get_rotation(written) == ROWS


@pytest.mark.parametrize(("size", "order"), [(72, "Unknown"), (36, "Rows"), (80, "Rows"), (80, "Columns")])
def test_nothing_is_touched_where_the_matrix_is_not_known(size: int, order: str) -> None:
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
MACHINES = ("nominal", "random 2", "random 3", "limited")


def by_columns(pair: Pair) -> Controller:
    """The block with a library that stores its matrices the other way, which Initialize finds."""
    controller = Controller(compiled(pair.mechanism, "columns"), pair.mechanism)
    assert controller.initialise(pair.robot.parameters) == OK
    assert controller.block.matrixOrder.lower() == "columns"
    return controller


@pytest.mark.broad
@pytest.mark.long("Hexapod", "Scara4")
def test_every_method_answers_the_same_by_columns(pairs: tuple[Pair, ...]) -> None:
    compared = [pair for pair in pairs if pair.machine.label in MACHINES]
    assert len(compared) == 3
    for pair in compared:
        controller = by_columns(pair)
        other = replace(pair, controller=controller)
        for sample in pair.regular[:FEW]:
            assert controller.forward(sample.axes) == pair.controller.forward(sample.axes)
            for method, compare in COMPARISONS.items():
                if method not in POSELESS and method.lower() in controller.methods:
                    compare(other, sample)
