"""Time laws: on the path, inside the limits, as fast as the textbook says, at rest at corners."""

from __future__ import annotations

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status

from tests.catalogue.robots import KR6_R900

ARM = softkin.ArticulatedRobot6DOF(**KR6_R900)
AXES = (10.0, -60.0, 120.0, 40.0, 50.0, 60.0)
LIMITS = {axis.name: (150.0, 600.0) for axis in ARM.AXES}


def test_a_straight_path_of_a_gantry_takes_the_time_of_trapezoids() -> None:
    """Of each line: length / speed + speed / acceleration; of a short one 2 sqrt(length / acceleration)."""
    gantry = softkin.Gantry3()
    corners = [Frame(place) for place in ((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (300.0, 400.0, 0.0), (300.0, 400.0, 8.0))]
    timed = gantry.path(corners).timed(dict.fromkeys("XYZ", (100.0, 200.0)))
    assert timed.duration == pytest.approx((3.0 + 0.5) + (4.0 + 0.5) + 2.0 * np.sqrt(8.0 / 200.0), rel=1e-4)
    assert timed.axes[-1] == pytest.approx((300.0, 400.0, 8.0), abs=1e-9)
    assert repr(timed) == f"<Timed motion of Kin_Gantry3: {timed.duration:.6g} s, {len(timed.times)} times>"


def test_a_timed_path_stays_on_its_line_and_uses_its_limits() -> None:
    """Held to the frames of `forward`: off the lines by less than a micrometre; at every time a limit is nearly met."""
    first = ARM.forward(AXES)[0]
    corners = [first, first.shifted(-100.0, 150.0, -300.0), first.shifted(-100.0, -100.0, -200.0)]
    timed = ARM.path(corners, reference=AXES).timed(LIMITS, step=0.002)
    places = ARM.forward_batch(timed.axes)[0]
    off = []
    for start, end in zip(corners, corners[1:], strict=False):
        along = np.subtract(end.position, start.position)
        away = places - start.position
        share = np.clip(away @ along / (along @ along), 0.0, 1.0)
        off.append(np.linalg.norm(away - np.outer(share, along), axis=1))
    assert np.min(off, axis=0).max() < 1e-3
    used = np.maximum(np.abs(timed.velocities) / 150.0, np.abs(timed.accelerations) / 600.0).max(axis=1)
    assert used.max() < 1.001 and np.quantile(used, 0.01) > 0.9
    moved = np.cumsum(0.5 * (timed.velocities[1:] + timed.velocities[:-1]) * np.diff(timed.times)[:, None], axis=0)
    assert np.abs(timed.axes[0] + moved - timed.axes[1:]).max() < 1e-2
    corner = int(np.abs(timed.velocities[10:-10]).max(axis=1).argmin()) + 10
    assert np.abs(places[corner] - corners[1].position).max() < 1.0
    assert np.abs(timed.velocities[[0, -1]]).max() < 1e-6


def test_a_move_from_point_to_point_takes_the_time_of_the_textbook() -> None:
    """Trapezoid: way / speed + speed / acceleration. S-curve: the two, and acceleration / jerk. All arrive together."""
    goal = tuple(np.add(AXES, (80.0, -30.0, -10.0, -20.0, 0.0, 240.0)))
    trapezoid = ARM.move(AXES, goal, LIMITS)
    curve = ARM.move(AXES, goal, {name: (*row, 6000.0) for name, row in LIMITS.items()}, step=0.001)
    assert trapezoid.duration == pytest.approx(240.0 / 150.0 + 150.0 / 600.0)
    assert curve.duration == pytest.approx(trapezoid.duration + 600.0 / 6000.0)
    for timed in (trapezoid, curve):
        assert timed.axes[[0, -1]].ravel() == pytest.approx((*AXES, *goal), abs=1e-9)
        assert np.abs(timed.velocities).max() < 150.0 + 1e-9
        shares = (timed.axes - AXES)[1:-1, [0, 1, 2, 3, 5]] / np.subtract(goal, AXES)[[0, 1, 2, 3, 5]]
        assert np.abs(shares - shares[:, :1]).max() < 1e-9  # a straight line of axis values
    assert np.abs(np.diff(curve.accelerations, axis=0)).max() < 6000.0 * 0.001 * (1.0 + 1e-6)
    assert ARM.move(AXES, AXES, LIMITS).duration == 0.0


def test_what_cannot_be_timed_is_refused() -> None:
    """A path that stops, limits of the wrong axes or size, a goal beyond a limit, a wrong step."""
    first = ARM.forward(AXES)[0]
    beyond = ARM.line(first, first.shifted(2000.0), None, AXES)
    narrow = ARM.changed(limits={"A1": (-20.0, 20.0)})
    short = ARM.line(first, first.shifted(1.0), None, AXES)
    for call, words, status in (
        (lambda: beyond.timed(LIMITS), "the path stops at 0", Status.UNREACHABLE),
        (lambda: short.timed({"A1": (1.0, 1.0)}), "for A1, A2, A3, A4, A5, A6, and not for A1", Status.BAD_INPUT),
        (lambda: short.timed({**LIMITS, "A2": (0.0, 1.0)}), "each above 0, not .* for A2", Status.BAD_INPUT),
        (lambda: short.timed(LIMITS, step=0.0), "step must be seconds above 0", Status.BAD_INPUT),
        (lambda: narrow.move(AXES, (30.0, *AXES[1:]), LIMITS), "A1: above its upper limit", Status.UNREACHABLE),
    ):
        with pytest.raises(KinematicsError, match=words) as refused:
            call()
        assert refused.value.status is status
