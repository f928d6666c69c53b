"""Poses of random machines, by which decisions about a search are made."""

from __future__ import annotations

import numpy as np

from derive.description.mechanism import Mechanism
from derive.equations.axes import Forward, reference_value
from derive.ir.interpret import Array, run
from derive.ir.passes import normalise
from derive.ir.program import Output
from derive.ir.symbols import real
from derive.kinematics.sampling import sample_axes, sample_machine
from derive.kinematics.search.programs import GOAL

MACHINES = 6


def samples_of(mechanism: Mechanism, forward: Forward, poses: int = 1, held: float | None = None) -> dict[str, Array]:
    """Machines, each with some poses: their inputs, the pose in the names of the search, and the joints there.

    held: the angle (degrees) of joints that are held and turn, where it is given.
    """
    names = [*(real(c) for c in "xyz"), *forward.rotation, *(j.symbol for j in mechanism.joints)]
    program = normalise("pose", forward.statements, [Output(n.name, n) for n in names])
    rows: list[dict[str, Array]] = []
    for seed in range(61, 61 + MACHINES):
        machine = sample_machine(mechanism, seed)
        axes = sample_axes(mechanism, machine, poses, seed)
        for j in mechanism.held_joints if held is not None else ():
            if j.is_angle and j.axis_is_angle:
                axes[j.axis.name] = np.full(poses, held) + machine[j.offset.name]
        found, _ = run(program, {**machine, **axes})
        goal = {GOAL[real(n)].name: v for n, v in found.items() if real(n) in GOAL}
        joints = {j.symbol.name: found[j.symbol.name] for j in mechanism.joints}
        references = {reference_value(j).name: found[j.symbol.name] for j in mechanism.joints}
        rows.append({**machine, **axes, **references, **joints, **goal})
    return {n: np.concatenate([np.broadcast_to(np.ravel(row[n]), poses) for row in rows]) for n in rows[0]}
