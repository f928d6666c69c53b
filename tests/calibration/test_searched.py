"""A searched machine with deviations: next to where branches meet, the drawing may have a solution on another one."""

import numpy as np
import softkin

from tests.calibration.test_true_machine import lost
from tests.catalogue.search.planted import ARM


def test_a_pose_that_the_drawing_has_on_another_branch() -> None:
    """With deviations of 5 mrad and 5 mm: none of the poses is lost, whose wrist is almost spherical."""
    nominal, rng = softkin.Ac6RZRYRYRXRYRZJ6Offset(**ARM, j6_offset_x=1.0), np.random.default_rng(4)
    names = nominal.deviations
    sizes = {n: 5.0 if "shift" in n or n[-2:] in ("_x", "_y", "_z") and "tilt" not in n else 0.28 for n in names}
    given = {n: float(size * rng.uniform(-1.0, 1.0)) for n, size in sizes.items() if not n.endswith("gain")}
    poses = [tuple(row) for row in rng.uniform(-180.0, 180.0, (20, 6)).tolist()]
    assert lost(nominal.calibrated(given), poses) == []
