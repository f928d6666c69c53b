"""Both cores give the same answers: every call, in every form of its arguments, batches too."""

from typing import Any

import numpy as np
import pytest
from softkin import Frame, KinematicsError, Mechanism
from softkin._search import SearchedInverse

from tests.native.machines import NAMES, in_python, native, outcome, poses

COUNT = 6
ROUNDING = 1e-12
"""Of the size of the values, over the smallest margin of the pose."""


def same(found: Any, expected: Any, allowed: float) -> bool:
    """Whether results are the same: real numbers within what is allowed, all else to the letter."""
    if isinstance(found, float):  # Python has some whole numbers among real ones
        return type(expected) in (int, float) and (abs(found - expected) <= allowed or found == expected)
    if isinstance(expected, tuple):
        if not (type(found) is type(expected) and len(found) == len(expected)):
            return False
        return all(same(a, b, allowed) for a, b in zip(found, expected, strict=True))
    if type(found).__name__ == "Solutions" or type(expected).__name__ == "Solutions":
        return same(tuple(found), tuple(expected), allowed)
    return bool(found == expected and type(found) is type(expected))


def allowed_at(robot: Mechanism, axes: tuple[float, ...], frame: Frame) -> float:
    """What results may differ by at a pose."""
    margins = robot.singularity(axes).margins.values()
    size = max(map(abs, (*axes, *frame.position, 100.0)))
    return 20.0 * ROUNDING * size / min([abs(m) for m in margins] + [1.0])


@pytest.mark.parametrize("name", NAMES)
def test_every_call(name: str) -> None:
    """Results and refusals, with the configuration of the pose, the default one, and open branches."""
    robot, other = native(name), in_python(name)
    for axes, frame in poses(name, COUNT):
        allowed = allowed_at(robot, axes, frame)
        if allowed > 1e-8:  # at a singular pose cores may round to different branches: the corpus asks these
            continue
        configuration = robot.forward(axes)[1]
        every_sign = [tuple(1 if k >> i & 1 else -1 for i in range(robot.BRANCHES)) for k in range(2**robot.BRANCHES)]
        asked = [
            ("forward", axes), ("jacobian", axes), ("_forward", axes), ("_singularity", axes),
            ("inverse", frame, configuration, axes), ("inverse", frame, None, axes),
            ("inverse", frame, (0,) * len(configuration), axes), ("inverse_all", frame, axes),
            ("branches", frame, axes), *(("branch", frame, signs, axes) for signs in every_sign[:8]),
        ]  # fmt: skip
        if not robot.HELD:
            asked += [("inverse", frame), ("inverse_all", frame)]
        for call, *given in asked:
            found, expected = (outcome(getattr(one, call), *given) for one in (robot, other))
            if call in ("branch", "branches"):  # there an axis may be on any turn
                found, expected = (_on_one_turn(robot, value) for value in (found, expected))
            assert same(found, expected, allowed), (call, given, found, expected)


def _on_one_turn(robot: Mechanism, found: Any) -> Any:
    """Axes of trusted input, each multi-turn one between -180 and 180 degrees."""
    if found is None or not found:
        return found
    if isinstance(found[0], tuple) or found[0] is None:
        return tuple(_on_one_turn(robot, axes) for axes in found)
    if any(axis.unit != "deg" for axis in robot.AXES) and robot._turn_sizes() != (1.0,) * len(robot.PERIOD_AXES):
        return found
    turned = {i for i in robot.PERIOD_AXES if robot.AXES[i].kind == "rotary"}
    return tuple((v + 170.0) % 360.0 if i in turned else v for i, v in enumerate(found))


@pytest.mark.parametrize("name", NAMES)
def test_every_form_of_the_arguments(name: str) -> None:
    """Tuples, lists, arrays, a matrix, a frame and a pair: the same numbers give the same result to the last digit."""
    robot = native(name)
    for axes, frame in poses(name, 2):
        first = [list(axes), np.array(axes), np.array([axes, axes])[:, ::1][0], tuple(map(np.float64, axes))]
        for call in (robot.forward, robot.jacobian):
            expected = call(axes)
            assert all(call(form) == expected for form in first)
        position, rotation = frame
        forms = [
            tuple(frame), list(frame), (list(position), [list(row) for row in rotation]), frame.matrix,
            (np.array(position), np.array(rotation)), np.asfortranarray(frame.matrix), frame.matrix.tolist(),
        ]  # fmt: skip
        expected = outcome(robot.inverse, frame, None, axes)
        for form in forms:
            assert same(outcome(robot.inverse, form, None, np.array(axes)), expected, 0.0), form
        assert robot.inverse_all(frame.matrix, list(axes)) == tuple(robot.inverse_all(frame, axes))


@pytest.mark.parametrize("name", NAMES)
def test_batches(name: str) -> None:
    """Rows of the native core are those of NumPy, statuses to the letter: good ones, garbage, and beyond reach."""
    robot, other = native(name), in_python(name)
    found = poses(name, 20)
    axes = np.array([a for a, _ in found] * 3)
    axes[1] = np.nan
    forward, expected = robot.forward_batch(axes), other.forward_batch(axes)
    for one, two in zip(forward, expected, strict=True):
        assert one.dtype == two.dtype and one.shape == two.shape
        assert np.allclose(one, two, rtol=1e-11, atol=1e-9, equal_nan=True)
    positions, rotations, configurations, _ = (a.copy() for a in forward)
    positions[3:5] = [[1e6, 0.0, 0.0], [np.inf, 0.0, 0.0]]
    rotations[6] *= 1.01
    configurations[7] = 9
    near = np.nan_to_num(axes)
    calls: list[tuple[str, tuple[Any, ...]]] = [
        ("inverse_batch", (positions, rotations, configurations, near)),
        ("inverse_batch", (positions, rotations, None, near[0])),
        ("jacobian_batch", (axes,)),
    ]
    if not isinstance(robot, SearchedInverse):
        calls.append(("inverse_all_batch", (positions, rotations, near)))
    for call, given in calls:
        (one, status), (two, wanted) = (getattr(r, call)(*given) for r in (robot, other))
        assert one.shape == two.shape and status.dtype == wanted.dtype
        differs = status != wanted
        assert not differs.any(), (call, np.argwhere(differs)[:3])
        margins = np.abs(robot.singularity_batch(near)[1]).min(axis=1, initial=1.0)
        regular = margins > 1e-3
        assert np.allclose(one[regular], two[regular], rtol=1e-9, atol=1e-7, equal_nan=True), call


@pytest.mark.parametrize("name", NAMES)
def test_wrong_forms_of_batches(name: str) -> None:
    """Both cores refuse a wrong shape with the same words."""
    robot, other = native(name), in_python(name)
    for call, *given in (
        ("forward_batch", [[1.0]] * 3), ("forward_batch", "no"), ("jacobian_batch", np.zeros((2, 2, 2))),
        ("inverse_batch", [[1.0]], None), ("inverse_batch", np.zeros((2, 3)), np.zeros((2, 3)), None, None),
        ("inverse_batch", np.zeros((2, 3)), np.zeros((2, 3, 3)), [1.5], np.zeros(len(robot.AXES))),
        ("inverse_all_batch", np.zeros((2, 3), complex), None),
    ):  # fmt: skip
        found, expected = (outcome(getattr(one, call), *given) for one in (robot, other))
        if isinstance(expected[0], type) and issubclass(expected[0], KinematicsError):
            assert found == expected
