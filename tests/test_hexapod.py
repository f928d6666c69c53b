"""The hexapod: the whole pose, forward kinematics by iteration, one determinant as its margin."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import softkin
from numpy.testing import assert_allclose
from numpy.typing import NDArray
from softkin import Hexapod, KinematicsError, Status

from derive.build import build
from derive.kinematics import Kinematics
from derive.mechanisms.kin_hexapod import MECHANISM
from derive.program import Iterate, Program
from derive.program import Status as Outcome
from derive.run import run
from tests.execution.controller import BAD_INPUT, NOT_INITIALIZED, OK, UNREACHABLE, Controller
from tests.execution.units import compiled

Array = NDArray[np.float64]
IMPOSSIBLE = "SMC_TRAFO_INVALID_CONSTELLATION"

# LinuxCNC, genhexkins, its default geometry (inch): lengths that its own functions compute
INCH_BASE = ((-22.95, 13.25), (22.95, 13.25), (22.95, 13.25), (0, -26.5), (0, -26.5), (-22.95, 13.25))
INCH_PLATFORM = ((-1, 11.5), (1, 11.5), (10.459, -4.884), (9.459, -6.616), (-9.459, -6.616), (-10.459, -4.884))
INCH_CASES = {
    (0, 0, 20, 0, 0, 0): (29.746680487073, 29.746680487073, 29.746714726168, 29.746363424795, 29.746363424795, 29.746714726168),
    (2, 1, 22, 5, -3, 10): (31.759871169751, 31.881509190096, 28.585823216412, 33.902245895411, 29.170986025026, 32.229428923312),
    (-3, 2, 25, -8, 6, -15): (
        32.047073012586, 32.191238992908, 35.261838360772, 32.093952052596, 38.929389073320, 31.114809124200,
    ),
}


class Machine:
    """A hexapod with what the tests need to know of it."""

    def __init__(self, base: Array, platform: Array, home: tuple[float, ...], shift: float, **more: float) -> None:
        self.base, self.platform, self.home, self.shift = base, platform, np.array(home, dtype=float), shift
        self.given = {
            f"{side}_{i + 1}_{c}": float(points[i][k])
            for side, points in (("base", base), ("platform", platform))
            for i in range(6)
            for k, c in enumerate("xyz")
        }
        self.given |= {f"home_{n}": float(v) for n, v in zip(("x", "y", "z", "roll", "pitch", "yaw"), home, strict=True)} | more
        self.robot = Hexapod(**self.given)

    def poses(self, count: int, turn: float = 25.0) -> tuple[Array, Array]:
        """Poses all over a realistic workspace: shifted each way, and turned by each angle, away from home."""
        away = np.random.default_rng(count).uniform(-1.0, 1.0, (count, 6)) * ([self.shift] * 3 + [turn] * 3)
        return self.home[:3] + away[:, :3], rotations(away[:, 3:]) @ rotations(self.home[None, 3:])

    def lengths(self, positions: Array, turns: Array) -> Array:
        """Axis values by definition."""
        ends = positions[:, None] + np.einsum("nij,kj->nki", turns, self.platform)
        return np.linalg.norm(ends - self.base, axis=2)

    def rows(self, position: Array, turn: Array) -> Array:
        """How lengths change with a twist of the platform: direction, and moment, of every leg."""
        arms = self.platform @ turn.T
        spans = position + arms - self.base
        along = spans / np.linalg.norm(spans, axis=1)[:, None]
        return np.concatenate([along, np.cross(arms, along)], axis=1)


def rotations(degrees: Array) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = (f(np.radians(degrees)).T for f in (np.cos, np.sin))
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def flat(points: tuple[tuple[float, float], ...]) -> Array:
    return np.array([(x, y, 0.0) for x, y in points])


@cache
def machines() -> dict[str, Machine]:
    nominal = {p.name: p.nominal for p in MECHANISM.parameters}
    base, platform = (np.array([[nominal[f"{s}_{i}_{c}"] for c in "xyz"] for i in range(1, 7)]) for s in ("base", "platform"))
    strange = np.random.default_rng(5).uniform(-60.0, 60.0, (2, 6, 3))
    tool = np.array([0.0, 0.0, -120.0])
    return {
        "inch": Machine(flat(INCH_BASE), flat(INCH_PLATFORM), (0, 0, 20, 0, 0, 0), 7.0),
        "nominal": Machine(base, platform, (0, 0, 600, 0, 0, 0), 180.0),
        "asymmetric": Machine(
            base + strange[0], platform + strange[1], (30, -20, 580, 5, -4, 10), 150.0, offset_l1=12.0, offset_l5=-40.0
        ),
        "hanging, with a tool": Machine(base, (platform + tool) * (1, -1, -1), (0, 0, -600, 180, 0, 0), 120.0),
        "sideways": Machine(base[:, [2, 1, 0]] * (1, 1, -1), platform, (600, 0, 0, 0, 90, 0), 120.0),
    }


@pytest.fixture(params=["inch", "nominal", "asymmetric", "hanging, with a tool", "sideways"])
def machine(request: pytest.FixtureRequest) -> Machine:
    return machines()[request.param]


@cache
def kinematics() -> Kinematics:
    return build(MECHANISM)


def offsets(machine: Machine) -> Array:
    return np.array([machine.given.get(f"offset_l{i}", 0.0) for i in range(1, 7)])


@pytest.mark.parametrize("pose", INCH_CASES)
def test_the_lengths_that_linuxcnc_computes(pose: tuple[float, ...]) -> None:
    robot = machines()["inch"].robot
    turn = rotations(np.array([pose[3:]], dtype=float))[0]
    axes = robot.inverse((pose[:3], turn))
    assert_allclose(axes, INCH_CASES[pose], atol=5e-12)
    frame, configuration = robot.forward(axes)
    assert configuration == ()
    assert_allclose(frame.position, pose[:3], atol=1e-12)
    assert_allclose(frame.rotation, turn, atol=1e-13)


def test_there_and_back_all_over_the_workspace(machine: Machine) -> None:
    positions, turns = machine.poses(3000)
    axes, status = machine.robot.inverse_batch(positions, turns)
    assert not status.any()
    assert_allclose(axes - offsets(machine), machine.lengths(positions, turns), rtol=1e-13)
    back, turned, configurations, status = machine.robot.forward_batch(axes)
    assert not status.any() and configurations.shape == (3000, 0)
    assert_allclose(back, positions, atol=1e-11 * machine.shift)
    assert_allclose(turned, turns, atol=1e-11)


def test_far_poses_are_found_or_refused_never_mistaken(machine: Machine) -> None:
    """Beyond the realistic: whatever answers has these lengths, in the machine's assembly mode."""
    positions, turns = machine.poses(2000, turn=100.0)
    axes = machine.lengths(positions, turns) + offsets(machine)
    back, turned, _, status = machine.robot.forward_batch(axes)
    assert set(status) <= {Status.OK, Status.IMPOSSIBLE}
    found = status == Status.OK
    assert found.mean() > 0.5
    assert_allclose(machine.lengths(back[found], turned[found]) + offsets(machine), axes[found], rtol=1e-9)
    signs = [np.sign(np.linalg.det(machine.rows(p, r))) for p, r in zip(back[found], turned[found], strict=True)]
    assert len(set(signs)) == 1


def path(machine: Machine, count: int = 1000) -> tuple[Array, Array]:
    phase = np.linspace(0.0, 2 * np.pi, count)[:, None] * (1, 2, 3, 2, 1, 3)
    away = np.sin(phase) * ([machine.shift] * 3 + [20.0] * 3)
    return machine.home[:3] + away[:, :3], rotations(away[:, 3:]) @ rotations(machine.home[None, 3:])


def bounded(program: Program, passes: int) -> Program:
    return replace(program, body=tuple(replace(s, limit=passes) if isinstance(s, Iterate) else s for s in program.body))


def test_five_passes_from_the_neighbouring_pose(machine: Machine) -> None:
    kin = kinematics()
    assert kin.forward_from is not None
    positions, turns = path(machine)
    axes = machine.lengths(positions, turns) + offsets(machine)
    settings = {p.name: machine.given.get(p.name, p.default or 0.0) for p in kin.parameters}
    constants, status = run(kin.setup, {name: np.asarray(float(v)) for name, v in settings.items()})
    assert status == Outcome.OK
    given = dict(constants) | {f"axis_l{i + 1}": axes[1:, i] for i in range(6)}
    given |= {f"start_{c}": positions[:-1, i] for i, c in enumerate("xyz")}
    given |= {f"start_r{i + 1}{k + 1}": turns[:-1, i, k] for i in range(3) for k in range(3)}
    outputs, status = run(bounded(kin.forward_from, 5), given)
    assert all(s == Outcome.OK for s in status)
    assert_allclose(np.stack([outputs[c] for c in "xyz"], axis=1), positions[1:], atol=1e-11 * machine.shift)


def test_a_start_is_where_the_iteration_starts(machine: Machine) -> None:
    positions, turns = path(machine, 40)
    robot, frame = machine.robot, None
    axes, _ = robot.inverse_batch(positions, turns)
    together = robot.forward_batch(axes, (positions, turns))
    for i, values in enumerate(axes):
        frame, _ = robot.forward(values, start=frame or (positions[0], turns[0]))
        assert_allclose(frame.position, positions[i], atol=1e-11 * machine.shift)
        assert_allclose(together[0][i], frame.position, atol=1e-11 * machine.shift)
        assert_allclose(robot.forward(values)[0].position, frame.position, atol=1e-11 * machine.shift)
    one = robot.forward_batch(axes, (positions[0], turns[0]))
    assert not one[3].any() and not together[3].any()


def test_calls_leave_no_trace() -> None:
    robot = machines()["nominal"].robot
    positions, turns = machines()["nominal"].poses(20)
    axes = [robot.inverse(pose) for pose in zip(positions, turns, strict=True)]
    first = [robot.forward(a) for a in axes]
    assert [robot.forward(a) for a in reversed(axes)][::-1] == first


def test_the_jacobian_is_the_inverse_of_the_rows(machine: Machine) -> None:
    assert machine.robot.JACOBIAN_ROWS == ("x", "y", "z", "turn x", "turn y", "turn z")
    for position, turn in zip(*machine.poses(30), strict=True):
        jacobian = np.array(machine.robot.jacobian(machine.robot.inverse((position, turn))))
        assert_allclose(jacobian @ machine.rows(position, turn), np.eye(6), atol=1e-9)


def test_the_margin_is_the_normalised_determinant(machine: Machine) -> None:
    centred = machine.platform - machine.platform.mean(axis=0)
    radius = np.sqrt((centred**2).sum(axis=1).mean())
    for position, turn in zip(*machine.poses(30), strict=True):
        axes = machine.robot.inverse((position, turn))
        margin = machine.robot.singularity(axes).margins["rods_dependent"]
        assert margin == pytest.approx(np.linalg.det(machine.rows(position, turn)) / radius**3, rel=1e-9)


@pytest.mark.parametrize("yaw", [90.0, -90.0])
@pytest.mark.parametrize("position", [(0, 0, 20), (3, 2, 20), (-4, 5, 26)])
def test_fichter_a_quarter_turn_is_singular_wherever_it_is(yaw: float, position: tuple[float, ...]) -> None:
    machine = machines()["inch"]
    robot = machine.robot
    at, near, before = (rotations(np.array([[0.0, 0.0, np.sign(yaw) * a]]))[0] for a in (90.0, 89.995, 85.0))
    for turn in (at, near):
        with pytest.raises(KinematicsError) as refused:
            robot.inverse((position, turn))
        assert refused.value.status is Status.UNREACHABLE
        assert robot.singularity(machine.lengths(np.array([position], dtype=float), turn[None])[0]).is_singular
    assert not robot.singularity(robot.inverse((position, before))).is_singular


def test_a_path_into_the_singularity_is_flagged_before_it() -> None:
    machine = machines()["inch"]
    free = Hexapod(**machine.given, min_type2_margin=0.0)
    angles = np.linspace(80.0, 89.999, 2000)
    turns = rotations(np.stack([0 * angles, 0 * angles, angles], axis=1))
    flags = [free.singularity(free.inverse(((1.0, 2.0, 21.0), turn))).is_singular for turn in turns]
    assert flags == sorted(flags) and flags[-1] and not flags[0]
    with pytest.raises(KinematicsError):
        free.inverse(((1.0, 2.0, 21.0), rotations(np.array([[0.0, 0.0, 95.0]]))[0]))  # the other assembly mode


@pytest.mark.parametrize(
    "axes", [(1e6,) * 6, (1e-3,) * 6, (0.0,) * 6, (-650.0,) * 6, (650.0, 650.0, 650.0, 650.0, 650.0, 5000.0), (1e9,) * 6]
)
def test_lengths_that_no_pose_has(axes: tuple[float, ...]) -> None:
    robot = machines()["nominal"].robot
    with pytest.raises(KinematicsError) as refused:
        robot.forward(axes)
    assert refused.value.status is Status.IMPOSSIBLE
    assert robot.forward_batch([axes])[3] == [Status.IMPOSSIBLE] and np.isnan(robot.forward_batch([axes])[0]).all()
    assert robot.singularity(axes).is_singular
    assert controller("nominal").forward(axes) == (IMPOSSIBLE, None)
    assert controller("nominal").is_singular(axes)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 1.1e9, 1e300])
def test_what_is_no_number(wrong: float) -> None:
    robot, eye = machines()["nominal"].robot, np.eye(3)
    axes = (wrong, *(650.0,) * 5)
    for call in (
        lambda: robot.forward(axes),
        lambda: robot.forward((650.0,) * 6, start=((wrong, 0.0, 600.0), eye)),
        lambda: robot.forward((650.0,) * 6, start=((0.0, 0.0, 600.0), eye * 1.1)),
        lambda: robot.inverse(((wrong, 0.0, 600.0), eye)),
        lambda: robot.inverse(((0.0, 0.0, 600.0), eye * 1.1)),
        lambda: robot.inverse(((0.0, 0.0, 600.0), np.diag((1.0, 1.0, -1.0)))),
        lambda: robot.jacobian(axes),
    ):
        with pytest.raises(KinematicsError) as refused:
            call()
        assert refused.value.status is Status.BAD_INPUT
    assert controller("nominal").forward(axes) == (BAD_INPUT, None)
    assert controller("nominal").inverse((0.0, 0.0, wrong), eye, (), (0.0,) * 6) == (BAD_INPUT, None)


def refused_parameters() -> dict[str, dict[str, float]]:
    given = machines()["nominal"].given
    return {
        "nothing given": dict.fromkeys(given, 0.0),
        "a singular home": {**given, "home_yaw": 90.0},
        "a platform that is a point": {**given, **{n: 0.0 for n in given if n.startswith("platform")}},
        "a home in the base": {**given, "home_z": 0.0},
        "joints on one line": {**given, **{n: 0.0 for n in given if n.startswith("platform") and n.endswith("y")}},
        "no number": {**given, "base_3_y": np.nan},
        "limits the wrong way round": {**given, "lower_l2": 700.0, "upper_l2": 600.0},
        "far too large": {**given, "platform_4_x": 2e9},
    }


@pytest.mark.parametrize("case", refused_parameters())
def test_machines_that_cannot_work_are_refused(case: str) -> None:
    given = refused_parameters()[case]
    with pytest.raises(KinematicsError) as refused:
        Hexapod(**given)
    assert refused.value.status is Status.NOT_INITIALIZED
    assert Controller(compiled(MECHANISM), MECHANISM).initialise(given) == NOT_INITIALIZED


def test_limits_refuse_leg_by_leg() -> None:
    given = machines()["nominal"].given
    legs = Hexapod(**given).inverse(((40.0, 0.0, 600.0), np.eye(3)))
    for i, length in enumerate(legs, 1):
        tight = Hexapod(**given, **{f"lower_l{i}": 300.0, f"upper_l{i}": length - 0.01})
        with pytest.raises(KinematicsError) as refused:
            tight.inverse(((40.0, 0.0, 600.0), np.eye(3)))
        assert refused.value.status is Status.UNREACHABLE
    unchecked = Hexapod(**given, lower_l1=1.0, upper_l1=2.0, check_limits=False)
    assert unchecked.inverse(((40.0, 0.0, 600.0), np.eye(3))) == legs


def test_the_catalogue_knows_it() -> None:
    assert softkin.catalogue()["Kin_Hexapod"] is Hexapod
    image = machines()["nominal"].robot.orientation_image()
    assert image.freedom == "three"


@cache
def controller(name: str) -> Controller:
    made = Controller(compiled(MECHANISM), MECHANISM)
    assert made.initialise(machines()[name].given) == OK
    return made


@pytest.mark.parametrize("name", ["inch", "nominal", "asymmetric", "hanging, with a tool", "sideways"])
def test_the_controller_agrees(name: str) -> None:
    machine, block = machines()[name], controller(name)
    positions, turns = machine.poses(60, turn=40.0)
    axes, _ = machine.robot.inverse_batch(positions, turns)
    batch, turned, _, _ = machine.robot.forward_batch(axes)
    tolerance = 1e-12 * np.abs(positions).max()
    for i, (position, turn) in enumerate(zip(positions, turns, strict=True)):
        status, found = block.inverse(position, turn, (), (0.0,) * 6)
        if np.isnan(axes[i, 0]):
            assert status == UNREACHABLE
            continue
        assert status == OK and machine.robot.inverse((position, turn)) == found
        assert_allclose(found, axes[i], atol=tolerance)
        status, pose = block.forward(found)
        frame, _ = machine.robot.forward(found)
        assert status == OK and pose[:2] == (frame.position, frame.rotation) and not any(pose[2])
        assert_allclose(batch[i], frame.position, atol=1e3 * tolerance)
        assert_allclose(turned[i], frame.rotation, atol=1e-10)
        assert block.jacobian(found) == (OK, machine.robot.jacobian(found))
        assert block.is_singular(found) == machine.robot.singularity(found).is_singular


def test_the_controller_says_what_the_flange_can_do() -> None:
    block, turn = controller("nominal"), rotations(np.array([[10.0, -20.0, 30.0]]))[0]
    status, (freedom, *_) = block.image("GetFlangeOrientationImageTotal")
    assert (status, freedom) == (OK, "three")
    status, (freedom, zero, *_) = block.image_with_orientation(turn)
    assert (status, freedom) == (OK, "zero")
    assert_allclose(zero, turn, atol=0.0)
    assert block.image_with_orientation(turn * 2.0)[0] == BAD_INPUT
    empty = Controller(compiled(MECHANISM), MECHANISM)
    assert empty.forward((650.0,) * 6)[0] == NOT_INITIALIZED and empty.is_singular((650.0,) * 6)
