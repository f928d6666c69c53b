"""Long continuous motions of a machine, away from its singularities."""

from functools import cache

import numpy as np

from tests.catalogue.closure import Array
from tests.catalogue.loci import Locus, loci
from tests.catalogue.machines import Machine

BEND, BEND_OF_SEVERAL = 0.8, 0.5
"""How far an elbow bends along the way, as a share of the arc on which it neither stretches nor folds."""
BENT_A_LITTLE = -0.7
VENDOR = 60.0
"""Degrees or lengths that axes start inside of the vendor's ranges."""
LEAST_WAY = 12.0
"""Degrees or lengths that every axis can go from the start, either way."""


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
    bending = _bending(machine)
    bend = BEND if len(bending) == 1 else BEND_OF_SEVERAL
    for k, locus in enumerate(bending):
        axes = locus.within(axes, bend * np.sin((6 + 2 * k) * np.pi * time), turns)
    return axes


@cache
def start(machine: Machine) -> Array:
    """Axis values on the first turn, every elbow bent a little, from which every axis can go some way."""
    axes = machine.draw(1000, np.random.default_rng(12), farthest=100.0)
    for i, joint in enumerate(machine.mechanism.joints):
        low, high = joint.limit_range or (-1e9, 1e9)
        axes = axes[(axes[:, i] > low + VENDOR) & (axes[:, i] < high - VENDOR)]
    for locus in _bending(machine):
        axes = locus.within(axes[locus.exists(axes)], BENT_A_LITTLE)
    free = np.ones(len(axes), dtype=bool)
    for i in range(axes.shape[1]):
        for shift in np.linspace(-LEAST_WAY, LEAST_WAY, 5):
            free &= machine.is_regular(axes + shift * np.eye(axes.shape[1])[i])
    found = axes[free][0]
    found.flags.writeable = False  # as for `straight`
    return found


def _bending(machine: Machine) -> list[Locus]:
    """One locus a branch, those that the fewest joints decide first: what is set later leaves them alone."""
    first = [locus for locus in loci(machine) if locus.branch is not None and not locus.second]
    return sorted(first, key=lambda locus: locus.joints)


@cache
def straight(machine: Machine, axis: int, steps: int, far: float = 400.0) -> Array:
    """From the start with one axis some way (degrees or lengths), as far as the way is regular."""
    axes = np.repeat(start(machine)[None], steps, axis=0)
    axes[:, axis] += np.linspace(0.0, far, steps)
    regular = machine.is_regular(axes)
    axes.flags.writeable = False  # all who ask for this motion get the same array
    return axes if regular.all() else axes[: int(regular.argmin())]
