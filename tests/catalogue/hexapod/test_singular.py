"""The Jacobian and its normalised determinant: they are what a twist says, and Fichter's singularity is where it is."""

import numpy as np
import pytest
from softkin import Hexapod, KinematicsError, Status

from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod.machines import Array, Machine, machines, rotation, rotations
from tests.catalogue.refusals import refusal
from tests.text.hexapod.blocks import controller, made
from tests.text.units import compiled

ANYWHERE = [(0, 0, 20), (3, 2, 20), (-4, 5, 26), (7, -7, 15)]


@pytest.mark.parametrize("yaw", [90.0, -90.0])
@pytest.mark.parametrize("position", ANYWHERE)
@pytest.mark.parametrize("name", ["inch", "nominal"])
def test_fichter_a_quarter_turn_is_singular_wherever_it_is(name: str, position: tuple[float, ...], yaw: float) -> None:
    """Machines of threefold symmetry with a level platform, at any translation."""
    machine = machines()[name]
    place = np.array(position, dtype=float) * (1.0 if name == "inch" else 30.0)
    at, near, before = (rotation(0.0, 0.0, np.sign(yaw) * a) for a in (90.0, 89.995, 80.0))
    assert abs(machine.normalised(place, at)) < 1e-2 * abs(machine.normalised(place, before))
    for turn in (at, near):
        assert refusal(machine.robot.inverse, (place, turn)) is Status.UNREACHABLE
        assert machine.robot.singularity(machine.axes(place, turn)).is_singular
        assert controller(name).is_singular(machine.axes(place, turn))
    axes = machine.robot.inverse((place, before))
    assert not machine.robot.singularity(axes).is_singular and not controller(name).is_singular(axes)


@pytest.mark.long
@pytest.mark.parametrize(("position", "tilt"), [((1.0, 2.0, 21.0), 0.0), ((-2.0, 0.0, 19.0), 4.0)])
def test_a_path_into_the_singularity_is_flagged_before_it(position: tuple[float, ...], tilt: float) -> None:
    """Regular, then flagged, then beyond: never beyond without a flag; and the inverse stops before it is lost."""
    machine = machines()["inch"]
    free, careful = Hexapod(**machine.given, min_type2_margin=0.0), machine.robot
    turns = rotations(np.stack([np.full(1200, tilt), np.zeros(1200), np.linspace(80.0, 100.0, 1200)], axis=1))
    side = machine.side(machine.home[:3], machine.home_turn)
    margins = side * np.array([machine.normalised(np.array(position), turn) for turn in turns])
    assert margins[0] > 0.05 and margins[-1] < -0.05
    _, status = free.inverse_batch(np.tile(position, (1200, 1)), turns)
    assert ((status == Status.OK) == (margins > 0.0)).all()
    _, status = careful.inverse_batch(np.tile(position, (1200, 1)), turns)
    assert ((status == Status.OK) == (margins >= 1e-3)).all()
    near = np.flatnonzero((margins > 0.0) & (margins < 5e-3))
    flags = [free.singularity(free.inverse((position, turns[i]))).is_singular for i in near]
    assert flags == [bool(margins[i] < 1e-3) for i in near] and flags == sorted(flags) and flags[-1] and not flags[0]


def test_an_asymmetric_machine_is_singular_elsewhere() -> None:
    """Its singularity is found on the way by the determinant alone, and flagged on either side of it."""
    machine = machines()["lopsided"]
    place = machine.home[:3]
    low, high = 0.0, 120.0
    side = machine.side(place, machine.home_turn)
    assert machine.side(place, turned(machine, high)) != side
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if machine.side(place, turned(machine, middle)) == side else (low, middle)
    assert abs(low - 90.0) > 0.5
    assert machine.robot.singularity(machine.axes(place, turned(machine, low - 1e-4))).is_singular
    assert not machine.robot.singularity(machine.axes(place, turned(machine, low - 3.0))).is_singular
    with pytest.raises(KinematicsError):
        machine.robot.inverse((place, turned(machine, low + 3.0)))


def turned(machine: Machine, yaw: float) -> Array:
    """The home rotation with more yaw."""
    return np.asarray(rotation(0.0, 0.0, yaw) @ machine.home_turn)


@pytest.mark.parametrize("least", [0.0, 1e-3, 0.3])
def test_how_near_is_a_parameter(least: float) -> None:
    machine = machines()["nominal"]
    robot, block = (
        Hexapod(**machine.given, min_type2_margin=least),
        made(machine, compiled(MECHANISM), min_type2_margin=least),
    )
    side = machine.side(machine.home[:3], machine.home_turn)
    for yaw in (0.0, 40.0, 70.0, 80.0, 89.0, 89.999, 91.0):
        turn = rotation(0.0, 0.0, yaw)
        accepted = side * machine.normalised(machine.home[:3], turn) >= max(least, 1e-12)
        assert (robot.inverse_batch([machine.home[:3]], [turn])[1][0] == Status.OK) == accepted
        assert (block.inverse(machine.home[:3], turn, (), (0.0,) * 6)[1] is not None) == accepted
