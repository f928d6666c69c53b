"""`Solve` is total: whatever the numbers are, it ends in a solution or in zeros, in every language, and nothing
faults."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from softkin import _array, _scalar

from derive.ir.primitives import solve
from tests.unit.ir.test_loops import controller

Array = NDArray[np.float64]
REGULAR = np.array([[2.0, 1.0, 0.0], [1.0, -3.0, 1.0], [0.0, 1.0, 4.0]])
SIDES = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
NO_NUMBERS = [np.nan, np.inf, -np.inf, 1e31, -1e31, 1.7e308]


def answers(matrix: Array, right: Array) -> list[tuple[float, list[float]]]:
    """Determinant and solution: the reference, of one system and of many, both runtimes of Python, and Structured Text,
    which faults where a PLC would.
    """
    rows, sides = matrix.tolist(), right.tolist()
    with np.errstate(all="ignore"):
        references = [solve(*(np.repeat(t[..., None], count, axis=2) for t in (matrix, right))) for count in (1, 20)]
        batch = _array.solve(*([tuple(np.array([v]) for v in row) for row in table] for table in (rows, sides)))
    scalar = _scalar.solve(rows, sides)
    return [
        *((float(d[0]), solution[..., 0].ravel().tolist()) for d, solution in references),
        (float(batch[0][0]), [float(v[0]) for v in batch[1:]]),
        (scalar[0], list(scalar[1:])),
        controller(rows, sides),
    ]


def assert_nothing(matrix: Array, right: Array = SIDES) -> None:
    assert answers(matrix, right) == [(0.0, [0.0] * right.size)] * 5


@pytest.mark.parametrize("wrong", NO_NUMBERS)
def test_an_entry_that_is_no_number(wrong: float) -> None:
    """A system with an entry that is no number has no solution, in every language."""
    for place in np.ndindex(3, 3):
        matrix = REGULAR.copy()
        matrix[place] = wrong
        assert_nothing(matrix)


@pytest.mark.parametrize("wrong", NO_NUMBERS)
def test_a_right_hand_side_that_is_no_number(wrong: float) -> None:
    """A system with a right-hand side that is no number has no solution, in every language."""
    for place in np.ndindex(3, 2):
        right = SIDES.copy()
        right[place] = wrong
        assert_nothing(REGULAR, right)


def test_a_pivot_that_is_zero_in_every_step() -> None:
    """A singular system of any rank has no solution, in every language."""
    for rank in (0, 1, 2):
        kept = np.arange(3) < rank
        assert_nothing(REGULAR * kept)
        assert_nothing(REGULAR * kept[:, None])
    assert_nothing(np.full((3, 3), np.nan), np.full((3, 2), np.nan))


def test_the_sizes_of_numbers_that_are_solved() -> None:
    """Systems with very small and very large entries are solved up to the limits of size."""
    wanted = np.linalg.solve(REGULAR, SIDES)
    for size in (3e-31, 2e29):
        for determinant, solution in answers(REGULAR * size, SIDES):
            assert determinant != 0.0
            np.testing.assert_allclose(np.reshape(solution, (3, 2)) * size, wanted, rtol=1e-12)
    assert_nothing(REGULAR * 2e-31)


@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_the_worst_that_is_solved_stays_finite(seed: int, size: int) -> None:
    """Numbers of any size next to each other, all but singular: no product overflows, and the languages agree."""
    generator = np.random.default_rng(seed)
    exponents = generator.choice([-30, -16, -14, -8, 0, 14, 30], (2, size, size))
    matrix, right = generator.choice([-1.0, 1.0, 0.999999999999], (2, size, size)) * 10.0**exponents
    found = answers(matrix, right)
    assert np.isfinite(found[0][0]) and np.isfinite(found[0][1]).all()
    assert found == [found[0]] * 5
