"""Loops against their descriptions alone: closure, assembly side, branch signs, slopes, and every solution there is."""

from __future__ import annotations

import numpy as np
import pytest
from softkin import KinematicsError, Status

from tests.loops.machines import LOOPS
from tests.loops.unequal import Loop, loops_of

EVERY = pytest.mark.parametrize("number", range(4), ids=["nominal", "unequal", "nominal other mode", "unequal other mode"])


@pytest.fixture(params=LOOPS, ids=lambda m: m.name)
def loop(request: pytest.FixtureRequest, number: int) -> Loop:
    """A loop of the catalogue."""
    return loops_of(request.param)[number]


@EVERY
def test_forward_closes_on_the_machines_side(loop: Loop) -> None:
    """And its bytes are the signs of the description's indicators."""
    joints = loop.equations.joints(loop.axes)
    assert np.abs(loop.equations.residual(joints, loop.positions)).max() < 1e-12
    assert (loop.equations.side(joints, loop.positions) > 0).all()
    bytes_ = loop.robot.forward_batch(loop.axes)[2][:, : loop.robot.BRANCHES]
    assert (bytes_ == np.where(loop.equations.branches(joints, loop.positions) > 0, 1, 2)).all()


@EVERY
def test_the_inverse_refuses_where_a_bound_is_exceeded_and_nowhere_else(loop: Loop) -> None:
    joints = loop.equations.joints(loop.axes)
    room = -loop.equations.bounds(joints, loop.positions).max(axis=1, initial=-1.0)
    configurations = loop.robot.forward_batch(loop.axes)[2]
    found, statuses = loop.robot.inverse_batch(loop.positions, None, configurations, loop.axes)
    inside = room > 1e-9
    assert inside.sum() >= 10
    assert (statuses[inside] == Status.OK).all()
    assert (statuses[room < -1e-9] == Status.UNREACHABLE).all()
    assert np.abs((found - loop.axes)[inside]).max() < 1e-8
    for axes, position, configuration, status in list(
        zip(loop.axes, loop.positions, configurations, statuses, strict=True)
    )[:40]:
        try:
            scalar = loop.robot.inverse((position, None), configuration, axes)
        except KinematicsError as error:
            assert error.status == status
        else:
            assert status == Status.OK
            assert np.abs(scalar - axes).max() < 1e-8


@EVERY
def test_the_slots_hold_every_solution_and_no_other(loop: Loop) -> None:
    """Brute force knows the closure alone; near a type 2 singularity is allowed, so that counts are of the geometry."""
    robot = type(loop.robot)(**{**loop.given, "min_type2_margin": 0.0})
    for position in loop.positions[:5]:
        everywhere = loop.equations.solutions(position, np.random.default_rng(3))
        there = np.repeat(position[None], len(everywhere), axis=0)
        expected = everywhere[loop.equations.is_ours(everywhere, there)]
        slots = robot.inverse_all((position, None))
        found = [loop.equations.joints(np.array(s.axes)) for s in slots if s.status is Status.OK]
        assert {s.status for s in slots} <= {Status.OK, Status.UNREACHABLE}
        assert len(found) == len(expected) <= 2**robot.BRANCHES
        for one in found:
            assert min(loop.equations.distance(one, other) for other in expected) < 1e-7
        for slot in (s for s in slots if s.status is Status.OK):
            joints = loop.equations.joints(np.array([slot.axes]))
            signs = loop.equations.branches(joints, position[None])[0]
            assert slot.configuration[: robot.BRANCHES] == tuple(np.where(signs > 0, 1, 2))
            assert np.abs(loop.equations.residual(joints, position[None])).max() < 1e-12
            assert loop.equations.side(joints, position[None])[0] > 0


@EVERY
def test_the_jacobian_is_that_of_the_closure_and_of_forward(loop: Loop) -> None:
    axes, positions = loop.axes[:40], loop.positions[:40]
    derived = np.array([loop.robot.jacobian(row) for row in axes])
    expected = loop.equations.jacobian(loop.equations.joints(axes), positions)
    size = np.abs(expected).max(axis=(1, 2))
    assert (np.abs(derived - expected).max(axis=(1, 2)) < 1e-10 * size).all()
    step = 1e-4
    for i, unit in enumerate(loop.equations.units):
        shift = step * np.eye(axes.shape[1])[i]
        ahead, behind = (loop.robot.forward_batch(axes + s)[0] for s in (shift, -shift))
        slope = (ahead - behind)[:, : derived.shape[1]] / (2 * step * unit)
        assert (np.abs(slope - derived[:, :, i]).max(axis=1) < 1e-5 * size).all()
