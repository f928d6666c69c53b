"""Which deviations the samples determine: QR with pivoting on the scaled Jacobian, one group after the other.

What follows from deviations that come before it, or moves no sample, is held, and told with the combination that moves
the samples as it does.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
SCALES = {"deg": 0.1, "rad": 0.1, "u": 1.0, "1": 1e-3}
"""Deviations of a usual size, by unit: they make columns comparable."""
DEPENDENT = 1e-5
"""A column follows from others where the rest of it is at most this share of it."""
VAGUE = 30.0
"""A deviation is not determined where its standard deviation is larger than this many usual sizes."""
NAMED = 1e-3
"""The least share of a combination that is told."""


class Determined(NamedTuple):
    """What the samples determine."""

    kept: list[int]
    """The columns of what they determine, in their order."""
    held: dict[int, dict[int, float]]
    """By the column of what they do not determine: the columns that move the samples as it does, and how much of them;
    nothing for what moves no sample."""


def determined(jacobian: Array, groups: Sequence[int]) -> Determined:
    """What the samples determine. jacobian: residuals in standard deviations, columns by usual sizes.

    groups: the group of each column; those of a lower group are kept first. Raises ImportError without SciPy.
    """
    try:
        from scipy.linalg import qr
    except ImportError as error:
        raise ImportError("calibrate and propose need SciPy: pip install softkin[calibration]") from error
    kept: list[int] = []
    basis = np.zeros((len(jacobian), 0))
    for group in sorted(set(groups)):
        own = [k for k, g in enumerate(groups) if g == group]
        rest = jacobian[:, own]
        for _ in range(2):  # twice is enough for all digits
            rest = rest - basis @ (basis.T @ rest)
        q, r, order = qr(rest, mode="economic", pivoting=True)
        for k, place in enumerate(order[: len(r)]):
            size = abs(r[k, k])
            if size > DEPENDENT * np.linalg.norm(jacobian[:, own[place]]) and size * VAGUE > 1.0:
                kept.append(own[place])
                basis = np.concatenate([basis, q[:, k : k + 1]], axis=1)
    held: dict[int, dict[int, float]] = {}
    kept.sort()
    for k in range(len(groups)):
        if k not in kept:
            shares = np.linalg.lstsq(jacobian[:, kept], jacobian[:, k])[0] if kept else np.zeros(0)
            moves = np.linalg.norm(jacobian[:, k]) * VAGUE > 1.0
            held[k] = {i: float(s) for i, s in zip(kept, shares, strict=True) if moves and abs(s) > NAMED}
    return Determined(kept, held)
