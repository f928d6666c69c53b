"""Poses at and next to many right angles at once, machines of several kinds, and the poses that these refuse."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import softkin
from numpy.random import Generator
from numpy.typing import NDArray
from softkin import Status

from tests.machines.made import made
from tests.machines.parallel_machines import LAST

Array = NDArray[np.float64]
REFERENCES = ("own", "zero", "far")
"""The pose itself, zero, and axes within two turns."""
_TURNS = 720.0
_FIVE_BAR = ("base_distance", "arm_length_1", "arm_length_2", "rod_length_1", "rod_length_2")


@dataclass(frozen=True)
class Kind:
    """One kind of machine: the name of its class, its sizes in its own unit, and which axes slide."""

    machine: str
    sizes: Mapping[str, Mapping[str, float]]
    slides: tuple[int, ...] = ()


def _in_metres(sizes: Mapping[str, float]) -> dict[str, float]:
    return {name: value / 1000.0 for name, value in sizes.items()}


def _sizes(unequal: Mapping[str, float], equal: Mapping[str, float]) -> dict[str, Mapping[str, float]]:
    return {"unequal": unequal, "equal": equal, "in metres": _in_metres(unequal), "equal, in metres": _in_metres(equal)}


KINDS = {
    "three parallel axes first": Kind(
        "Ac6ThreeParallel",
        _sizes(
            {"d1": 120.0, "a2": -600.0, "a3": -560.0, "d4": 160.0, "d5": 110.0, "d6": 95.0},
            {"d1": 100.0, "a2": -400.0, "a3": -400.0, "d4": 0.0, "d5": 100.0, "d6": 100.0},
        )
        | {
            "wrist longer than its links": {
                "d1": -90.0,
                "a2": -470.0,
                "a3": -340.0,
                "d4": -520.0,
                "d5": -410.0,
                "d6": -420.0,
            }
        },
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
