"""Newton's iteration and the determinant: passes, ends, and Fichter's singularity where it is."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from softkin import Hexapod, KinematicsError, Status

from derive.ir.program import Iterate, Statement
from derive.ir.program import Status as Outcome
from derive.ir.symbols import real
from derive.mechanisms.kin_hexapod import MECHANISM
from derive.plate.newton import LIMIT
from tests.catalogue.hexapod.machines import (
    Array,
    Machine,
    bounded,
    found_from,
    machines,
    rotation,
    rotations,
    search_changed,
)
from tests.catalogue.refusals import refusal
from tests.text.controller import IMPOSSIBLE
from tests.text.hexapod.blocks import controller, made
from tests.text.units import compiled

RATES = {real(f"{angle}_rate"): real(f"spin_{c}") for angle, c in zip(("roll", "pitch", "yaw"), "xyz", strict=True)}


@pytest.mark.long
def test_five_passes_from_the_neighbouring_pose(machine: Machine) -> None:
    """Every point of a path of 1000, from the one before it; the last pass only confirms."""
    positions, turns = machine.path()
    axes = machine.axes(positions, turns)
    found, status = found_from(bounded(5), machine, axes[1:], positions[:-1], turns[:-1])
    assert (status == Outcome.OK).all()
    assert_allclose(found, positions[1:], atol=1e-11 * machine.shift)


@pytest.mark.long
def test_the_number_of_passes_is_noticed() -> None:
    """Three passes are too few, and so are five where the rate of a turn is taken for those of roll, pitch and yaw."""

    def without_matrix(s: Statement) -> Statement:
        return (
            replace(s, limit=5, following=tuple(v.xreplace(RATES) for v in s.following))
            if isinstance(s, Iterate)
            else s
        )

    machine = machines()["asymmetric"]
    positions, turns = (values[::10] for values in machine.path(500))
    axes = machine.axes(positions, turns)
    for program in (bounded(3), search_changed(without_matrix)):
        _, status = found_from(program, machine, axes[1:], positions[:-1], turns[:-1])
        assert (status == Outcome.IMPOSSIBLE).any()
    _, status = found_from(bounded(LIMIT), machine, axes[1:], positions[:-1], turns[:-1])
    assert (status == Outcome.OK).all()


@pytest.mark.parametrize("name", ["nominal", "lopsided"])
@pytest.mark.parametrize(
    "axes",
    [(1e6,) * 6, (1e-3,) * 6, (0.0,) * 6, (-650.0,) * 6, (650.0, 650.0, 650.0, 650.0, 650.0, 5000.0), (9e8,) * 6],
)
def test_lengths_that_no_pose_has(name: str, axes: tuple[float, ...]) -> None:
    """They end in one status, in every language, from the home pose and from any start."""
    robot = machines()[name].robot
    axes = tuple(np.array(axes) + machines()[name].offsets)
    for start in (None, ((0.0, 0.0, 600.0), np.eye(3)), ((1e9, -1e9, 1e9), np.eye(3))):
        assert refusal(robot.forward, axes, start=start) is Status.IMPOSSIBLE
    position, turn, _, status = robot.forward_batch([axes])
    assert status == [Status.IMPOSSIBLE] and np.isnan(position).all() and np.isnan(turn).all()
    assert refusal(robot.jacobian, axes) is Status.IMPOSSIBLE
    assert robot.singularity(axes).is_singular
    block = controller(name)
    assert block.forward(axes) == block.jacobian(axes) == (IMPOSSIBLE, None)
    assert block.is_singular(axes)


@pytest.mark.long
def test_wild_lengths_end_alike_in_every_language(machine: Machine) -> None:
    """Some have a pose, most do not: no call faults, and all give the same answer to the last digit."""
    generator = np.random.default_rng(3)
    home = machine.axes(machine.home[:3], machine.home_turn)
    axes = home * generator.choice([0.6, 0.9, 1.0, 1.1, 1.5, 100.0], (40, 6), p=[0.05, 0.3, 0.2, 0.3, 0.1, 0.05])
    position, turn, _, status = machine.robot.forward_batch(axes)
    assert set(status) == {Status.OK, Status.IMPOSSIBLE}
    block = controller(name_of(machine))
    for i, values in enumerate(axes):
        name, pose = block.forward(values)
        assert name == Status(status[i]).softmotion
        if status[i] == Status.OK:
            frame, _ = machine.robot.forward(values)
            assert pose[:2] == (frame.position, frame.rotation)
            assert frame.position == tuple(position[i]) and np.array_equal(frame.rotation, turn[i])
            assert_allclose(machine.axes(position[i], turn[i]), values, rtol=1e-10)


@pytest.mark.parametrize("pitch", [90.0, -90.0, 89.999])
def test_where_roll_pitch_and_yaw_are_singular(machine: Machine, pitch: float) -> None:
    """A quarter turn of pitch away from the start: a pose is found or refused, never mistaken."""
    side = machine.side(machine.home[:3], machine.home_turn)
    turns = [rotation(0.0, pitch, 0.0) @ turned_by(machine, yaw) for yaw in (0.0, 10.0, 20.0, 30.0)]
    positions = machine.home[:3] + np.outer(np.arange(4) / 2.0, machine.home_turn[:, 2]) * machine.shift
    for turn in turns:
        axes = machine.axes(positions, np.array([turn] * 4))
        back, turned, _, status = machine.robot.forward_batch(axes)
        assert set(status) <= {Status.OK, Status.IMPOSSIBLE}
        found = status == Status.OK
        assert_allclose(machine.axes(back[found], turned[found]), axes[found], rtol=1e-9)
        assert {machine.side(p, r) for p, r in zip(back[found], turned[found], strict=True)} <= {side}


@pytest.mark.parametrize("name", ["nominal", "lopsided", "sideways"])
def test_a_quarter_turn_of_pitch_is_found(name: str) -> None:
    """Machines that can hold it, from home, from the pose itself, and past it: the angles count from the start."""
    machine = machines()[name]
    turn = rotation(0.0, 90.0, 0.0) @ rotation(0.0, 0.0, 20.0) @ machine.home_turn
    position = machine.home[:3] + machine.home_turn[:, 2] * machine.shift
    axes = machine.robot.inverse((position, turn))
    starts = (None, (position, turn), (position + 0.02 * machine.shift, turn @ rotation(2.0, -3.0, 4.0)))
    for start in starts:
        assert_allclose(machine.robot.forward(axes, start=start)[0].position, position, atol=1e-10 * machine.shift)
    past = rotation(0.0, 96.0, 0.0) @ rotation(0.0, 0.0, 20.0) @ machine.home_turn
    lengths = machine.axes(position, past)
    assert_allclose(machine.robot.forward(lengths, start=(position, turn))[0].rotation, past, atol=1e-9)


def name_of(machine: Machine) -> str:
    return next(name for name, one in machines().items() if one is machine)


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
    assert machine.side(place, turned_by(machine, high)) != side
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if machine.side(place, turned_by(machine, middle)) == side else (low, middle)
    assert abs(low - 90.0) > 0.5
    assert machine.robot.singularity(machine.axes(place, turned_by(machine, low - 1e-4))).is_singular
    assert not machine.robot.singularity(machine.axes(place, turned_by(machine, low - 3.0))).is_singular
    with pytest.raises(KinematicsError):
        machine.robot.inverse((place, turned_by(machine, low + 3.0)))


def turned_by(machine: Machine, yaw: float) -> Array:
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
