"""The task that an import chooses: the one that a user of such an arm wants, and that all its axes move well."""

from pathlib import Path

import numpy as np
import pytest

from tests.importing.kinematics import assert_is, by_yourdfpy, described, imported, imported_text
from tests.importing.robots import joint, urdf
from tests.machines.made import built_of, imported_class

HALF = "1.57079632679"
HEADING = joint("pan", "revolute", "0 0 0.12")
PITCHES = [joint(f"pitch{k}", "revolute", f"{x} 0 0", axis="0 1 0") for k, x in enumerate(("0.03", "0.11", "0.13"))]
ROLL = joint("roll", "revolute", "0.05 0 0", axis="1 0 0")
"""A desk arm: a heading, three parallel pitches, and a roll along x."""
SPREAD = [
    joint("a", "revolute", "0 0 0.11"),
    joint("b", "revolute", "0 0 0.2", axis="0 1 0"),
    joint("c", "revolute", "0 0 0.24", axis="0 1 0"),
    joint("d", "revolute", "0 0 0.12"),
    joint("e", "revolute", "0 0 0.14", axis="0 1 0"),
]
"""An arm whose fourth axis runs along its forearm, and whose last one is the pitch of its wrist."""
CASES = {
    "a tip on the roll": ([HEADING, *PITCHES, ROLL], ("0.1 0 0", "0 0 0"), "PITCH_ROLL", 0, None),
    "a tip beside it": ([HEADING, *PITCHES, ROLL], ("0.1 0.009 -0.002", "0 0 0"), "PITCH_ROLL", 0, (0.0, -9.0, 2.0)),
    "a tip beside it that is turned": (
        [HEADING, *PITCHES, ROLL],
        ("0.1 0.009 0", f"0 {HALF} 0"),
        "PITCH_ROLL",
        2,
        (0.0, -9.0, 0.0),
    ),
    "a tip that a tool inclines": ([HEADING, *PITCHES, ROLL], ("0.1 0 0", "0 0.8 0"), "DIRECTION", 2, None),
    "a roll that is not square to the pitches": (
        [HEADING, *PITCHES, joint("roll", "revolute", "0.05 0 0", axis="0.8 0.6 0")],
        ("0.1 0 0.02", "0 0 0"),
        "DIRECTION",
        2,
        None,
    ),
    "a wrist that pitches last": (SPREAD, ("0 0 0", "0 0 0"), "DIRECTION", 2, None),
    "a wrist that pitches last, with a tool": (SPREAD, ("0.02 0 0.1", "0 0 0"), "DIRECTION", 2, None),
    "a wrist that pitches last, its tool along x": (SPREAD, ("0.05 0 0", f"0 0 {HALF}"), "DIRECTION", 2, None),
}


def _arm(name: str, folder: Path) -> Path:
    joints, (xyz, rpy), *_ = CASES[name]
    path = folder / "arm.urdf"
    path.write_text(urdf("arm", *joints, joint("tip", "fixed", xyz, rpy)), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", CASES)
def test_the_task_is_the_one_that_is_wanted(name: str, tmp_path: Path) -> None:
    *_, turning, facing, beside = CASES[name]
    path = _arm(name, tmp_path)
    found = imported(path)
    assert (found.task.turning, found.task.facing) == (turning, facing)
    assert (found.task.beside is None) == (beside is None)
    assert beside is None or np.allclose(found.task.beside, beside, rtol=0.0, atol=1e-9)
    assert ("The tip is moved by" in found.report) == (beside is not None)
    assert "hardly" not in found.report
    assert_is(found, tmp_path, by_yourdfpy(path, found.robot.base, found.robot.tip), turned=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["a tip beside it", "a wrist that pitches last"])
def test_poses_near_those_that_are_reached_are_answered(name: str, tmp_path: Path) -> None:
    """The position is met, and all solutions of a pose that is reached have its rotation, as far as it is commanded."""
    found = imported(_arm(name, tmp_path))
    mechanism = described(found, tmp_path)
    robot = imported_class(mechanism, built_of(mechanism))(check_limits=False)
    rng, answered = np.random.default_rng(5), 0
    for axes in rng.uniform(-60.0, 60.0, (60, 5)):
        frame, _ = robot.forward(axes)
        for solution in robot.inverse_all(frame, axes):
            again = robot.forward(solution.axes)[0] if solution.axes else frame
            assert (
                np.allclose(again.rotation, frame.rotation, rtol=0.0, atol=1e-7) or found.task.turning != "PITCH_ROLL"
            )
            assert np.allclose(np.array(again.rotation)[:, 2], np.array(frame.rotation)[:, 2], rtol=0.0, atol=1e-7)
        near = tuple(np.array(frame.position) + rng.uniform(-2.0, 2.0, 3))
        solved = [s.axes for s in robot.inverse_all((near, frame.rotation), axes) if s.axes is not None]
        answered += bool(solved)
        assert all(np.allclose(robot.forward(s)[0].position, near, rtol=0.0, atol=1e-6) for s in solved)
    assert answered > 50


def test_an_axis_that_hardly_moves_what_is_commanded_is_told(tmp_path: Path) -> None:
    elbow = [joint("a", "revolute"), joint("b", "revolute", "0.4 0 0"), joint("tip", "fixed", "0.003 0 0")]
    report = imported_text(tmp_path / "arm.urdf", urdf("arm", *elbow)).report
    assert "A2 hardly moves what is commanded: 0.00" in report and "A1 hardly" not in report
