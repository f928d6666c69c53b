"""All poses of platforms at their axes, by numerics that know the closure alone."""

from collections.abc import Mapping
from itertools import count

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.catalogue.turning_machines import TurningMachine, turning_machine
from tests.mechanisms import named

Array = NDArray[np.float64]
_STARTS = 2000
"""Of Newton's method."""
_HEADINGS, _HALVINGS = 40001, 50


def nominal_of(name: str) -> dict[str, float]:
    """The nominal dimensions of a machine."""
    return {p.name: p.nominal for p in named(name).parameters}


def points_of(given: Mapping[str, float], side: str, letters: str) -> Array:
    """The joints of the base, or of the platform."""
    rows = (tuple(f"{side}_{i}_{k}" for k in letters) for i in count(1))
    found = []
    for row in rows:
        if row[0] not in given:
            return np.array(found)
        found.append([given[name] for name in row])
    raise AssertionError


def hexapod(seed: int) -> TurningMachine:
    """A hexapod with its joints in no plane; the nominal one for seed 0."""
    rng = np.random.default_rng(seed)
    size = 0.0 if seed == 0 else 90.0
    names = [f"{side}_{i}_{k}" for side in ("base", "platform") for i in range(1, 7) for k in "xyz"]
    nominal = nominal_of("Kin_Hexapod")
    given = nominal | {name: nominal[name] + size * rng.uniform(-1.0, 1.0) for name in names}
    return turning_machine(named("Kin_Hexapod"), f"hexapod {seed}", given)


def beside_home(machine: TurningMachine) -> Array:
    """Axis values of a pose beside the home of a hexapod."""
    turn = Rotation.from_rotvec([0.1, -0.15, 0.2]).as_matrix()
    joints, closed = machine.closure.joints_at(np.array([[20.0, -30.0, 610.0]]), turn[None], np.random.default_rng(1))
    assert closed.all()
    return machine.closure.axes(joints)[0]


def missed(machine: TurningMachine, axes: Array, poses: Array) -> float:
    """The largest residual of the closure at poses, a row of position and rotation each."""
    joints = machine.closure.joints(np.tile(axes, (len(poses), 1)))
    return float(np.abs(machine.closure.equations(joints, poses[:, :3], poses[:, 3:].reshape(-1, 3, 3))).max())


def every_pose(machine: TurningMachine, axes: Array) -> Array:
    """The poses at axes, a row of position and rotation each: what Newton's method finds from random starts."""
    positions = np.random.default_rng(7).uniform(-1.5, 1.5, (_STARTS, 3)) * machine.reach
    rotations = Rotation.random(_STARTS, random_state=7).as_matrix()
    joints = machine.closure.joints(np.tile(axes, (_STARTS, 1)))
    positions, rotations, closed = machine.closure.ends(joints, positions, rotations)
    return different(np.concatenate([positions, rotations.reshape(-1, 9)], axis=1)[closed], 1e-3)


def different(rows: Array, within: float) -> Array:
    """The rows of which none is the same as one before it."""
    found: list[Array] = []
    while len(rows):
        found.append(rows[0])
        rows = rows[np.abs(rows - rows[0]).max(axis=1) >= within]
    return np.array(found)


def are_same(found: Array, wanted: Array, within: float) -> bool:
    """Whether rows of numbers are the same, in any order."""
    if found.shape != wanted.shape or not len(found):
        return found.shape == wanted.shape
    apart = np.abs(found[:, None] - wanted).max(axis=2)
    return bool(apart.min(axis=0).max() < within and apart.min(axis=1).max() < within)


def poses_in_a_plane(given: Mapping[str, float], axes: Array) -> Array:
    """All poses of a platform in a plane, a row of x, y, cosine and sine of the heading each.

    For every heading two rods leave two places, and a root of what the third misses is a pose.
    """
    base, platform = (points_of(given, side, "xy") for side in ("base", "platform"))
    arms, rods = (np.array([given[f"{what}_length_{i}"] for i in (1, 2, 3)]) for what in ("arm", "rod"))
    angles = np.radians(axes)
    elbows = base + arms[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    grid, side = (part.ravel() for part in np.meshgrid(np.linspace(-np.pi, np.pi, _HEADINGS), (1.0, -1.0)))

    def placed(heading: Array, side: Array) -> tuple[Array, Array]:
        cosine, sine = np.cos(heading)[:, None, None], np.sin(heading)[:, None, None]
        turned = cosine * platform + sine * (platform[:, ::-1] * (-1.0, 1.0))
        first, second, third = np.moveaxis(elbows - turned, 1, 0)
        way = second - first
        apart = np.linalg.norm(way, axis=1)
        along = (rods[0] ** 2 - rods[1] ** 2 + apart**2) / (2.0 * apart)
        across = side * np.sqrt(rods[0] ** 2 - along**2)
        place = first + (along[:, None] * way + across[:, None] * way[:, ::-1] * (-1.0, 1.0)) / apart[:, None]
        return np.linalg.norm(place - third, axis=1) - rods[2], place

    with np.errstate(invalid="ignore"):
        missed = placed(grid, side)[0]
        here = np.flatnonzero((missed[:-1] * missed[1:] < 0.0) & (side[:-1] == side[1:]))
        low, high, side, sign = grid[here], grid[here + 1], side[here], np.sign(missed[here])
        for _ in range(_HALVINGS):
            middle = (low + high) / 2.0
            is_before = np.sign(placed(middle, side)[0]) == sign
            low, high = np.where(is_before, middle, low), np.where(is_before, high, middle)
    return np.column_stack([placed(low, side)[1], np.cos(low), np.sin(low)])
