"""What is no input, in the place of numbers, rows and frames: for both cores."""

from array import array
from collections import UserList
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from math import inf, nan
from typing import Any

import numpy as np
from softkin import Frame


class Other(float):
    """A number that pretends to be another one."""

    def __float__(self) -> float:
        return 7.0


class Row(tuple[Any, ...]):
    """A tuple that says something else when it is asked for its parts."""

    def __iter__(self) -> Iterator[Any]:
        return iter((1.0,) * len(tuple.__getitem__(self, slice(None))))


class OwnFrame(Frame):
    """A frame of a caller's own class."""


class Rude:
    """Every look at it is an error."""

    def __getattribute__(self, name: str) -> Any:
        raise RuntimeError("rude")


HUGE = 10**400
NUMBERS: tuple[Any, ...] = (
    nan, inf, -inf, 1e300, 1.1e9, -0.0, True, 3, HUGE, -HUGE, None, "1", b"1", 1j, Other(2.0), np.float32(2.5),
    np.float64(2.5), np.int64(3), np.array(2.0), np.array([1.0, 2.0]), Decimal("1.5"), Fraction(1, 3), [1.0], {},
    object(),
)  # fmt: skip
"""In the place of a number."""


def rows(count: int) -> list[Any]:
    """In the place of a row of numbers."""
    good = (1.0,) * count
    wrong = [(*good[:i], number, *good[i + 1 :]) for number in NUMBERS for i in {0, count - 1} if count]
    return [
        *wrong, *(list(row) for row in wrong[:6]), good[:-1], (*good, 1.0), (), None, 5, "12", b"1" * count, {1.0},
        {1.0: 2.0}, array("d", good), array("f", good), range(count), UserList(good), Row(good), np.array(good),
        np.array(good, np.float32), np.array(good, complex), np.array(good, int), np.array([good]),
        np.ma.masked_array(good, mask=[True] * count), np.array(good, object), np.asarray(good, ">f8"),
        memoryview(array("d", good)), Rude,
    ]  # fmt: skip


def frames() -> list[Any]:
    """In the place of a frame."""
    eye = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    place = (200.0, 30.0, 40.0)
    matrix = np.eye(4)
    ragged, rounded = matrix.tolist(), matrix.copy()
    ragged[1] = ragged[1][:3]
    rounded[3, 0] = 1e-10
    wrong = rounded.copy()
    wrong[3, 3] = nan
    return [
        *((row, eye) for row in rows(3)),
        *((place, (eye[0], row, eye[2])) for row in rows(3)),
        *((place, row) for row in rows(3)),
        None,
        (),
        (place,),
        (place, eye, 1),
        [place, eye],
        eye,
        Frame(place, eye),
        OwnFrame(place, eye),
        Row((place, eye)),
        matrix,
        ragged,
        rounded,
        wrong,
        matrix[:3],
        matrix.astype(np.float32),
        np.ma.masked_array(matrix),
        matrix.astype(complex),
        matrix.tolist(),
        {"position": place},
        "frame",
        7,
        (place, (eye[0], eye[1])),
        (place, ((0.0,) * 3,) * 3),
        (place, tuple(tuple(1.01 * v for v in row) for row in eye)),
        (place, tuple(tuple(-v for v in row) for row in eye)),
    ]
