"""A commanded rotation that the flange cannot take: it takes the nearest one, tool direction first."""

import numpy as np
import softkin
from softkin import Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine
from tests.orthonormal import random_rotations, swings, turned

COUNT = 60


def projected(machine: Machine, rotations: Array) -> Array:
    """The rotations that the machine would take for these."""
    return np.array([machine.robot.project(r) for r in rotations])


def turning(machines: tuple[Machine, ...]) -> list[Machine]:
    """The machines that follow a commanded turn about z."""
    return [m for m in machines if m.closure.follows_turn]


def test_it_is_offered_where_the_machine_chooses_the_twist(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in machines:
        assert hasattr(machine.robot, "project") == (mechanism.task.turning is Turning.ABOUT_Z)


def test_the_tool_direction_is_swung_and_the_twist_kept(machines: tuple[Machine, ...]) -> None:
    """The flange's z goes to the machine's by the smallest rotation: what is left is a rotation it can have."""
    for machine in turning(machines):
        rotations = random_rotations(COUNT, 1)
        flange = machine.closure.poses(machine.draw(1, np.random.default_rng(2)))[1][0]
        expected = swings(rotations[:, :, 2], flange[:, 2]) @ rotations
        assert np.abs(projected(machine, rotations) - expected).max() < 1e-9


def test_it_is_the_nearest_in_the_frobenius_norm(machines: tuple[Machine, ...]) -> None:
    """Nearer than every rotation of a fine turn of the flange."""
    angles = np.linspace(-np.pi, np.pi, 7201)
    for machine in turning(machines)[1:4]:
        rotations = random_rotations(COUNT // 3, 3)
        flange = machine.closure.poses(machine.draw(1, np.random.default_rng(4)))[1][0]
        candidates = turned(2, angles) @ flange
        for rotation, found in zip(rotations, projected(machine, rotations), strict=True):
            least = np.sum((candidates - rotation) ** 2, axis=(1, 2)).min()
            distance = np.sum((found - rotation) ** 2)
            assert least - 1e-5 < distance <= least + 1e-12


def test_projecting_again_changes_nothing(machines: tuple[Machine, ...]) -> None:
    for machine in turning(machines):
        once = projected(machine, random_rotations(COUNT, 5))
        assert np.abs(projected(machine, once) - once).max() < 1e-14
        reachable = machine.closure.poses(machine.draw(COUNT, np.random.default_rng(6)))[1]
        assert np.abs(projected(machine, reachable) - reachable).max() < 1e-14


def test_the_inverse_takes_the_projected_rotation(machines: tuple[Machine, ...]) -> None:
    """A pose whose tool is then swung anywhere is answered with the axes of that pose, its position met exactly."""
    for machine in turning(machines):
        axes = machine.draw(COUNT, np.random.default_rng(7))
        positions, rotations = machine.closure.poses(axes)
        directions = random_rotations(COUNT, 8)[:, :, 2]
        tilted = swings(rotations[:, :, 2], directions) @ rotations
        configurations = machine.robot.forward_batch(axes)[2]
        found, statuses = machine.robot.inverse_batch(positions, tilted, configurations, axes)
        assert (statuses == Status.OK).all()
        assert np.abs(found - axes).max() < 1e-7
        assert np.abs(machine.closure.poses(found)[0] - positions).max() < 1e-10 * machine.reach


def test_a_flange_that_looks_down() -> None:
    """Half a turn about X behind the last axis: its own z points down, and turns the other way about it."""
    lengths = {"link_length_1": 325.0, "link_length_2": 225.0}
    up = softkin.Scara4CCZCZCcoupled(**lengths, flange_down=False)
    down = softkin.Scara4CCZCZCcoupled(**lengths, flange_down=True)
    axes = (10.0, 20.0, 5.0, 30.0)
    half_turn = np.diag([1.0, -1.0, -1.0])
    assert np.allclose(np.array(down.forward(axes)[0].rotation), np.array(up.forward(axes)[0].rotation) @ half_turn)
    assert down.forward(axes)[0].position == up.forward(axes)[0].position
    frame, configuration = down.forward(axes)
    assert np.allclose(down.inverse(frame, configuration), axes)
    for robot, direction in ((up, 1.0), (down, -1.0)):
        image = robot.orientation_image()
        assert image.freedom == "one"
        assert image.base_axis == (0.0, 0.0, 1.0)
        assert np.allclose(np.array(image.rotation) @ image.flange_axis, image.base_axis)
        assert image.flange_axis[2] == direction
    try:
        down.inverse(up.forward(axes)[0])
    except softkin.KinematicsError as error:
        assert error.status is Status.UNREACHABLE
    else:
        raise AssertionError("a tool that points up cannot be turned to a flange that looks down")


def test_the_image_is_what_the_flange_does(machines: tuple[Machine, ...]) -> None:
    """A rotation of it, and an axis about which it turns: in the base as in the flange."""
    for machine in machines:
        image = machine.robot.orientation_image()
        rotations = machine.closure.poses(machine.draw(30, np.random.default_rng(9)))[1]
        turns = np.ptp(rotations, axis=0).max() > 1e-9
        freedom = "one" if _stays(rotations) else "three"
        assert image.freedom == (freedom if turns else "zero") == machine.robot.FREEDOM
        assert np.allclose(np.array(image.rotation) @ image.flange_axis, image.base_axis, rtol=0, atol=1e-15)
        relative = rotations @ np.array(image.rotation).T
        if image.freedom == "three":
            assert np.abs(np.linalg.det(np.array(image.rotation)) - 1) < 1e-15
        elif turns:
            assert np.allclose(relative @ image.base_axis, image.base_axis, rtol=0, atol=1e-12)
            assert np.allclose(rotations @ image.flange_axis, image.base_axis, rtol=0, atol=1e-12)
        else:
            assert np.allclose(relative, np.eye(3), rtol=0, atol=1e-15)


def _stays(rotations: Array) -> bool:
    """Whether some direction of the base is the same in every flange."""
    relative = rotations[1:] @ rotations[0].T - np.eye(3)
    return bool(np.linalg.svd(relative.reshape(-1, 3), compute_uv=False)[-1] < 1e-9)
