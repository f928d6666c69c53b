"""Whether a commanded frame determines the axes of a pair, found by a fit and by no formula of the product."""

import numpy as np

from derive.description.mechanism import Turning
from tests.catalogue.coupling.parts import Part, frames

_MET = {Turning.NONE: (), Turning.ABOUT_Z: (), Turning.DIRECTION: (2,), Turning.FULL: (0, 1, 2)}
"""The columns of the commanded rotation that are met for every turn of the flange (a turn about z: see below)."""


def is_determined(carrier: Part, wrist: Part) -> bool:
    """Whether the vector from the flange to the end point is known before the position axes are.

    Directions that are fixed in the machine are known, and so are the columns of the rotation that are met. If the
    flange keeps its orientation, every direction is known. A rotation about z counts as unknown on a flange that turns,
    as documented for CODESYS's own kinematics (a C axis with an X or Y offset on a SCARA). A position kinematics that
    follows a rotation itself shares it with any axis behind it, and meets all of it where there is none: then the
    commanded rotation is that of the flange.
    """
    met = _MET[wrist.mechanism.task.turning]
    if carrier.mechanism.task.turning is not Turning.NONE:
        if wrist.mechanism.joints:
            return False
        met = _MET[Turning.FULL]
    rng = np.random.default_rng(5)
    count = 40
    first, second = carrier.draw(count, rng), rng.uniform(-170.0, 170.0, (count, len(wrist.mechanism.joints)))
    _, turns, ends, rotations = frames(carrier, first, wrist, second)
    if np.ptp(turns, axis=0).max() < 1e-12:
        return True
    shifts = np.einsum("nij,nj->ni", turns, ends)
    commanded = turns @ rotations
    fixed = np.tile(np.eye(3), (count, 1, 1))
    if np.ptp(turns[:, :, 2], axis=0).max() > 1e-12:
        fixed = np.zeros((count, 3, 0))  # the flange turns freely: no direction of it is the same for all axes
    features = np.concatenate([fixed, commanded[:, :, list(met)]], axis=2).reshape(3 * count, -1)
    wanted = shifts.reshape(-1)
    found = features @ np.linalg.lstsq(features, wanted, rcond=None)[0] if features.size else 0.0 * wanted
    return bool(np.max(np.abs(wanted - found)) < 1e-9)
