"""All solutions of a searched arm, one after the other: the next one ahead around the circle, as `inverse_all` asks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array, run
from derive.ir.program import Status
from derive.ir.symbols import branch_sign
from derive.kinematics.kinematics import Kinematics
from derive.witness.samples import Samples

_BEGIN = 2.6
"""How far ahead of the reference (radians) the way around begins."""
_MOST = 24
"""More solutions than an arm has."""


def every_root(kin: Kinematics, samples: Samples, commands: Mapping[str, Array]) -> tuple[Array, NDArray[np.bool_]]:
    """Axis values (solutions, samples, axes), and whether there is such a solution. All sides are asked for at once."""
    assert kin.search_given is not None and kin.from_joints is not None
    find = next(program for program in kin.shared if program.name == "find_root")
    values = samples.values | dict(commands) | {branch_sign(b.name).name: np.zeros(len(samples)) for b in kin.branches}
    given, _ = run(kin.search_given, values)
    at = given["start"] + _BEGIN
    left = np.full(len(samples), 2.0 * np.pi - 1e-7)
    going = np.ones(len(samples), dtype=bool)
    axes, answers = [], []
    for number in range(_MOST):
        found, _ = run(find, {**values, **given, "start": at, "onward": np.ones(len(samples), dtype=bool)})
        left = left - np.where(number > 0, found["away"], 0.0)
        going &= found["found"].astype(bool) & (left > 0.0)
        if not going.any():
            break
        at = at + found["away"]
        joints = {j.symbol.name: found[f"found_{j.symbol.name}"] for j in kin.mechanism.joints}
        outputs, status = run(kin.from_joints, {**values, **joints})
        axes.append(np.stack([outputs[j.axis.name] for j in kin.mechanism.joints], axis=1))
        answers.append(going & (status == Status.OK))
    if not axes:
        return np.zeros((1, len(samples), len(kin.mechanism.joints))), np.zeros((1, len(samples)), dtype=bool)
    return np.stack(axes), np.stack(answers)
