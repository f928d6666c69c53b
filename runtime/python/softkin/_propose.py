"""Which poses to measure: those from which the deviations are known best."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from softkin._calibrate import _chosen
from softkin._calibrated import Calibrated, bare_of
from softkin._core import Mechanism
from softkin._deviations import units_of
from softkin._identification import SCALES, determined
from softkin._samples import SIGMAS, Samples, measured, refused
from softkin._sensitivity import model
from softkin._types import Reals

Array: TypeAlias = NDArray[np.float64]
_REGULAR = 0.1
"""The least margin of a pose."""
_TRIED, _PASSES = 400, 20
"""The poses from which is chosen, and the most passes of exchanges."""
_LITTLE = 1e-6
"""Information that is there before the first sample, so that a determinant is not zero."""


def propose(
    robot: Mechanism, count: int, *, parameters: Iterable[str] | None = None, rotations: bool = True,
    samples: Samples | None = None, seed: int = 0,
) -> list[Reals]:  # fmt: skip
    """Poses to measure, so that the deviations are known best: the axes of each, inside the limits.

    They are chosen from random regular poses so that the determinant of the information is large (D-optimal): first one
    after the other, then by exchanges. An axis without limits is taken from -170 to 170 degrees; a linear one needs
    limits. rotations: whether rotations are measured, or points alone. samples: those that are there already.
    samples, parameters: as in `calibrate`. Needs SciPy: softkin[calibration]. Raises BAD_INPUT if limits are missing.
    """
    given = robot.in_degrees()
    nominal = given.nominal if isinstance(given, Calibrated) else given
    start = {name: value for name, value in given.deviations.items() if value}
    names, groups = _chosen(nominal, parameters)
    units = units_of(bare_of(nominal))
    sizes = np.array([SCALES[units[name]] for name in names])
    pool = _poses(given, np.random.default_rng(seed))
    before = np.zeros((0, len(given.AXES))) if samples is None else measured(robot, samples).axes
    moved = model(nominal, start, names, np.concatenate([pool, before])).twists * sizes
    moved[:, :3] /= SIGMAS["sigma_x"]
    moved[:, 3:] /= np.radians(SIGMAS["sigma_rotation"])
    rows = moved if rotations else moved[:, :3]
    kept = determined(rows.reshape(-1, len(names)), groups).kept
    rows = rows[:, :, kept]
    known = np.eye(len(kept)) * _LITTLE + np.einsum("nik,nil->kl", rows[len(pool) :], rows[len(pool) :])
    chosen = _exchanged(rows[: len(pool)], known, min(count, len(pool)))
    unit = np.array([np.radians(1.0) if axis.unit == "rad" else 1.0 for axis in robot.AXES])
    return [tuple((pool[k] * unit).tolist()) for k in chosen]


def _exchanged(rows: Array, known: Array, count: int) -> list[int]:
    """The poses of the largest determinant that is found: chosen in turn, then each replaced by a better one."""
    chosen: list[int] = []
    for _ in range(count):
        best = int(np.argmax(_gains(rows, known, chosen)))
        chosen.append(best)
        known = known + rows[best].T @ rows[best]
    for _ in range(_PASSES):
        is_better = False
        for place, old in enumerate(chosen):
            rest = known - rows[old].T @ rows[old]
            others = [k for i, k in enumerate(chosen) if i != place]
            gains = _gains(rows, rest, others)
            new = int(np.argmax(gains))
            if gains[new] > gains[old] * (1.0 + 1e-9):
                chosen[place], known, is_better = new, rest + rows[new].T @ rows[new], True
        if not is_better:
            break
    return chosen


def _gains(rows: Array, known: Array, taken: Sequence[int]) -> Array:
    """By which factor each pose multiplies the determinant; 0 for one that is taken."""
    spread = np.linalg.solve(known, rows.transpose(2, 0, 1).reshape(len(known), -1)).reshape(len(known), len(rows), -1)
    share = np.einsum("nik,knj->nij", rows, spread)
    gains: Array = np.linalg.det(np.eye(rows.shape[1]) + share)
    gains[list(taken)] = 0.0
    return gains


def _poses(robot: Mechanism, rng: np.random.Generator) -> Array:
    """Random regular poses inside the limits."""
    ends = []
    for axis in robot.AXES:
        lower, upper = robot.limits.get(axis.name) or (None, None)
        if axis.unit == "u" and (lower is None or upper is None):
            raise refused(f"poses of {robot.NAME} are proposed inside limits: give those of {axis.name}")
        ends.append((-170.0 if lower is None else lower, 170.0 if upper is None else upper))
    low, high = np.array(ends).T
    drawn = rng.uniform(low, high, (4 * _TRIED, len(ends)))
    _, margins = robot.singularity_batch(drawn)
    is_regular = np.isfinite(robot.forward_batch(drawn)[0]).all(axis=1)
    if margins.shape[1]:
        is_regular &= np.abs(margins).min(axis=1) > _REGULAR
    if not is_regular.any():
        raise refused(f"no regular pose of {robot.NAME} was found inside its limits")
    found: Array = drawn[is_regular][:_TRIED]
    return found
