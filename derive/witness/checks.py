"""The checks of the witness: each measures one derived program against the closure, and raises `Disagreement` if it
fails.

Errors are dimensionless: angles in radians, lengths in reaches of the machine.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array, run
from derive.ir.program import Program, Status
from derive.kinematics.kinematics import Kinematics
from derive.witness.closure import POSE, Closure
from derive.witness.disagreement import Disagreement
from derive.witness.samples import SEED, Samples, describe, moved_by_axes, solved_for_pose

CLOSURE_TOLERANCE = 1e-12
JACOBIAN_TOLERANCE = 1e-10
MARGIN_TOLERANCE = 1e-9
CLEAR = 0.05
"""The sign of a margin smaller than this is not checked; of one that is always small, smaller than this share."""


def worst(
    kin: Kinematics, what: str, errors: Array, samples: Samples, tolerance: float, ease: Array | None = None
) -> float:
    """The largest error, if all are within their tolerances.

    ease: how many times more rounding each pose shows, by its conditioning: errors are divided by it. What joints that
    were found leave open of the closure needs none: it has the same tolerance at every pose.
    """
    errors = np.where(np.isfinite(errors), errors, np.inf)
    eased = errors if ease is None else errors / ease
    row = int(np.argmax(eased))
    if eased[row] > tolerance:
        allowed = tolerance if ease is None else tolerance * float(ease[row])
        raise Disagreement(f"{what}: error {errors[row]:.1e}, allowed {allowed:.0e}, {describe(kin, samples, row)}")
    return float(np.max(errors))


def clear_of_zero(margin: Array, samples: Samples) -> NDArray[np.bool_]:
    """Where a margin is clear of zero, for a machine whose margins are as small as these."""
    largest = np.zeros(samples.machine.max(initial=0) + 1)
    np.maximum.at(largest, samples.machine, np.abs(margin))
    return np.asarray(np.abs(margin) > CLEAR * np.minimum(1.0, largest[samples.machine]), dtype=bool)


def run_regular(kin: Kinematics, program: Program, samples: Samples) -> dict[str, Array]:
    """The outputs of a program, which must accept every regular sample."""
    outputs, status = run(program, samples.values)
    refused = np.flatnonzero(np.broadcast_to(status != Status.OK, len(samples)))
    if len(refused):
        raise Disagreement(f"{program.name} refuses a regular pose: {describe(kin, samples, int(refused[0]))}")
    return outputs


def displacement(closure: Closure, samples: Samples, joints: Array) -> Array:
    """The distance by which the pose would have to move to close Φ at the joints: |A⁺ Φ|."""
    state = (joints, samples.pose, samples.parameters)
    scaled = closure.by_pose(*state) * closure.row_scale(samples.reach)[:, None, :]
    return np.asarray(np.linalg.norm((np.linalg.pinv(scaled) @ closure.residual(*state))[:, :, 0], axis=1))


def how_far(kin: Kinematics, samples: Samples, joints: Array) -> Array:
    """How many reaches the farthest slide of a solution is out, at least one: as many times more it is rounded.

    Two slides that are nearly parallel meet a pose far away.
    """
    slides = [k for k, j in enumerate(kin.mechanism.joints) if not j.is_angle]
    out = np.abs(joints[:, slides, ...]).reshape(len(joints), -1) / samples.reach[:, None]
    return np.asarray(np.maximum(1.0, np.max(out, axis=1, initial=0.0)))


def least_move(kin: Kinematics, closure: Closure, samples: Samples, joints: Array) -> Array:
    """The distance by which the pose, and in a loop the joints, would have to move to close Φ: |[A B]⁺ Φ|.

    Of the many solutions of a loop some are next to a type 2 singularity: there the pose alone would have to go far for
    what is the last digit of a joint.
    """
    if kin.mechanism.chain is not None:
        return displacement(closure, samples, joints)
    state = (joints, samples.pose, samples.parameters)
    by_pose = closure.by_pose(*state) * closure.row_scale(samples.reach)[:, None, :]
    by_joints = closure.by_joints(*state) * closure.joint_scale(samples.reach, joints, samples.parameters)[:, None, :]
    both = np.concatenate([by_pose, by_joints], axis=2)
    return np.asarray(np.linalg.norm((np.linalg.pinv(both) @ closure.residual(*state))[:, :, 0], axis=1))


def check_forward(kin: Kinematics, closure: Closure, samples: Samples) -> float:
    """Forward kinematics closes Φ and gives the whole frame; `orientation` gives the same rotation."""
    frame = closure.frame(samples.joints, samples.parameters)[:, :, 0]
    if kin.mechanism.is_platform:  # the closure holds the whole pose: any rotation may be right
        frame[:, 3:] = _nearest_rotations(samples.pose[:, 3:])
    position = (samples.pose[:, :3] - frame[:, :3]) / samples.reach[:, None]
    if kin.mechanism.chain is None:  # stated equations hold the position alone: `displacement` measures it
        position[:, ["xyz".index(c) for c in closure.coordinates]] = 0.0
    outputs = run_regular(kin, kin.orientation, samples)
    rotation = np.stack([outputs[name] for name in POSE[3:]], axis=1)
    parts = (
        displacement(closure, samples, samples.joints),
        np.max(np.abs(position), axis=1),
        np.max(np.abs(samples.pose[:, 3:] - frame[:, 3:]), axis=1),
        np.max(np.abs(rotation - frame[:, 3:]), axis=1),
    )
    return worst(kin, "forward kinematics", np.max(parts, axis=0), samples, CLOSURE_TOLERANCE, samples.pose_ease)


def _nearest_rotations(rows: Array) -> Array:
    left, _, right = np.linalg.svd(rows.reshape(-1, 3, 3))
    return np.asarray((left @ right).reshape(-1, 9))


def check_jacobian(kin: Kinematics, closure: Closure, samples: Samples) -> float:
    """The derived Jacobian equals that of the closure, entry by entry, relative to the largest entry of the row."""
    if kin.rows != closure.task:
        raise Disagreement(f"the Jacobian has the rows {kin.rows}, the task {closure.task}")
    outputs = run_regular(kin, kin.jacobian, samples)
    rows, columns = samples.jacobian.shape[1:]
    derived = np.stack(
        [np.stack([outputs[f"j{i + 1}{k + 1}"] for k in range(columns)], axis=1) for i in range(rows)], axis=1
    )
    sizes = np.max(np.abs(samples.jacobian), axis=2, keepdims=True)
    errors = np.max(np.abs(derived - samples.jacobian) / sizes, axis=(1, 2))
    return worst(kin, "Jacobian", errors, samples, JACOBIAN_TOLERANCE, samples.pose_ease)


def check_bias(kin: Kinematics, closure: Closure, samples: Samples) -> float:
    """The acceleration at constant speeds of the axes equals that of the closure, relative to its largest row.

    A further rate of A w + B q' = 0 is A w' + drift = 0.
    """
    speeds = np.random.default_rng(SEED + 4).uniform(-1.0, 1.0, samples.axes.shape)
    speeds *= closure.axis_scale(samples.reach) / closure.axis_scale(np.ones(len(samples)))
    named = {j.speed.name: speeds[:, i] for i, j in enumerate(kin.mechanism.joints)}
    outputs = run_regular(kin, kin.bias, replace(samples, values=samples.values | named))
    rates = (moved_by_axes(closure, samples) @ speeds[:, :, None])[:, :, 0]
    drift = closure.drift(samples.axes, samples.pose, samples.parameters, speeds, rates)
    units = closure.row_scale(samples.reach)[:, : len(closure.task)]
    expected = solved_for_pose(closure, samples, drift)[:, : len(closure.task), 0] / units
    derived = np.stack([outputs[o.name] for o in kin.bias.outputs], axis=1) / units
    sizes = np.maximum(1.0, np.max(np.abs(expected), axis=1, keepdims=True))
    errors = np.max(np.abs(derived - expected) / sizes, axis=1)
    return worst(kin, "acceleration at constant speeds", errors, samples, JACOBIAN_TOLERANCE, samples.pose_ease)


def check_margins(kin: Kinematics, closure: Closure, samples: Samples) -> float:
    """√det(J Jᵀ) is one constant of each machine times the margins with their exponents; their
    signs are the branches'.
    """
    check_signs(kin, closure, samples)
    outputs = run_regular(kin, kin.singularity, samples)
    expected = np.ones(len(samples))
    for margin in kin.margins:
        expected = expected * np.abs(outputs[margin.factor]) ** margin.exponent
    solved = samples.jacobian[:, :, closure.solved]
    volume = np.prod(np.linalg.svd(solved, compute_uv=False), axis=1)  # squaring J would lose half the digits
    ratio = volume / expected
    constant = {m: np.median(ratio[samples.machine == m]) for m in np.unique(samples.machine)}
    errors = np.abs(ratio / np.array([constant[m] for m in samples.machine]) - 1.0)
    return worst(
        kin, "singularity margins against det J", errors, samples, MARGIN_TOLERANCE, samples.ease * samples.pose_ease
    )


def check_signs(kin: Kinematics, closure: Closure, samples: Samples) -> None:
    """The signs of the margins of branches are those of their indicators."""
    indicators = closure.indicators(samples.joints, samples.pose, samples.parameters)[:, :, 0]
    for i, branch in enumerate(kin.branches):
        margin = samples.values[f"branch_{branch.name}"]
        differ: NDArray[np.bool_] = (margin * indicators[:, i] <= 0) & clear_of_zero(margin, samples)
        if differ.any():
            place = describe(kin, samples, int(np.argmax(differ)))
            raise Disagreement(f"branch {branch.name!r} has the opposite sign of its indicator {place}")
