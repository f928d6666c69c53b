"""Imported robots are derived: every solution of the inverse stands where an independent reader has the tip."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest
import softkin

from derive.importing.importing import Imported
from derive.pipeline import Built
from tests.importing.kinematics import by_yourdfpy, described, facing, imported
from tests.importing.robots import COLLECTION, File, written
from tests.machines.made import built_of, imported_class

SOLUTIONS = {
    "KR 16": 8, "KR 120": 8, "KR 210": 8, "iiwa": 8, "Puma 560": 8, "UR5e": 8, "Fanuc": 8, "Staubli": 8, "AL5D": 4,
    "IRB 140": 8, "xArm6": 8,
}  # fmt: skip
"""The IRB 140 and the xArm6 by the root finder."""
FEWEST_DIGITS = 4
"""Of pi in the files of `WRITTEN`: with more digits their descriptions are the same (`test_urdf`)."""
QUICK = ("KR 16",)
"""The others are slow."""
EVERY = pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in SOLUTIONS]
)


@cache
def derived(name: str) -> tuple[File, Imported, Built, type[softkin.Mechanism]]:
    """A robot file, its description, what was derived, and the class of the generated package."""
    folder = Path(mkdtemp(prefix="imported-"))
    file = COLLECTION.get(name) or written(name, FEWEST_DIGITS, folder)
    found = imported(file.path, file.base, file.tip)
    mechanism = described(found, folder)
    built = built_of(mechanism)
    return file, found, built, imported_class(mechanism, built)


@EVERY
def test_every_solution_stands_where_the_file_has_the_tip(name: str) -> None:
    file, found, built, robot_class = derived(name)
    assert built.evidence is not None and built.evidence.inverted is not None
    assert built.evidence.inverted.solutions == SOLUTIONS[name]
    robot, pose = robot_class(check_limits=False), by_yourdfpy(file.path, file.base, file.tip)
    rng = np.random.default_rng(8)
    most = 0
    for axes in rng.uniform(-90.0, 90.0, (20, len(found.axes))):
        frame, _ = robot.forward(axes)
        solutions = [s.axes for s in robot.inverse_all(frame, axes) if s.axes is not None]
        most = max(most, len(solutions))
        assert min(np.abs(np.array(s) - axes).max() for s in solutions) <= 1e-6
        for solution in solutions:
            values = {a.name: float(np.radians(v)) for a, v in zip(found.robot.axes, solution, strict=True)}
            theirs = pose(values) @ facing(found)
            position = np.linalg.norm(np.array(frame.position) - 1000.0 * theirs[:3, 3])
            assert position <= found.bounds.position + 1e-7
            off = np.abs(np.array(frame.rotation) - theirs[:3, :3])
            assert off[:, 2 if "Turning.PITCH)" in found.text else slice(0, 3)].max() <= found.bounds.rotation + 1e-9
    assert most >= SOLUTIONS[name] / 2


@EVERY
def test_the_limits_of_the_file_are_the_limits_of_the_axes(name: str) -> None:
    _, found, _, robot_class = derived(name)
    robot = robot_class()
    for own, axis in zip(found.axes, found.robot.axes, strict=True):
        assert axis.limits is not None
        ends = [robot.parameters[f"{word}_{own.lower()}"] for word in ("lower", "upper")]
        assert np.allclose(ends, np.degrees(axis.limits), rtol=0.0, atol=1e-6)
    inside = np.array([np.degrees(a.limits).mean() for a in found.robot.axes]) + 3.0  # type: ignore[arg-type]
    held = [found.axes[k] for k in robot.HELD]
    frame, configuration = robot.forward(inside)
    assert np.allclose(robot.inverse(frame, configuration, inside), inside, rtol=0.0, atol=1e-6)
    for k, axis in enumerate(found.robot.axes):
        outside = inside.copy()
        outside[k] = np.degrees(axis.limits[1]) + 0.5  # type: ignore[index]
        frame, configuration = robot.forward(outside)
        if found.axes[k] not in held:
            with pytest.raises(
                softkin.KinematicsError, match=f"{found.axes[k]}: (above its upper|this turn is beyond a) limit"
            ):
                robot.inverse(frame, configuration, outside)
