"""Rotations, matrices that are rotations but for an error, and the rotation that is meant: by NumPy, by definition."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.random import Generator
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
ALLOWED, REFUSED = 0.9e-4, 1.1e-4
"""Errors on both sides of what is a rotation."""


def rodrigues(axis: ArrayLike, angle: ArrayLike) -> Array:
    """The rotation about a unit vector by an angle in radians; of rows of vectors or angles one each."""
    cross, angles = np.cross(np.eye(3), np.asarray(axis)[..., None, :]), np.asarray(angle)[..., None, None]
    return np.asarray(np.eye(3) + np.sin(angles) * cross + 2.0 * np.sin(angles / 2.0) ** 2 * (cross @ cross))


def turned(axis: int, angle: ArrayLike) -> Array:
    """The rotation about a coordinate axis by an angle in radians, or by each of many."""
    return rodrigues(np.eye(3)[axis], angle)


def about(axis: int, degrees: float) -> Array:
    """The rotation about a coordinate axis."""
    return turned(axis, np.radians(degrees))


def swings(first: Array, second: Array) -> Array:
    """The smallest rotations that take unit vectors to others, row by row."""
    cross, agree = np.cross(np.eye(3), np.cross(first, second)[..., None, :]), np.sum(first * second, axis=-1)
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + agree)[..., None, None])


def random_rotations(count: int, seed: int | Generator) -> Array:
    """Any rotations, evenly: from the columns of random matrices."""
    matrices, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(count, 3, 3)))
    return np.asarray(matrices * np.linalg.det(matrices)[:, None, None])


def rows(matrix: Array) -> tuple[tuple[float, ...], ...]:
    return tuple(map(tuple, matrix.tolist()))


def error(matrix: Array) -> float:
    """The largest entry of |R^T R - I|."""
    return float(np.abs(matrix.T @ matrix - np.eye(3)).max())


def repaired(matrix: Array) -> Array:
    """The direction of z, what of x is perpendicular to it, and what is perpendicular to both: each of length one."""
    z = matrix[:, 2] / np.linalg.norm(matrix[:, 2])
    x = matrix[:, 0] - (matrix[:, 0] @ z) * z
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def single(matrix: Array) -> Array:
    return matrix.astype(np.float32).astype(np.float64)


def slightly_off(rotation: Array) -> Iterator[Array]:
    """Rotations that are accepted and repaired: as REAL, and off by 0.9e-4 in every way."""
    yield single(rotation)
    yield from _off(rotation, ALLOWED)


def too_far_off(rotation: Array) -> Iterator[Array]:
    """The same beyond what is accepted."""
    yield from _off(rotation, REFUSED)


def mirrored(rotation: Array) -> Iterator[Array]:
    """Left-handed."""
    yield -rotation
    for k in range(3):
        yield rotation @ np.diag([-1.0 if k == i else 1.0 for i in range(3)])
    yield rotation[:, [1, 0, 2]]


def _off(rotation: Array, size: float) -> Iterator[Array]:
    """Longer and shorter columns, and columns that lean towards each other, so that the largest
    error is of that size.
    """
    for k in range(3):
        for sign in (1.0, -1.0):
            factors = np.ones(3)
            factors[k] = np.sqrt(1.0 + sign * size)
            yield rotation @ np.diag(factors)
    for sign in (1.0, -1.0):
        yield rotation * np.sqrt(1.0 + sign * size)
        for i, j in combinations(range(3), 2):
            for leaning, other in ((i, j), (j, i)):
                matrix = rotation.copy()
                matrix[:, leaning] = np.sqrt(1.0 - size**2) * rotation[:, leaning] + sign * size * rotation[:, other]
                yield matrix
