"""Near several right angles at once no pose of a machine is refused on its branch, whatever the reference is.

There several steps of a closed form lose digits at once: a root near zero has half of them, and a nearly free angle may
have none. A later step would then refuse poses that the machine has: of the arm whose parallel axes come last, every
twentieth.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
import softkin
from numpy.random import Generator
from softkin import Status

from tests.languages.language import Language
from tests.machines.made import Array, made
from tests.machines.parallel_machines import LAST
from tests.machines.spoken import EVERY_OTHER, answered

REFERENCES = ("own", "zero", "far")
"""The pose itself, zero, and axes within two turns."""
_TURNS = 720.0
_LONG_WRIST = {"d1": -90.0, "a2": -470.0, "a3": -340.0, "d4": -520.0, "d5": -410.0, "d6": -420.0}
_FIVE_BAR = ("base_distance", "arm_length_1", "arm_length_2", "rod_length_1", "rod_length_2")


@dataclass(frozen=True)
class Kind:
    """One kind of machine: the name of its class, its sizes in its own unit, and which axes slide."""

    machine: str
    sizes: Mapping[str, Mapping[str, float]]
    slides: tuple[int, ...] = ()


def _sizes(unequal: Mapping[str, float], equal: Mapping[str, float]) -> dict[str, Mapping[str, float]]:
    found = {"unequal": unequal, "equal": equal}
    return found | {f"{label}, in metres": {n: v / 1000.0 for n, v in sizes.items()} for label, sizes in found.items()}


KINDS = {
    "three parallel axes first": Kind(
        "Ac6ThreeParallel",
        _sizes(
            {"d1": 120.0, "a2": -600.0, "a3": -560.0, "d4": 160.0, "d5": 110.0, "d6": 95.0},
            {"d1": 100.0, "a2": -400.0, "a3": -400.0, "d4": 0.0, "d5": 100.0, "d6": 100.0},
        )
        | {"wrist longer than its links": _LONG_WRIST},
    ),
    "three parallel axes last": Kind(
        LAST,
        _sizes(
            {"link_1": 310.0, "link_2": 140.0, "link_3": 120.0, "link_4": 380.0, "link_5": 350.0, "link_6": 90.0},
            {"link_1": 100.0, "link_2": 100.0, "link_3": 100.0, "link_4": 400.0, "link_5": 400.0, "link_6": 100.0},
        ),
    ),
    "spherical wrist": Kind(
        "ArticulatedRobot6DOF",
        _sizes(
            {"d1": 410.0, "a1": 35.0, "a2": 450.0, "d3": 45.0, "a3": 30.0, "d4": 430.0, "d6": 85.0},
            {"d1": 400.0, "a1": 0.0, "a2": 420.0, "d3": 0.0, "a3": 0.0, "d4": 420.0, "d6": 80.0},
        ),
    ),
    "palletizer": Kind(
        "Palletizer",
        _sizes(
            {"shoulder_offset": 90.0, "link_length_1": 410.0, "link_length_2": 520.0, "wrist_offset_x": 70.0},
            {"link_length_1": 400.0, "link_length_2": 400.0},
        ),
    ),
    "delta": Kind(
        "DeltaC",
        _sizes(
            {"base_radius": 190.0, "arm_length": 310.0, "rod_length": 720.0, "plate_radius": 45.0},
            {"base_radius": 200.0, "arm_length": 300.0, "rod_length": 300.0, "plate_radius": 50.0},
        ),
    ),
    "five-bar": Kind(
        "DualScara",
        _sizes(dict(zip(_FIVE_BAR, (210.0, 310.0, 260.0, 390.0, 460.0), strict=True)), dict.fromkeys(_FIVE_BAR, 300.0)),
        (2,),
    ),
}


def class_of(kind: Kind) -> type[softkin.Mechanism]:
    """The class of a kind: of the package, or of a machine of the tests."""
    found: type[softkin.Mechanism] = getattr(softkin, kind.machine, None) or type(made(kind.machine).robot)
    return found


@dataclass(frozen=True)
class Sized:
    """A machine of a kind with some sizes, without limits."""

    label: str
    robot: softkin.Mechanism
    reach: float
    slides: tuple[int, ...]

    def axes(self, count: int, rng: Generator) -> Array:
        """Axis values: every joint at a right angle, 1e-1 to 1e-13 degrees beside one, or, rarely, anywhere."""
        shape = (count, len(self.robot.AXES))
        beside = rng.choice([-1.0, 1.0], shape) * 10.0 ** -rng.integers(1, 14, shape).astype(float)
        alike = rng.choice([-1.0, 0.0, 1.0], shape) * 10.0 ** -rng.integers(1, 14, (count, 1)).astype(float)
        beside = np.where(rng.random(shape) < 0.5, 0.0, beside)
        axes = 90.0 * rng.integers(-2, 3, shape) + np.where(rng.random((count, 1)) < 0.3, alike, beside)
        axes = np.where(rng.random(shape) < 0.1, rng.uniform(-180.0, 180.0, shape), axes)
        for slide in self.slides:
            axes[:, slide] = rng.uniform(-1.0, 1.0, count) * self.reach
        found: Array = axes[self.robot.forward_batch(axes)[3] == Status.OK]
        assert len(found) > count / 10
        return found

    def missed(self, axes: Array, found: Array) -> Array:
        """How far the poses at the axes found are from those at the axes, the larger of reaches and radians."""
        (positions, rotations), (others, turned) = (self.robot.forward_batch(a)[:2] for a in (axes, found))
        shifts = np.abs(others - positions).max(axis=1) / self.reach
        turns = np.abs(turned - rotations).max(axis=(1, 2)) if self.robot.READS_ROTATION else 0.0
        return np.asarray(np.maximum(shifts, turns))


def sized(kind: Kind) -> Iterator[Sized]:
    for label, sizes in kind.sizes.items():
        robot = class_of(kind)(**sizes, check_limits=False)
        yield Sized(label, robot, sum(map(abs, sizes.values())), kind.slides)


def references(word: str, axes: Array, rng: Generator) -> Array:
    """Reference axes for every pose."""
    if word == "own":
        return axes
    return np.zeros_like(axes) if word == "zero" else rng.uniform(-_TURNS, _TURNS, axes.shape)


WITHIN = 1e-11
"""Of what is missed: an angle is free below 2e-12 of its scale, and two may be, each with a chord of 2."""
EVERY = pytest.mark.parametrize("name", KINDS)
pytestmark = pytest.mark.slow


def lost(machine: Sized, count: int, seed: int, each: int = 1) -> list[tuple[str, str, list[float]]]:
    """The poses, of so many by this step, that are refused, or met with an error that is more than rounding."""
    rng = np.random.default_rng(seed)
    drawn = machine.axes(count, rng)
    axes, near = drawn[::each], np.concatenate([references(word, drawn, rng)[::each] for word in REFERENCES])
    rows = np.tile(np.arange(len(axes)), len(REFERENCES))
    positions, rotations, configurations, _ = (part[rows] for part in machine.robot.forward_batch(axes))
    answers, statuses = machine.robot.inverse_batch(positions, rotations, configurations, near)
    found = statuses != Status.OK
    found[~found] = machine.missed(axes[rows[~found]], answers[~found]) > WITHIN
    return [(machine.label, REFERENCES[k // len(axes)], axes[rows[k]].tolist()) for k in np.flatnonzero(found)]


@EVERY
def test_no_pose_is_lost(name: str) -> None:
    assert [pose for machine in sized(KINDS[name]) for pose in lost(machine, 8000, 32, each=11)] == []


CROSSING = ((0.0, 0.01, -1e-13, 0.0, 0.0, -90.0), (90.0, -0.003, 1e-12, 0.0, 0.0, 0.0))
"""Axes (degrees) of the arm whose parallel axes come last: if A3 is zero, the free A2 is parallel to them, and the arm
is stretched at one value of it alone. Steps on the closure leave this line for another one, which crosses it at A2 = 0.
"""


@pytest.mark.parametrize("axes", CROSSING)
def test_where_free_angles_cross_the_nearest_value_is_found(axes: tuple[float, ...]) -> None:
    """Only a value of the free angle that is near enough meets the pose."""
    machine = next(sized(KINDS["three parallel axes last"]))
    answer = machine.robot.inverse(*machine.robot.forward(axes), (0.0,) * 6)
    assert machine.missed(np.array([axes]), np.array([answer])).max() <= WITHIN


@EVERY
def test_no_pose_is_lost_one_by_one(name: str) -> None:
    """On plain numbers: on the branch, and among all solutions."""
    rng = np.random.default_rng(33)
    for machine in sized(KINDS[name]):
        for axes in machine.axes(30, rng).tolist():
            frame, configuration = machine.robot.forward(axes)
            for word in REFERENCES:
                near = references(word, np.array([axes]), rng)[0].tolist()
                answer = machine.robot.inverse(frame, configuration, near)
                assert machine.missed(np.array([axes]), np.array([answer])).max() <= WITHIN
                assert any(s.axes is not None for s in machine.robot.inverse_all(frame, near))


@EVERY_OTHER
def test_other_languages_lose_no_pose(language: Language | None) -> None:
    """Of the arm whose parallel axes come last."""
    rng, machine = np.random.default_rng(34), next(sized(KINDS["three parallel axes last"]))
    axes = machine.axes(600 if language else 90, rng)
    near = np.concatenate([references(REFERENCES[k % 3], axes[k : k + 1], rng) for k in range(len(axes))])
    assert machine.missed(axes, answered(language, made(LAST), machine.robot, axes, near)).max() <= WITHIN


def test_what_the_machine_does_not_reach_stays_refused() -> None:
    """Poses beyond the reach, next to where the branches meet and the wrist is free."""
    for machine in sized(KINDS["three parallel axes first"]):
        axes = machine.axes(30, np.random.default_rng(35))
        positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
        beyond = positions + np.array([0.0, 0.0, 2.5 * machine.reach])
        statuses = machine.robot.inverse_batch(beyond, rotations, configurations, axes)[1]
        assert (statuses == softkin.Status.UNREACHABLE).all()
