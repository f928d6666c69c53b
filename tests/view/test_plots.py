"""What is plotted: the way along a line, and the solutions and margins in a slice."""

import re

import numpy as np
import pytest
import softkin

from tests.view.states import Seen, confirm, robot_of

pytestmark = pytest.mark.slow


def test_a_line(seen: Seen) -> None:
    """A line through the inside of a SCARA is refused there, and told; another has a way, as Python says."""
    assert re.match(r"Refused from \d+ %: A2: out of reach, missing ", seen["crossing"]["said"])
    assert seen["crossing"]["stops"] == seen["crossing"]["curves"] == 4
    assert seen["line"]["said"].startswith("There is a way on this branch.")
    assert (seen["line"]["stops"], seen["line"]["path"]) == (0, 241)
    confirm(seen["halfway"])
    begin = seen["lineFrom"]["frame"]["position"]
    assert np.allclose(seen["halfway"]["frame"]["position"][:2], (np.add(begin, [350, 250, 0]) / 2)[:2], atol=1e-9)
    assert len(seen["halfway"]["ghosts"]) == 1
    assert seen["played"]["axes"] != seen["halfway"]["axes"]
    confirm(seen["played"])


def test_a_line_is_marked(seen: Seen) -> None:
    """Through the centre of a polar machine its axis jumps by half a turn, there alone; a limit ends another line."""
    assert (seen["jump"]["jumps"], seen["jump"]["singular"], seen["jump"]["stops"]) == (2, 2, 0)  # in both plots
    assert seen["jump"]["said"].endswith("An axis jumps.")
    assert (seen["limit"]["limits"], seen["limit"]["stops"], seen["limit"]["jumps"]) == (1, 3, 0)
    assert "A1: above its upper limit, missing" in seen["limit"]["said"]


def test_a_slice(seen: Seen) -> None:
    """Every cell has the number of solutions, and the margin, that Python has there."""
    pose, found = seen["slicePose"], np.array(seen["slice"]["values"])
    origin, along, up = (np.array(corner) for corner in seen["slice"]["corners"])
    places = (np.arange(96) + 0.5) / 96
    points = np.array([[origin + a * along + (1 - b) * up for a in places] for b in places]).reshape(-1, 3)
    robot = robot_of(pose)
    rotations = np.broadcast_to(np.array(pose["frame"]["rotation"]), (len(points), 3, 3))
    counts = np.zeros(len(points), int)
    for byte in (1, 2):
        configuration = [byte, *[0] * (len(pose["configuration"]) - 1)]
        axes, statuses = robot.inverse_batch(points, rotations, configuration, pose["axes"])
        counts += statuses == softkin.Status.OK
        if byte == pose["configuration"][0]:
            margins = np.array([abs(robot.singularity(a).margins["elbow"]) for a in axes[statuses == 0][::97]])
            shown = np.array(seen["margin"]["values"]).reshape(-1)[statuses == 0][::97]
            assert np.allclose(shown, margins, atol=1e-6)
    assert np.array_equal(np.where(counts > 0, counts, -1), found.reshape(-1))
    assert 0.3 < (counts > 0).mean() < 0.9
