"""Where two solutions of a search nearly meet just where its branches do: none is lost, in any language.

With some shifts zero, the residual depends on the elbow by its cosine alone: next to a stretched elbow it has two roots
whose joints agree in all digits but the last, one on each side. The second arm also leaves an axis nearly free there.
"""

from collections.abc import Sequence

import numpy as np
import pytest
import softkin

from tests.machines.made import Array, made
from tests.machines.searched_machines import POINTS
from tests.machines.spoken import asked_in
from tests.text.controller import OK

pytestmark = pytest.mark.slow

ZERO = dict(zip(POINTS, (("beside_3",), ("beside_3", "beside_4")), strict=True))
DECADES = (-1.0, -2.0, -2.7, -3.0, -3.5, -4.0, -5.0, -6.0, -8.0, -10.0, -12.0)
EVERY = pytest.mark.parametrize("name", POINTS)


def parameters(name: str) -> dict[str, float]:
    return {"beside_1": 397.9, "beside_2": 94.6, "beside_3": 63.1, "beside_4": 66.7, "reach_a": 247.1} | dict.fromkeys(
        ZERO[name], 0.0
    )


def poses(name: str) -> tuple[softkin.Mechanism, Array, Array]:
    """The machine, its axes next to a stretched elbow, and references far away."""
    rng = np.random.default_rng(21)
    rows = [
        (*rng.uniform(-180.0, 180.0, 2), elbow + sign * 10.0**decade)
        for decade in DECADES
        for elbow in (90.0, -90.0)
        for sign in (1.0, -1.0)
    ]
    robot = type(made(name).robot)(**parameters(name))
    return robot, np.array(rows), rng.uniform(-180.0, 180.0, (len(rows), 3))


def is_met(robot: softkin.Mechanism, axes: Sequence[float], frame: softkin.Frame) -> bool:
    return bool(np.abs(np.subtract(robot.forward(tuple(axes))[0].position, frame.position)).max() < 1e-6)


@EVERY
def test_every_planted_pose_is_answered_on_its_branch(name: str) -> None:
    """One by one, and all at once."""
    robot, axes, references = poses(name)
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_batch(positions, rotations, configurations, references)
    assert (statuses == softkin.Status.OK).all(), axes[statuses != softkin.Status.OK].tolist()
    for row, reference, all_at_once in zip(axes, references, found, strict=True):
        frame, configuration = robot.forward(tuple(row))
        assert is_met(robot, robot.inverse(frame, configuration, tuple(reference)), frame)
        assert is_met(robot, all_at_once, frame)


@EVERY
def test_the_block_answers_every_planted_pose(name: str) -> None:
    robot, axes, references = poses(name)
    block = made(name).controller()
    assert block.initialise(robot.parameters) == OK
    for row, reference in zip(axes, references, strict=True):
        frame, configuration = robot.forward(tuple(row))
        status, answer = block.inverse(frame.position, frame.rotation, configuration, tuple(reference))
        assert status == OK, row.tolist()
        assert is_met(robot, answer[:3], frame)


@EVERY
@pytest.mark.parametrize("language", ["c", "javascript"])
def test_other_languages_answer_every_planted_pose(name: str, language: str) -> None:
    robot, axes, references = poses(name)
    asked = []
    for row, reference in zip(axes.tolist(), references.tolist(), strict=True):
        frame, configuration = robot.forward(tuple(row))
        pose = {"position": list(frame.position), "rotation": [list(r) for r in frame.rotation]}
        asked.append(["inverse", pose, list(configuration), reference])
    (answer,) = asked_in(language, made(name).mechanism, [{"parameters": dict(robot.parameters), "calls": asked}])
    for row, found in zip(axes, answer["found"], strict=True):
        assert found["status"] == 0, row.tolist()
        assert is_met(robot, found["axes"], robot.forward(tuple(row))[0])
