"""Poses close to where branches of a root search meet: a joint is moved until the indicator of a branch is nearly 0.

Of every machine and every branch, on all decades of distance, with references far away: how many have no answer on
their own branch. Random poses never come there, but robots stand there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array, run
from derive.ir.program import Status
from derive.ir.symbols import branch_sign
from derive.kinematics.kinematics import Kinematics
from derive.witness.closure import POSE, Closure
from derive.witness.samples import SEED, Samples

_TRIED = 24
"""Values of a joint between which an indicator may change its sign."""
_HALVED = 60
_DECADES = 12
_FREE = 1e-11
"""Branches with a smaller margin coincide: both bytes are right."""


def refused_when_planted(kin: Kinematics, closure: Closure, samples: Samples) -> tuple[int, int]:
    """The number of these poses that are refused on their own branch, and the number of all."""
    rng = np.random.default_rng(SEED + 7)
    rows = [
        r
        for b in range(len(kin.branches))
        for j in range(samples.axes.shape[1])
        for r in _near(closure, samples, b, j, rng)
    ]
    if not rows:
        return 0, 0
    index, axes = np.array([k for k, _ in rows]), np.array([a for _, a in rows])
    planted = replace(samples.take(index), axes=axes)
    values = planted.values | {joint.axis.name: axes[:, i] for i, joint in enumerate(kin.mechanism.joints)}
    outputs, _ = run(kin.forward, values)
    values |= {name: outputs[name] for name in POSE}
    for i, joint in enumerate(kin.mechanism.joints):
        keeps = joint in kin.mechanism.held_joints or not joint.is_angle
        values[joint.reference.name] = axes[:, i] if keeps else rng.uniform(-180.0, 180.0, len(axes))
    values |= {joint.turn.name: np.zeros(len(axes)) for joint in kin.period_joints}
    margins = np.stack([outputs[f"branch_{b.name}"] for b in kin.branches])
    return _refused(kin, values, margins)


def _refused(kin: Kinematics, values: dict[str, Array], margins: Array) -> tuple[int, int]:
    """The number of rows that no side answers, and of all. margins: of every branch by rows. Where one branch meets
    the next one, either side may answer; where several do, no row is asked.

    Both sides stand in one run: a root search takes as many passes for one row as for all.
    """
    meets = np.abs(margins) < _FREE
    asked = np.flatnonzero(meets.sum(axis=0) < 2)
    rows = np.concatenate([asked, asked[meets[:, asked].any(axis=0)]])
    side = np.where(np.arange(len(rows)) < len(asked), 1.0, -1.0)
    signs = np.where(meets[:, rows], side, np.where(margins[:, rows] > 0, 1.0, -1.0))
    chosen = {branch_sign(b.name).name: own for b, own in zip(kin.branches, signs, strict=True)}
    status = run(kin.branch, {name: column[rows] for name, column in values.items()} | chosen)[1]
    answered = np.unique(rows[status == Status.OK])
    return len(asked) - len(answered), len(asked)


def _near(
    closure: Closure, samples: Samples, branch: int, joint: int, rng: np.random.Generator
) -> list[tuple[int, Array]]:
    """For every machine the joint where the indicator vanishes, on both sides of it, and a distance away."""
    found: list[tuple[int, Array]] = []
    first = np.unique(samples.machine, return_index=True)[1]
    part = samples.take(first)
    around = np.linspace(-180.0, 180.0, _TRIED)
    before = _indicator(closure, part, branch, joint, np.full(len(part), around[0]))
    for low, high in zip(around[:-1], around[1:], strict=True):
        after = _indicator(closure, part, branch, joint, np.full(len(part), high))
        turned = np.flatnonzero(before * after < 0.0)
        for k, value in zip(turned, _vanishing(closure, part, branch, joint, (turned, low, high, before)), strict=True):
            for decade in range(0, _DECADES + 1, 3):
                axes = part.axes[k].copy()
                axes[joint] = value + 10.0**-decade * rng.choice([-1.0, 1.0])
                found.append((int(first[k]), axes))
        before = after
    return found


def _vanishing(
    closure: Closure, part: Samples, branch: int, joint: int, between: tuple[NDArray[np.intp], float, float, Array]
) -> Array:
    """The value of the joint at which the indicator vanishes. between: for some rows two values on either side, and the
    indicators at the first.
    """
    turned, low, high, before = between
    first, last = (np.full(len(turned), end) for end in (low, high))
    for _ in range(_HALVED if len(turned) else 0):
        middle = 0.5 * (first + last)
        same = _indicator(closure, part.take(turned), branch, joint, middle) * before[turned] > 0.0
        first, last = np.where(same, middle, first), np.where(same, last, middle)
    return first


def _indicator(closure: Closure, samples: Samples, branch: int, joint: int, value: Array) -> Array:
    axes = samples.axes.copy()
    axes[:, joint] = value
    joints = closure.joints(axes, samples.parameters)[:, :, 0]
    return np.asarray(closure.indicators(joints, samples.pose, samples.parameters)[:, branch, 0])
