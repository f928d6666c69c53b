"""What becomes of a rotation that a caller gives, in every kind of Python; arc tangents of several poses at a time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp
from softkin import Diagnosis, Status
from softkin._array_rotation import made_rotations
from softkin._rotation import in_words, made_rotation

from derive.emit.native import coefficients, horner
from derive.equations.rotation_repair import rotation_program
from derive.ir.interpret import run
from derive.ir.symbols import ROTATION_ENTRIES
from derive.report.reasons import rotation_texts
from tests.orthonormal import (
    Array,
    error,
    mirrored,
    random_rotations,
    repaired,
    rows,
    single,
    slightly_off,
    too_far_off,
)

SEEDS = st.integers(0, 2**32 - 1)
GARBAGE = (np.nan, np.inf, -np.inf, 1e300, -1e300, 1.1e9, 1e9, 0.0)
NUMBERS, LENGTH, ANGLE, HANDED = range(4)
"""The places of the reasons."""


def on_plain_numbers(matrix: Array) -> Array | None:
    found = made_rotation(rows(matrix))
    return None if isinstance(found, Diagnosis) else np.array(found)


def on_arrays(matrices: Array) -> tuple[Array, Array]:
    columns = tuple(tuple(matrices[:, i, k] for k in range(3)) for i in range(3))
    found, statuses = made_rotations(columns)
    return np.moveaxis(np.array(found), 2, 0), statuses


def in_the_reference(matrices: Array) -> tuple[Array, list[str]]:
    entries = dict(zip((r.name for r in ROTATION_ENTRIES), matrices.reshape(-1, 9).T, strict=True))
    found, statuses = run(rotation_program(), entries)
    return np.stack(list(found.values()), axis=1).reshape(-1, 3, 3), [status.name for status in statuses]


@settings(max_examples=20)
@given(seed=SEEDS)
def test_an_exact_rotation_is_used_bit_for_bit(seed: int) -> None:
    rotation = random_rotations(1, seed)[0]
    matrices = np.array(
        [rotation, rotation + 1e-13, rotation[:, [1, 2, 0]], np.eye(3)[[1, 2, 0]], np.diag([-1.0, 1.0, -1.0])]
    )
    assert all(error(matrix) < 0.9e-12 for matrix in matrices)
    assert all(made_rotation(rows(matrix)) == rows(matrix) for matrix in matrices)
    assert (on_arrays(matrices)[0] == matrices).all()
    assert (in_the_reference(matrices)[0] == matrices).all()


@pytest.mark.long
@settings(max_examples=20)
@given(seed=SEEDS)
def test_what_is_nearly_a_rotation_is_made_one(seed: int) -> None:
    """In all three as by NumPy; its z keeps its direction, and made again it stays as it is."""
    matrices = np.array(list(slightly_off(random_rotations(1, seed)[0])))
    batch, statuses = on_arrays(matrices)
    references, outcomes = in_the_reference(matrices)
    assert (statuses == Status.OK).all() and set(outcomes) == {"OK"}
    for matrix, row, reference in zip(matrices, batch, references, strict=True):
        assert 1e-12 < error(matrix) < 1e-4
        scalar = on_plain_numbers(matrix)
        assert scalar is not None
        for found in (scalar, reference, row):
            np.testing.assert_allclose(found, repaired(matrix), rtol=0, atol=1e-15)
            assert error(found) < 1e-15 and np.linalg.det(found) > 0
            assert np.abs(np.cross(found[:, 2], matrix[:, 2])).max() < 1e-15
            assert (on_plain_numbers(found) == found).all()


@given(seed=SEEDS, size=st.floats(1.1e-12, 0.9e-4))
def test_any_error_in_between(seed: int, size: float) -> None:
    """Noise in all entries: not farther from what was given than twice the error, which is as near as it can be."""
    rotation = random_rotations(1, seed)[0]
    noise = np.random.default_rng(seed + 1).uniform(-1.0, 1.0, (3, 3))
    matrix = rotation + noise * size / error(rotation + 1e-4 * noise) * 1e-4
    if 1e-12 < error(matrix) <= 1e-4:
        found = on_plain_numbers(matrix)
        assert found is not None and np.abs(found - matrix).max() < 2.0 * error(matrix)
        assert error(found) < 1e-15


@pytest.mark.long
@settings(max_examples=20)
@given(seed=SEEDS)
def test_what_is_no_rotation_is_refused_and_the_reason_has_the_amount(seed: int) -> None:
    rotation = random_rotations(1, seed)[0]
    texts = rotation_texts()
    wrong = [(m, None) for m in too_far_off(rotation)] + [(m, HANDED) for m in mirrored(rotation)]
    wrong += [
        (1.001 * rotation, LENGTH),
        (rotation @ [[1, 2e-4, 0], [0, 1, 0], [0, 0, 1]], ANGLE),
        (0.0 * rotation, LENGTH),
    ]
    for matrix, place in wrong:
        found = made_rotation(rows(matrix))
        assert isinstance(found, Diagnosis) and found.status is Status.BAD_INPUT
        product = np.abs(matrix.T @ matrix - np.eye(3))
        lengths, angles = product.diagonal().max(), (product - np.diag(product.diagonal())).max()
        expected = place if place is not None else LENGTH if lengths > 1e-4 else ANGLE
        amount = {LENGTH: lengths, ANGLE: angles}.get(expected, 0.0)
        assert found.reason == texts[expected]
        assert found.missing == pytest.approx(amount, rel=1e-9)
    matrices = np.array([m for m, _ in wrong])
    assert (on_arrays(matrices)[1] == Status.BAD_INPUT).all() and set(in_the_reference(matrices)[1]) == {"BAD_INPUT"}


def test_the_reason_in_words() -> None:
    matrix = np.eye(3) * np.sqrt(1.0021)
    refused = made_rotation(rows(matrix))
    assert isinstance(refused, Diagnosis)
    assert in_words(refused) == "columns not of length one by 0.0021; was the frame converted from REAL?"
    mirror = made_rotation(rows(-np.eye(3)))
    assert isinstance(mirror, Diagnosis) and in_words(mirror) == "not given: a right-handed frame"


@given(seed=SEEDS, place=st.integers(0, 8), value=st.sampled_from(GARBAGE) | st.floats())
def test_garbage_never_raises_and_harms_no_neighbour(seed: int, place: int, value: float) -> None:
    rotation = random_rotations(1, seed)[0]
    matrix = rotation.copy()
    matrix.flat[place] = value
    is_one = bool(np.isfinite(value)) and abs(value) < 10 and error(matrix) <= 1e-4
    assert (on_plain_numbers(matrix) is not None) == is_one
    near = single(rotation)
    with np.errstate(all="ignore"):
        batch, statuses = on_arrays(np.array([rotation, matrix, near]))
    assert statuses.tolist() == [Status.OK, Status.OK if is_one else Status.BAD_INPUT, Status.OK]
    assert (batch[0] == rotation).all() and np.abs(batch[2] - repaired(near)).max() < 1e-15


def test_one_rotation_for_all_rows() -> None:
    """What is the same in all rows may be a number."""
    found, statuses = made_rotations(rows(single(random_rotations(1, 1)[0])))
    assert statuses.shape == () and statuses == Status.OK
    np.testing.assert_allclose(
        np.array(found, dtype=float), repaired(single(random_rotations(1, 1)[0])), rtol=0, atol=1e-15
    )


OCTANT = np.sqrt(2.0) - 1.0
LAST_DIGIT = 2.0**-52


def test_the_last_digit() -> None:
    """From tiny angles to 22.5 degrees the polynomial misses by less than one unit of the last digit."""
    context = mp.clone()
    context.dps = 40
    even, odd = horner("zz")
    t = np.concatenate([np.linspace(1e-9, OCTANT, 2000), np.geomspace(1e-300, OCTANT, 500)])
    z = t * t
    p = eval(even, {"zz": z * z}) + z * eval(odd, {"zz": z * z})
    worst = max(abs(float(context.atan(a) - v)) / a for a, v in zip(t, t + t * z * p, strict=True))
    assert worst < LAST_DIGIT


def test_the_series() -> None:
    """The first coefficients are nearly those of the series: -1/3, 1/5, -1/7."""
    assert np.allclose(coefficients()[:3], [-1 / 3, 1 / 5, -1 / 7], rtol=0, atol=1e-9)
