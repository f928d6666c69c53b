"""Long continuous motions of a machine, away from its singularities."""

from __future__ import annotations

import numpy as np

from tests.mechanisms.closure import Array
from tests.mechanisms.loci import loci
from tests.mechanisms.machines import Machine

BEND = (0.3, 2.8)
"""How far (radians) an elbow bends along the way: it neither stretches nor folds."""


def tour(machine: Machine, steps: int, turns: int = 0) -> Array:
    """Axis values: turning axes go forward and back over several turns, everything else swings.

    `turns`: on which turn an elbow bends, which cannot turn through without changing its branch.
    """
    time = np.linspace(0.0, 1.0, steps)
    columns = []
    for i, joint in enumerate(machine.mechanism.joints):
        swing = np.sin(2 * np.pi * time * (i + 1) + 0.3 * i)
        if joint.multi_turn:
            size = 700.0 if joint.pitch != 0 else 900.0
            columns.append(size * np.sin(2 * np.pi * time + 0.8 * i))
        elif joint.domain is not None:
            columns.append((90.0 + 70.0 * swing) if joint.is_angle else machine.reach * (0.6 + 0.3 * swing))
            columns[-1] = columns[-1] + machine.closure.offsets[i]
        else:
            columns.append(machine.reach * 0.4 * swing)
    axes = np.stack(columns, axis=1)
    bend = np.mean(BEND) + np.ptp(BEND) / 2 * np.sin(6 * np.pi * time) + 2 * np.pi * turns
    for locus in loci(machine):
        if locus.branch is not None and locus.target == 0.0:
            axes = locus.moved(axes, bend)
    return axes


def start(machine: Machine) -> Array:
    """Axis values on the first turn, the elbow bent a little."""
    axes = machine.draw(4000, np.random.default_rng(12))
    turning = [i for i, j in enumerate(machine.mechanism.joints) if j.multi_turn]
    axes = axes[np.abs(axes[:, turning]).max(axis=1, initial=0.0) < 100.0]
    for locus in loci(machine):
        if locus.branch is not None and locus.target == 0.0:
            axes = locus.moved(axes, 0.5)
    return axes[0]


def straight(machine: Machine, axis: int, steps: int, far: float = 400.0) -> Array:
    """From the start with one axis some way (degrees or lengths), as far as the way is regular."""
    axes = np.repeat(start(machine)[None], steps, axis=0)
    axes[:, axis] += np.linspace(0.0, far, steps)
    regular = machine.is_regular(axes)
    return axes if regular.all() else axes[: int(regular.argmin())]
