"""The wrist with two pushrods, by its pitch and roll: the closure written by hand, and all its solutions."""

import numpy as np
import softkin
from numpy.typing import NDArray
from softkin import Status

from tests.catalogue.roots import SAME
from tests.mechanisms import named
from tests.orthonormal import about

Array = NDArray[np.float64]
GIVEN = {p.name: p.nominal for p in named("Softkin_RodWrist").parameters}
ROBOT = softkin.catalogue()["Softkin_RodWrist"](**GIVEN, check_forward=False, min_type2_margin=0.0)
MOTORS, JOINTS = (np.array([[GIVEN[f"{end}_{k}_{c}"] for c in "xyz"] for k in (1, 2)]) for end in ("base", "platform"))
CRANKS, RODS = (np.array([GIVEN[f"{body}_length_{k}"] for k in (1, 2)]) for body in ("crank", "rod"))
POSES, STARTS, PASSES, STEP = 12, 12, 60, 1e-6


def plate(pitch: float, roll: float) -> Array:
    return about(1, np.degrees(pitch)) @ about(0, np.degrees(roll))


def missing(turns: Array, axes: Array) -> Array:
    """How much longer than each rod the way between its ends is."""
    angles = np.radians(axes)
    ends = MOTORS + CRANKS[:, None] * np.column_stack([-np.cos(angles), 0.0 * angles, np.sin(angles)])
    return np.asarray(np.linalg.norm(JOINTS @ plate(*turns).T - ends, axis=1) - RODS)


def poses_of(axes: Array) -> list[Array]:
    """All poses of the plate at crank angles, by Newton's method from starts all over."""
    found: list[Array] = []
    for start in np.stack(np.meshgrid(*[np.linspace(-np.pi, np.pi, STARTS)] * 2), axis=-1).reshape(-1, 2):
        turns = start
        for _ in range(PASSES):
            ends = [(missing(turns + s, axes) - missing(turns - s, axes)) / (2.0 * STEP) for s in STEP * np.eye(2)]
            step = np.linalg.lstsq(np.array(ends).T, missing(turns, axes), rcond=None)[0]
            turns = turns - step * min(1.0, 0.5 / max(np.abs(step).max(), 1e-9))
            if np.abs(step).max() < SAME * 1e-3:
                break
        rotation = plate(*turns)
        is_new = all(np.abs(rotation - other).max() > SAME for other in found)
        if np.abs(missing(turns, axes)).max() < 1e-9 and is_new:
            found.append(rotation)
    return found


def test_the_pose_is_one_of_four_and_so_are_the_cranks() -> None:
    """Forward kinematics finds one of all poses; there each crank has two angles, in a slot each."""
    for axes in np.random.default_rng(0).uniform(-45.0, 45.0, (POSES, 2)):
        every = poses_of(axes)
        frame, _ = ROBOT.forward(axes)
        apart = [np.abs(np.array(frame.rotation) - other).max() for other in every]
        assert len(every) == 4 and min(apart) < SAME and frame.position == (0.0, 0.0, 0.0)
        (pitch, roll), slots = _turns(np.array(frame.rotation)), ROBOT.inverse_all(frame, axes)
        answers = [np.array(s.axes) for s in slots if s.status is Status.OK]
        assert min(np.abs(a - axes).max() for a in answers) < 1e-6
        assert all(np.abs(missing(np.array([pitch, roll]), a)).max() < 1e-9 for a in answers)
        assert len(answers) <= 4 and len({tuple(np.round(a, 6)) for a in answers}) == len(answers)


def test_the_twist_that_is_commanded_is_not_read() -> None:
    """The same cranks for all rotations with one direction of the tool."""
    frame, configuration = ROBOT.forward((20.0, -10.0))
    for degrees in (-150.0, 30.0, 175.0):
        turned = np.array(frame.rotation) @ about(2, degrees)
        assert np.allclose(ROBOT.inverse(((1.0, 2.0, 3.0), turned), configuration), (20.0, -10.0), rtol=0.0, atol=1e-9)


def _turns(rotation: Array) -> tuple[float, float]:
    """Pitch and roll of a plate on the universal joint, whose x axis stays in the plane of the pitch."""
    assert abs(rotation[1, 0]) < 1e-12
    return float(np.arctan2(-rotation[2, 0], rotation[0, 0])), float(np.arctan2(-rotation[1, 2], rotation[1, 1]))
