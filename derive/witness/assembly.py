"""The assembly mode of a loop that turns its platform, from the closure alone: the sign of det A at the home pose.

At the home pose the closure is solved for the joints from many starts. The solution with the branches that the
parameters tell for home has the sign that every other pose of this machine must have.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.ir.interpret import Array
from derive.kinematics.kinematics import Kinematics
from derive.witness.closure import Closure
from derive.witness.disagreement import Disagreement
from derive.witness.home_samples import joints_at, measured_legs, on_guides, poses_at_home
from derive.witness.roots import STARTS
from derive.witness.samples import SEED, Samples, describe

_EASY = 3
"""Legs with two solutions each, of which `STARTS` starts find all; with each leg more it takes twice as many."""
_WITHOUT_BRANCHES = 20
"""Starts at home that are enough where `joints_at` starts again until positive quantities are positive."""
_CLOSED = 1e-9


def starts_for(mechanism: Mechanism) -> int:
    """The number of starts from which all solutions are sought."""
    if not mechanism.is_platform:
        return STARTS
    return int(STARTS * 2 ** max(0, len(mechanism.rods) - len(measured_legs(mechanism)) - _EASY))


def in_own_mode(
    kin: Kinematics, closure: Closure, samples: Samples, solutions: list[Array], units: Array
) -> list[NDArray[np.bool_]]:
    """Which solutions at each sample are in the assembly mode of the machine; all, where nothing iterates."""
    if not kin.mechanism.is_platform:
        return [np.ones(len(found), dtype=bool) for found in solutions]
    own: list[NDArray[np.bool_]] = []
    for row, found in enumerate(solutions):
        part = samples.take(np.full(len(found), row))
        sides = _sides(closure, found * units[row], part.pose, part.parameters)
        own.append(np.asarray(sides == _home_side(kin, closure, samples, row), dtype=bool))
    return own


def _sides(closure: Closure, joints: Array, pose: Array, parameters: Array) -> Array:
    if not len(joints):
        return np.zeros(0)
    return np.asarray(np.sign(np.linalg.det(closure.by_pose(joints, pose, parameters))))


def _home_side(kin: Kinematics, closure: Closure, samples: Samples, row: int) -> float:
    """The sign of det A at the home pose of the machine of a sample."""
    part = samples.take(np.full(starts_for(kin.mechanism) if kin.branches else _WITHOUT_BRANCHES, row))
    pose = on_guides(closure, poses_at_home(closure, part.values, part.reach), part.parameters)
    joints = joints_at(kin.mechanism, closure, pose, part.parameters, part.reach, np.random.default_rng(SEED + 5))
    state = (joints, pose, part.parameters)
    closed = np.abs(closure.residual(*state)[:, :, 0]).max(axis=1) < _CLOSED * part.reach**2
    closed &= np.all(closure.positive(*state)[:, :, 0] > 0, axis=1)
    indicators = closure.indicators(*state)[:, :, 0]
    for k, branch in enumerate(kin.branches):
        if branch.home_flag in part.values:
            closed &= indicators[:, k] * (1.0 - 2.0 * part.values[branch.home_flag]) > 0
    sides = np.unique(_sides(closure, joints, pose, part.parameters)[closed])
    if len(sides) != 1:
        raise Disagreement(f"the home pose has {len(sides)} assembly modes, {describe(kin, samples, row)}")
    return float(sides[0])
