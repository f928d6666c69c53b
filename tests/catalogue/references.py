"""The references of calls: what is held stays where the pose has it, everything else is as far away as a test likes."""

import numpy as np
import softkin
from numpy.typing import ArrayLike

from tests.catalogue.closure import Array


def held_at(robot: softkin.Mechanism, axes: ArrayLike, references: ArrayLike | None = None) -> Array | None:
    """References for poses: those given or none; a held joint keeps its value, else none leads back."""
    if not robot.HELD:
        return None if references is None else np.asarray(references, dtype=float)
    there = np.asarray(axes, dtype=float)
    found = np.array(np.broadcast_to(0.0 if references is None else references, there.shape), dtype=float)
    found[..., list(robot.HELD)] = there[..., list(robot.HELD)]
    return found
