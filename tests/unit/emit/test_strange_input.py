"""What has numbers without being a sequence of them, and what has none: refused, or empty."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.mechanisms import catalogue

ROOT = Path(__file__).resolve().parents[3]
MECHANISMS = [m for _, m in catalogue()]
STRANGE: dict[str, Callable[[int], object]] = {
    "set": lambda n: set(map(float, range(n))),
    "frozenset": lambda n: frozenset(map(float, range(n))),
    "dict": lambda n: dict.fromkeys(map(float, range(n)), 0.0),
    "keys of a dict": lambda n: dict.fromkeys(map(float, range(n))).keys(),
    "bytes": lambda n: bytes(range(n)),
    "bytearray": lambda n: bytearray(range(n)),
    "complex numbers": lambda n: np.array([1j] * n),
    "array with a mask": lambda n: np.ma.array([1.0] * n, mask=[True] + [False] * (n - 1)),
    "array with an open mask": lambda n: np.ma.array([1.0] * n),
    "text": lambda n: "1" * n,
}


@pytest.mark.parametrize("kind", STRANGE)
def test_strange_axes_are_refused(kind: str) -> None:
    """Everywhere where numbers are expected: alone, in a row of a batch, and as the batch."""
    robot = softkin.ArticulatedRobot6DOF(d1=400.0, a2=455.0, d4=420.0)
    frame, strange = robot.forward((10.0,) * 6)[0], STRANGE[kind](6)
    calls: tuple[Callable[[], object], ...] = (
        lambda: robot.forward(strange),
        lambda: robot.orientation(strange),
        lambda: robot.jacobian(strange),
        lambda: robot.singularity(strange),
        lambda: robot.twist(strange, (0.0,) * 6),
        lambda: robot.axis_velocities((10.0,) * 6, strange),
        lambda: robot.inverse(frame, None, strange),
        lambda: robot.inverse((STRANGE[kind](3), frame.rotation)),
        lambda: robot.inverse((frame.position, [STRANGE[kind](3)] * 3)),
        lambda: robot.forward_batch(strange),
        lambda: robot.forward_batch([strange]),
        lambda: robot.forward_batch([(1.0,) * 6, strange]),
        lambda: robot.jacobian_batch([strange]),
        lambda: robot.singularity_batch([strange]),
        lambda: robot.inverse_batch([frame], None, None, [strange]),
        lambda: robot.inverse_batch([frame], None, None, strange),
    )
    for number, call in enumerate(calls):
        with pytest.raises(KinematicsError) as refusal:
            call()
        assert refusal.value.status is Status.BAD_INPUT, number


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_an_empty_batch_has_empty_arrays(mechanism: Mechanism) -> None:
    """No rows, in a list or an array: arrays of the documented shapes without rows."""
    robot = softkin.catalogue()[mechanism.name](**{p.name: p.nominal for p in mechanism.parameters})
    n, m, slots = len(robot.AXES), len(robot.CONFIGURATION), 2**robot.BRANCHES
    for machine in (robot, robot.with_base(softkin.Frame((1.0, 2.0, 3.0)))):
        for empty in ([], (), np.empty((0, n))):
            shapes = [a.shape for a in machine.forward_batch(empty)]
            assert shapes == [(0, 3), (0, 3, 3), (0, m), (0,)]
            rows = len(machine.JACOBIAN_ROWS)
            assert [a.shape for a in machine.jacobian_batch(empty)] == [(0, rows, n), (0,)]
            assert [a.shape for a in machine.singularity_batch(empty)] == [(0,), (0, len(machine.MARGINS))]
        near = [] if n else None
        for rotations in ([], np.empty((0, 3, 3))):
            assert [a.shape for a in machine.inverse_batch([], rotations, None, near)] == [(0, n), (0,)]
            assert [a.shape for a in machine.inverse_all_batch([], rotations, near)] == [(0, slots, n), (0, slots)]
        assert machine.inverse_batch(np.empty((0, 4, 4)), None, None, near)[0].shape == (0, n)
    if n:
        with pytest.raises(KinematicsError, match="must have shape"):
            robot.forward_batch([[]])


def test_the_package_says_its_version_and_its_licence() -> None:
    """One version; the licence of the project as a file of the wheel; the types of the calls are there to be named."""
    project = tomllib.loads((ROOT / "generated/python/pyproject.toml").read_text())["project"]
    assert softkin.__version__ == project["version"]
    assert project["license-files"] == ["LICENSE"]
    texts = {(ROOT / path).read_text() for path in ("LICENSE", "generated/python/LICENSE", "runtime/python/LICENSE")}
    assert len(texts) == 1
    assert {"Configuration", "Rotation", "FrameLike", "orthonormalize", "Mounted"} <= set(softkin.__all__)
    assert softkin.Rotation and softkin.Configuration and softkin.FrameLike
