"""How often forward kinematics that starts at home finds a pose again, measured with nominal parameters."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from derive.description.mechanism import Turning
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import CHECK_FORWARD, branch_sign
from derive.kinematics.kinematics import Kinematics
from derive.plate.turning import poses_around_home

_DRAWN, _MOST, _SEED = 16384, 1024, 53
"""The poses that are drawn; of those that the inverse reaches, at most so many are measured."""
_RANGES = (0.5, 1.0)
"""The shares of the largest distance from home: a characteristic length, and a turn about each axis."""


def with_share(kin: Kinematics) -> Kinematics:
    """The kinematics with a note on the share, if forward kinematics starts at home."""
    if not kin.starts:
        return kin
    near, far = (_in_words(*found_again(kin, share)) for share in _RANGES)
    most = _largest_turn(kin)
    note = (
        f"Forward kinematics starts at the home pose. Measured with nominal parameters, it finds {near} of the poses "
        f"again that the inverse reaches within {most // 2} degrees of home about each axis and half the mean leg and "
        f"platform radius, and {far} within twice as much. The inverse refuses the others, because a controller that "
        f"asks for the pose at power-up would get another one; without {CHECK_FORWARD} it accepts them, for callers "
        "that give forward kinematics a start."
    )
    return replace(kin, mechanism=replace(kin.mechanism, notes=(*kin.mechanism.notes, note)))


def found_again(kin: Kinematics, share: float) -> tuple[int, int]:
    """Of poses around home: how many forward kinematics from home finds again, and how many the inverse reaches. share:
    of the largest distance from home.
    """
    given = {name: np.asarray(value) for name, value in kin.unlimited_values.items()}
    constants, _ = run(kin.setup, given)
    within = (share, float(np.radians(share * _largest_turn(kin))))
    poses = poses_around_home(kin.mechanism, {**given, **constants}, np.random.default_rng(_SEED), within, _DRAWN)
    signs = np.random.default_rng(_SEED + 1).choice([-1, 1], (len(kin.branches), _DRAWN))
    poses |= {branch_sign(b.name).name: column for b, column in zip(kin.branches, signs, strict=True)}
    constants |= {s.name: np.asarray(0) for j in kin.mechanism.joints for s in (j.reference, j.turn)}
    _, status = run(kin.branch, {**constants, **poses, CHECK_FORWARD: np.asarray(False)})
    reached = np.flatnonzero(status == Status.OK)[:_MOST]
    kept = {name: column[reached] for name, column in poses.items()}
    _, status = run(kin.branch, {**constants, **kept, CHECK_FORWARD: np.asarray(True)})
    return int((status == Status.OK).sum()), len(reached)


def _largest_turn(kin: Kinematics) -> int:
    """The largest turn from home in degrees."""
    return 90 if kin.mechanism.motion.turning is Turning.FULL else 180


def _in_words(found: int, count: int) -> str:
    """A share that every computer rounds alike."""
    share = round(100.0 * found / count) if count else 0
    return "all" if found == count else "more than 99 %" if share == 100 else f"{share} %"
