"""Machines of any size, likely and absurd: no call faults, Structured Text ends as Python does, and home is found."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.random import Generator
from softkin import Hexapod

from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod.machines import machines, rotation
from tests.catalogue.refusals import status_of
from tests.text.controller import OK, Controller
from tests.text.units import compiled

pytestmark = pytest.mark.slow

ANGLES = ("home_roll", "home_pitch", "home_yaw")
KINDS: dict[str, Callable[[Generator, float], float]] = {
    "disturbed": lambda rng, value: float(np.clip(value + rng.normal() * 10.0 ** rng.uniform(-3, 2), -1e9, 1e9)),
    "far apart": lambda rng, value: float(np.clip(value + rng.normal() * 10.0 ** rng.uniform(-3, 9), -1e9, 1e9)),
    "at the ends": lambda rng, value: float(rng.choice([0.0, 1e9, -1e9, value, 1e-9, 1e-300])),
    "any size": lambda rng, value: float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-12, 9)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_machine_of_any_shape(kind: str) -> None:
    """The block accepts exactly the dimensions that Python accepts, and both answer alike."""
    rng, started = np.random.default_rng(len(kind)), 0
    for _ in range(20):
        given = {n: v if n in ANGLES else KINDS[kind](rng, v) for n, v in machines()["nominal"].given.items()}
        given |= {n: float(rng.uniform(-360.0, 360.0)) for n in ANGLES if rng.random() < 0.3}
        block = Controller(compiled(MECHANISM), MECHANISM)
        status = block.initialise(given)
        assert status == status_of(Hexapod, **given).softmotion
        if status == OK:
            started += 1
            same_ends(block, Hexapod(**given), rng)
    assert started >= {"disturbed": 17, "at the ends": 2}.get(kind, 0)


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1e3, 7e5])
def test_a_machine_of_any_size(size: float) -> None:
    """The same machine in another unit of length: home is found, and so is what lies around it."""
    machine = machines()["asymmetric"]
    given = {n: v if n in ANGLES else v * size for n, v in machine.given.items()}
    robot, block = Hexapod(**given), Controller(compiled(MECHANISM), MECHANISM)
    assert block.initialise(given) == OK
    for position, turn in zip(*machine.poses(8), strict=True):
        axes = robot.inverse((position * size, turn))
        assert robot.forward(axes)[0].position == pytest.approx(tuple(position * size), rel=1e-9, abs=1e-9 * size)
        assert block.forward(axes)[1][0] == robot.forward(axes)[0].position
    same_ends(block, robot, np.random.default_rng(1))


def same_ends(block: Controller, robot: Hexapod, rng: Generator) -> None:
    """At home, around it, and at any lengths."""
    home = np.array([robot.parameters[f"home_{c}"] for c in "xyz"])
    turn = rotation(*(robot.parameters[n] for n in ANGLES))
    size = max(1e-12, float(np.abs(home).max()))
    for k in range(4):
        position = np.clip(home + (k > 0) * rng.normal(size=3) * size * 10.0 ** rng.uniform(-6, 1), -1e9, 1e9)
        rows = turn if k < 3 else rotation(*rng.uniform(-180.0, 180.0, 3))
        status, found = block.inverse(position, rows, (), (0.0,) * 6)
        assert status == status_of(robot.inverse, (position, rows)).softmotion
        axes = found or tuple(10.0 ** rng.uniform(-9, 9, 6))
        ended, pose = block.forward(axes)
        assert ended == status_of(robot.forward, axes).softmotion
        assert block.jacobian(axes)[0] == status_of(robot.jacobian, axes).softmotion
        block.is_singular(axes)
        if k == 0 and found:
            assert ended == OK and np.abs(np.array(pose[0]) - home).max() <= 1e-9 * size
