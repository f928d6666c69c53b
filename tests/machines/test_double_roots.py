"""Where solutions meet and where two lengths vanish together: no pose is lost, and every answer meets its pose."""

import numpy as np
import pytest
import softkin
from softkin import Status

from derive.description.validate import validate
from derive.frames import Ry, Rz, Ty, Tz
from derive.mechanism import Task, Turning, length, rotary
from derive.pipeline import Built, derive_and_measure, languages
from tests.catalogue.both_ways import missed
from tests.languages.language import Language
from tests.machines.made import Array, imported_class, made
from tests.machines.searched_machines import POINTS
from tests.machines.spoken import EVERY_OTHER, answered
from tests.machines.textbook import textbook

pytestmark = pytest.mark.slow

DECADES = (-1.0, -2.0, -2.7, -3.0, -3.5, -4.0, -5.0, -6.0, -8.0, -10.0, -12.0)
EVERY = pytest.mark.parametrize("name", POINTS)
SHIFTS = {"beside_1": 397.9, "beside_2": 94.6, "beside_3": 0.0, "reach_a": 247.1}
BESIDE_4 = dict(zip(POINTS, (66.7, 0.0), strict=True))


def poses(name: str) -> tuple[softkin.Mechanism, Array, Array]:
    """The machine, its axes next to a stretched elbow, and references far away."""
    rng = np.random.default_rng(21)
    signs = (1.0, -1.0)
    beside = [elbow + sign * 10.0**decade for decade in DECADES for elbow in (90.0, -90.0) for sign in signs]
    rows = np.array([(*rng.uniform(-180.0, 180.0, 2), elbow) for elbow in beside])
    robot = type(made(name).robot)(**SHIFTS, beside_4=BESIDE_4[name])
    return robot, rows, rng.uniform(-180.0, 180.0, rows.shape)


def are_met(robot: softkin.Mechanism, axes: Array, found: Array) -> bool:
    places, reached = (robot.forward_batch(rows)[0] for rows in (axes, found))
    return bool(np.abs(reached - places).max() < 1e-6)


@EVERY
def test_every_planted_pose_is_answered_on_its_branch(name: str) -> None:
    """One by one, and all at once."""
    robot, axes, references = poses(name)
    assert missed(robot, axes, references)[0] < 1e-6
    rows = zip(axes.tolist(), references.tolist(), strict=True)
    assert are_met(robot, axes, np.array([robot.inverse(*robot.forward(row), near) for row, near in rows]))


@EVERY
@EVERY_OTHER
def test_other_languages_answer_every_planted_pose(name: str, language: Language | None) -> None:
    robot, axes, references = poses(name)
    assert are_met(robot, axes, answered(language, made(name), robot, axes, references))


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
        for near in (axes, np.zeros_like(axes)):
            places, turns = missed(robot, axes, near)
            assert places / (sum(SIZES.values()) * unit) <= WITHIN and turns <= WITHIN


LEANING = "arm that rolls beside its elbow about an axis that leans"


@pytest.mark.parametrize("a2", (0.0, 180.0, 180.0 + 1e-9, -1e-7))
def test_a_fold_next_to_the_first_axis_is_no_end_of_reach(a2: float) -> None:
    """Where the first axis meets the one that leans is no short decimal: rounded, it moves the end of reach."""
    machine, a3 = made(LEANING), np.arange(-180.0, 180.0, 0.25)
    axes = np.stack([np.full_like(a3, 180.0), np.full_like(a3, a2), a3], axis=1) + machine.closure.offsets
    positions, rotations = machine.closure.poses(axes)
    beside = np.hypot(*positions[:, :2].T) > 1e-3 * machine.reach
    configurations = machine.robot.forward_batch(axes)[2]
    statuses = machine.robot.inverse_batch(positions, rotations, configurations, axes)[1]
    assert (statuses == Status.OK)[beside].all(), a3[beside & (statuses != Status.OK)].tolist()
