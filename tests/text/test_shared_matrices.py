"""Linear equations and rotations among the functions that all blocks share, held against NumPy."""

import math

import numpy as np
import pytest
from softkin._rotation import made_rotation

from tests import orthonormal
from tests.text.units import compiled_shared

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


@pytest.mark.parametrize("size", [*range(1, 7), 8, 12, 16, 18])
def test_solve(size: int) -> None:
    """The solution and the determinant of a linear system are those of NumPy."""
    rng = np.random.default_rng(size)
    for columns in (0, 1, 6):
        for _ in range(20):
            matrix, right = rng.normal(size=(size, size)), rng.normal(size=(size, columns))
            determinant, solution = solved(matrix, right)
            assert determinant == pytest.approx(np.linalg.det(matrix), rel=1e-8, abs=1e-12)
            np.testing.assert_allclose(matrix @ solution, right, atol=1e-8)


def test_solve_where_the_first_pivot_is_zero() -> None:
    """A system whose first pivot is zero is solved."""
    determinant, solution = solved(np.array([[0.0, 2.0], [4.0, 1.0]]), np.array([[2.0], [9.0]]))
    assert determinant == -8.0
    assert solution.tolist() == [[2.0], [1.0]]


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.ones((3, 3))])
def test_solve_where_nothing_solves(matrix: np.ndarray) -> None:
    """A singular system has the determinant 0 and a solution of zeros."""
    determinant, solution = solved(matrix, np.ones((3, 2)))
    assert determinant == 0.0
    assert not solution.any()


def test_solve_what_is_no_number() -> None:
    """A system with NaN, an infinite or a huge number has the determinant 0 and a solution of zeros."""
    for wrong in (math.nan, math.inf, -math.inf, 1e31):
        for k in range(2):
            tables = np.array([[2.0, 1.0], [1.0, -3.0]]), np.array([[1.0], [2.0]])
            tables[k][1, 0] = wrong
            determinant, solution = solved(*tables)
            assert determinant == 0.0
            assert not solution.any()


def test_make_rotation() -> None:
    """Turned frames are one and stay as they are; what is one to a few digits is made one, and then stays as it is."""
    make = LIBRARY.function("Softkin_MakeRotation")
    for turned in rotations(20):
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
    for turned in rotations(5):
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
    turned = rotations(20)
    for base, rotation in zip(turned, reversed(turned), strict=True):
        found = [7.0] * 9
        assert relative(found, base.ravel().tolist(), rotation.ravel().tolist())
        np.testing.assert_allclose(np.reshape(found, (3, 3)), base.T @ rotation, atol=1e-15)
        for one, other in ((2.0 * base, rotation), (base, 2.0 * rotation)):
            found = [7.0] * 9
            assert not relative(found, one.ravel().tolist(), other.ravel().tolist())
            assert found == [7.0] * 9


def rotations(count: int) -> list[np.ndarray]:
    """Random rotations."""
    rng = np.random.default_rng(3)
    return [q * np.sign(np.linalg.det(q)) for q in (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(count))]
