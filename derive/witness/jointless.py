"""A mechanism without joints: its one frame against the chain multiplied out."""

from __future__ import annotations

import numpy as np

from derive.ir.interpret import run
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.witness.checks import CLOSURE_TOLERANCE
from derive.witness.closure import POSE, Closure
from derive.witness.disagreement import Disagreement
from derive.witness.samples import SEED, random_machines


def check_jointless(kin: Kinematics, closure: Closure) -> tuple[int, float]:
    """Check the frame of every random machine. Returns the number of machines and the largest error."""
    values = random_machines(kin, np.random.default_rng(SEED))
    parameters = np.stack([values[name] for name in closure.parameters], axis=1)
    outputs, status = run(kin.forward, values)
    count = len(parameters)
    pose = np.stack([np.broadcast_to(outputs[name], count) for name in POSE], axis=1)
    expected = closure.frame(np.zeros((count, 0)), parameters)[:, :, 0]
    reach = np.maximum(np.abs(expected[:, :3]).max(axis=1, keepdims=True), np.finfo(float).tiny)
    unit = np.where(np.arange(len(POSE)) < 3, reach, 1.0)
    error = float(np.max(np.abs(pose - expected) / unit))
    if error > CLOSURE_TOLERANCE or np.any(status != Status.OK):
        raise Disagreement(f"the frame of a mechanism without joints: error {error:.1e}")
    return count, error
