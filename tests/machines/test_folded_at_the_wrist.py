"""An arm that folds its elbow onto its shoulder, beside the wrist: an answer there meets its pose, or there is none.

Two lengths of a step vanish together: the arm that A6 turns, and the way to its target. The rounding of their squares
is then larger than the lengths: one of them was exactly zero, so that cosine and sine were both zero, and every 13th
pose was answered with a rotation of another pose, and with the status OK.
"""

import numpy as np
import pytest
from softkin import Status

from derive.description.validate import validate
from derive.frames import Ry, Rz, Ty, Tz
from derive.mechanism import Task, Turning, length, rotary
from derive.pipeline import Built, derive_and_measure, languages
from tests.machines.made import imported_class
from tests.machines.textbook import textbook

pytestmark = pytest.mark.slow

A1, A2, A3, A4, A5, A6 = JOINTS = tuple(rotary(f"A{k}", f"turn A{k}") for k in range(1, 7))
LINK, BESIDE = length("link", "upper arm and forearm", nominal=300.0), length("beside", "wrist, tool", nominal=100.0)
ARM = textbook(
    (*JOINTS, LINK, BESIDE),
    "FoldedAtTheWrist",
    Rz(A1) * Ry(A2) * Rz(A3) * Tz(LINK) * Ry(A4) * Tz(LINK) * Ty(BESIDE) * Rz(A5) * Ry(A6) * Tz(BESIDE),
    Task("xyz", Turning.FULL),
)
SIZES = {"link": 300.0, "beside": 100.0}
WITHIN, COUNT = 1e-11, 1000


def test_an_answer_meets_its_pose() -> None:
    """In millimetres and metres, with the pose itself and with zero as the reference."""
    mechanism = validate(ARM)
    whole = derive_and_measure(mechanism)
    (python,) = languages(wanted=("python",))
    made = imported_class(mechanism, Built("", "", None, {"python": python.part(whole)}, {}, whole.evidence))
    rng = np.random.default_rng(41)
    beside = rng.choice([-1.0, 0.0, 1.0], (COUNT, 6)) * 10.0 ** -rng.integers(5, 13, (COUNT, 6))
    axes = 90.0 * rng.integers(-2, 3, (COUNT, 6)) + beside
    axes[:, 3] = 180.0 + beside[:, 3]
    axes[:, 4] = rng.choice([0.0, 180.0], COUNT) + beside[:, 4]
    for unit in (1.0, 1e-3):
        robot = made(**{name: size * unit for name, size in SIZES.items()})
        positions, rotations, configurations, _ = robot.forward_batch(axes)
        for near in (axes, np.zeros_like(axes)):
            found, statuses = robot.inverse_batch(positions, rotations, configurations, near)
            assert (statuses == Status.OK).all()
            again, turned = robot.forward_batch(found)[:2]
            assert np.abs(again - positions).max() / (sum(SIZES.values()) * unit) <= WITHIN
            assert np.abs(turned - rotations).max() <= WITHIN
