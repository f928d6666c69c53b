"""Refusals: invalid numbers, machines that cannot work, legs beyond their limits, joints beyond their cones."""

import numpy as np
import pytest
from softkin import Hexapod, Status

from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod.machines import Array, Machine, machines
from tests.catalogue.refusals import refusal
from tests.text.controller import BAD_INPUT, NOT_INITIALIZED, OK, Controller
from tests.text.hexapod.blocks import controller, made
from tests.text.units import compiled

EYE = np.eye(3)


@pytest.mark.parametrize("turn", [EYE * 1.1, np.diag((1.0, 1.0, -1.0)), EYE + 1.1e-4, EYE * np.nan, EYE * 1e200])
def test_what_is_no_rotation(turn: Array) -> None:
    robot = machines()["nominal"].robot
    for call in (
        lambda: robot.inverse(((0.0, 0.0, 600.0), turn)),
        lambda: robot.forward((650.0,) * 6, start=((0.0, 0.0, 600.0), turn)),
    ):
        assert refusal(call) is Status.BAD_INPUT
    starts = (np.tile((0.0, 0.0, 600.0), (2, 1)), np.stack([turn, EYE]))
    assert robot.forward_batch([(650.0,) * 6] * 2, starts)[3].tolist() == [Status.BAD_INPUT, Status.OK]
    assert controller("nominal").inverse((0.0, 0.0, 600.0), turn, (), (0.0,) * 6) == (BAD_INPUT, None)
    assert controller("nominal").image_with_orientation(turn)[0] == BAD_INPUT
    found = robot.diagnose(((0.0, 0.0, 600.0), turn))
    assert found.reason
    assert controller("nominal").diagnose((0.0, 0.0, 600.0), turn, (), (0.0,) * 6) == (found.reason, found.missing)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1.1e9])
def test_a_start_that_is_no_number_is_refused(wrong: float) -> None:
    """And so are lengths that are none, whatever the start is."""
    forward, axes = machines()["nominal"].robot.forward, (650.0,) * 6
    assert refusal(forward, axes, start=((wrong, 0.0, 600.0), EYE)) is Status.BAD_INPUT
    assert refusal(forward, (*axes[1:], wrong), start=((0.0, 0.0, 600.0), EYE)) is Status.BAD_INPUT


def refused_parameters() -> dict[str, dict[str, float]]:
    """Machines that cannot work."""
    given = machines()["nominal"].given
    return {
        "nothing given": dict.fromkeys(given, 0.0),
        "a singular home": {**given, "home_yaw": 90.0},
        "a platform that is a point": {**given, **{n: 0.0 for n in given if n.startswith("platform")}},
        "a home in the base": {**given, "home_z": 0.0},
        "joints on one line": {**given, **{n: 0.0 for n in given if n.startswith("platform") and n.endswith("y")}},
        "a leg without length": {
            **given,
            **{f"base_1_{c}": given[f"platform_1_{c}"] + (c == "z") * 600.0 for c in "xyz"},
        },
        "no number": {**given, "base_3_y": np.nan},
        "limits the wrong way round": {**given, "lower_l2": 700.0, "upper_l2": 600.0},
        "far too large": {**given, "platform_4_x": 2e9},
        "a cone below nothing": {**given, "max_angle_base_joint": -1.0},
        "a cone beyond everything": {**given, "max_angle_platform_joint": 181.0},
    }


@pytest.mark.parametrize("case", refused_parameters())
def test_machines_that_cannot_work(case: str) -> None:
    given = refused_parameters()[case]
    assert refusal(Hexapod, **given) is Status.NOT_INITIALIZED
    assert Controller(compiled(MECHANISM), MECHANISM).initialise(given) == NOT_INITIALIZED


def leans(machine: Machine, positions: Array, turns: Array) -> tuple[Array, Array]:
    """The angles between every leg and its direction at home, in degrees, as the base and as the platform see them."""
    home, legs = machine.spans(machine.home[:3], machine.home_turn), machine.spans(positions, turns)
    return _between(home, legs), _between(home @ machine.home_turn, legs @ turns)


def _between(first: Array, second: Array) -> Array:
    across = np.linalg.norm(np.cross(first, second), axis=-1)
    return np.asarray(np.degrees(np.arctan2(across, (first * second).sum(axis=-1))))


@pytest.mark.parametrize("side", ["base", "platform"])
def test_the_cone_of_every_joint_bounds_the_inverse(machine: Machine, side: str) -> None:
    """A pose is refused where one joint leans further than its cone; the cone of the other side has no part in it."""
    positions, turns = machine.poses(300)
    lean = leans(machine, positions, turns)[side == "platform"].max(axis=1)
    width = float(np.median(lean))
    robot = Hexapod(**machine.given, **{f"max_angle_{side}_joint": width})
    axes, status = robot.inverse_batch(positions, turns)
    assert ((status == Status.OK) == (lean <= width)).all()
    assert set(status) == {Status.OK, Status.UNREACHABLE}
    block = made(machine, compiled(MECHANISM), **{f"max_angle_{side}_joint": width})
    for i in range(12):
        name, found = block.inverse(positions[i], turns[i], (), (0.0,) * 6)
        assert name == Status(status[i]).softmotion and (found is None or found == tuple(axes[i]))
    assert not robot.forward_batch(machine.axes(positions, turns))[3].any()  # forward kinematics tests no limits


@pytest.mark.long
def test_each_joint_has_its_cone() -> None:
    """For every leg there is a pose at which its joint leans the most, and the cone that this just fits decides."""
    machine = machines()["lopsided"]
    positions, turns = machine.poses(300)
    for side, lean in zip(("base", "platform"), leans(machine, positions, turns), strict=True):
        most = lean.argmax(axis=1)
        assert set(most) == set(range(6))
        for leg in range(6):
            row = int(np.flatnonzero(most == leg)[0])
            for width, status in ((lean[row, leg] + 1e-6, Status.OK), (lean[row, leg] - 1e-6, Status.UNREACHABLE)):
                robot = Hexapod(**machine.given, **{f"max_angle_{side}_joint": width})
                assert robot.inverse_batch(positions[row : row + 1], turns[row : row + 1])[1] == [status]


def test_the_edge_of_a_cone_belongs_to_it() -> None:
    machine = machines()["asymmetric"]
    home = (machine.home[:3], machine.home_turn)
    narrow = Hexapod(**machine.given, max_angle_base_joint=0.0, max_angle_platform_joint=0.0)
    assert narrow.inverse(home) == machine.robot.inverse(home)
    assert made(machine, compiled(MECHANISM), max_angle_base_joint=0.0).inverse(*home, (), (0.0,) * 6)[0] == OK
    assert refusal(narrow.inverse, (machine.home[:3] + 1.0, machine.home_turn)) is Status.UNREACHABLE


@pytest.mark.long
def test_a_straight_angle_is_no_bound() -> None:
    """The platform passes through the base, so that every leg points the other way: in the same mode, and accepted."""
    machine = machines()["nominal"]
    positions, turns = machine.poses(300, turn=60.0)
    default, wide = machine.robot, Hexapod(**machine.given, max_angle_base_joint=180.0, max_angle_platform_joint=180.0)
    assert np.array_equal(default.inverse_batch(positions, turns)[1], wide.inverse_batch(positions, turns)[1])
    lean = np.max(leans(machine, positions, turns))
    assert lean > 30.0
    bounded = Hexapod(**machine.given, max_angle_base_joint=179.9, max_angle_platform_joint=179.9)
    assert np.array_equal(default.inverse_batch(positions, turns)[1], bounded.inverse_batch(positions, turns)[1])
