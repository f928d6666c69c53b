"""Published poses and the published determinant, in which the margins do not factor."""

import numpy as np
import pytest

from tests.catalogue.search.arms import IRB_2400, LATERALS, arm, frame, miss

POSES = {
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0): (940.0, 0.0, 1455.0),
    (30.0, 20.0, -10.0, 40.0, 50.0, 60.0): (977.80958967, 612.86784662, 1220.71810637),
    (-75.0, -30.0, 25.0, -110.0, 35.0, 170.0): (99.59131922, -548.69068293, 1448.51664933),
}
"""Axis values of the maker, whose A5 is a quarter turn less than ours, and positions of the flange."""


@pytest.mark.parametrize("theirs", POSES)
def test_the_maker_s_poses(theirs: tuple[float, ...]) -> None:
    """Forward kinematics gives the poses of the manufacturer, and the inverse leads back."""
    robot, axes = arm(), np.add(theirs, (0, 0, 0, 0, 90, 0))
    reached, configuration = robot.forward(axes)
    assert np.abs(np.subtract(reached.position, POSES[theirs])).max() < 1e-8
    assert np.abs(np.subtract(robot.inverse(reached, configuration, axes), axes)).max() < 1e-9
    solutions = [s for s in robot.inverse_all(reached, axes) if s.axes is not None]
    assert all(miss(np.array(s.axes), 0.0, frame(axes, 0.0)) < 1e-12 for s in solutions)
    assert all(s.configuration[3] == 1 for s in solutions)  # without an offset there is one crossing


def determinant(axes: np.ndarray, lateral: float) -> float:
    """GEOMETRY 5.1, over the lengths that the margin is measured in."""
    k, (_, q2, q3, q4, q5, _) = IRB_2400, np.radians(axes)
    forearm = np.hypot(k["a3"], k["d4"])
    bent, ahead = np.sin(q3 + np.arctan2(k["d4"], k["a3"])), k["a1"] + k["a2"] * np.sin(q2)
    ahead += forearm * np.sin(q2 + q3 + np.arctan2(k["d4"], k["a3"]))
    beside = forearm * bent * np.cos(q4) ** 2 * np.cos(q2 + q3) + ahead * np.sin(q4) ** 2 * np.cos(q3)
    found = k["a2"] * forearm * bent * ahead * np.cos(q5) + lateral * k["a2"] * beside
    return float(found / (k["a2"] * forearm * (k["a1"] + k["a2"] + k["d4"])))


@pytest.mark.parametrize("lateral", (0.0, *LATERALS))
def test_the_margin_is_the_published_determinant(lateral: float) -> None:
    robot, rng = arm(lateral), np.random.default_rng(4)
    poses = rng.uniform(-180, 180, (40, 6))
    ours = np.array([robot.singularity(a).margins["determinant"] for a in poses])
    theirs = np.array([determinant(a, lateral) for a in poses])
    ratio = ours / theirs
    assert np.abs(ratio / ratio[0] - 1).max() < 1e-9
    assert 0.4 < abs(ratio[0]) < 2.5


def test_beside_the_right_angle_it_is_singular() -> None:
    """With an offset A5 at a right angle is regular, and the pose where the determinant vanishes is not."""
    robot, axes = arm(60.0), np.array([20.0, 30.0, -40.0, 35.0, 90.0, 70.0])
    assert not robot.singularity(axes).is_singular
    low, high = 0.0, 180.0
    for _ in range(80):
        axes[4] = (low + high) / 2
        same = determinant(axes, 60.0) * determinant(np.array([*axes[:4], low, 70.0]), 60.0) > 0
        low, high = (axes[4], high) if same else (low, axes[4])
    assert abs(axes[4] - 90.0) > 1.0
    assert robot.singularity(axes).is_singular
    assert arm(0.0).singularity((20.0, 30.0, -40.0, 35.0, 90.0, 70.0)).is_singular
