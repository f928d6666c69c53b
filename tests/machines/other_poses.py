"""Poses of platforms that forward kinematics does not find again from home, with the Jacobian there.

The Jacobian is that of the inverse by central differences: the inverse knows the pose, and iterates nothing.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import softkin
from numpy.typing import NDArray
from softkin import Frame, KinematicsError

from derive.description.mechanism import Mechanism, Turning
from derive.description.validate import validate
from derive.emit.language import Part
from derive.ir.interpret import run
from derive.kinematics.kinematics import Kinematics
from derive.plate.turning import poses_around_home
from tests.machines.guided import GUIDED
from tests.machines.made import built_of, imported_class
from tests.mechanisms import catalogue, kinematics_of
from tests.orthonormal import rodrigues

Array = NDArray[np.float64]
OWN = ("Z3 head with slides", "3-RRR on a lift")
"""Machines that are in no catalogue: their loops leave out coordinates that the task does not command."""
PLATFORMS = tuple(m for _, m in catalogue() if m.is_platform)
CATALOGUE = tuple(m.name for m in PLATFORMS if m.task.position)
TURNING = tuple(m.name for m in PLATFORMS if not m.task.position)
"""Machines that only turn; all poses of these are found again."""
_DRAWN, _WANTED, _STEP = 3000, 12, 1e-5
_REGULAR = 0.05
"""The least margin of a pose whose Jacobian is compared."""


@dataclass(frozen=True)
class Solved:
    """A frame, the axes of one branch there, and its configuration."""

    frame: Frame
    axes: tuple[float, ...]
    configuration: tuple[int, ...]
    jacobian: Array


@dataclass(frozen=True)
class Platform:
    """One machine: `robot` refuses what forward kinematics does not find again, `open_robot` does not."""

    mechanism: Mechanism
    robot: softkin.Mechanism
    parts: dict[str, Part]

    @property
    def given(self) -> dict[str, float]:
        """Its parameters, in the units of the description."""
        return dict(self.robot.parameters)

    @cached_property
    def open_robot(self) -> softkin.Mechanism:
        return self.robot.changed(check_forward=False)

    @cached_property
    def poses(self) -> tuple[list[Solved], list[Solved]]:
        """Poses that forward kinematics does not find again from home, and poses that it does."""
        lost: list[Solved] = []
        kept: list[Solved] = []
        for frame in self.frames(0.9, 1.2):
            if min(len(lost), len(kept)) == _WANTED:
                break
            for solution in self.open_robot.inverse_all(frame):
                if solution.axes is None:
                    continue
                group = kept if self.finds(frame, solution.axes) else lost
                if len(group) < _WANTED and (found := self._solved(frame, solution)) is not None:
                    group.append(found)
        return lost, kept

    @property
    def largest_turn(self) -> float:
        """The largest turn about an axis of which the header tells."""
        return float(np.pi if self.mechanism.motion.turning is Turning.ABOUT_Z else np.pi / 2)

    def frames(self, away: float, turned: float) -> Iterator[Frame]:
        """Frames within a distance of home in characteristic lengths, and an angle about each axis."""
        return _frames(kinematics_of(self.mechanism), (away, turned))

    def finds(self, frame: Frame, axes: tuple[float, ...]) -> bool:
        """Whether forward kinematics from home leads to a frame."""
        try:
            there = self.open_robot.forward(axes)[0]
        except KinematicsError:
            return False
        size = 1e-4 * (1.0 + max(map(abs, frame.position)))
        return self.is_same(frame, there, size)

    def is_same(self, frame: Frame, other: Frame, size: float) -> bool:
        """Whether two frames agree in what the task commands."""
        task = self.mechanism.task
        apart = [abs(frame.position["xyz".index(c)] - other.position["xyz".index(c)]) for c in task.position]
        turned = np.abs(np.array(frame.rotation) - np.array(other.rotation))
        is_direction = task.turning is Turning.DIRECTION
        return max(apart, default=0.0) < size and turned[:, 2].max() < 1e-4 and (is_direction or turned.max() < 1e-4)

    def _solved(self, frame: Frame, solution: softkin.Solution) -> Solved | None:
        """The solution with its Jacobian; None near a singularity or the edge of the workspace."""
        assert solution.axes is not None
        commanded, frame = frame, self.open_robot.forward(solution.axes, frame)[0]
        assert self.is_same(frame, commanded, 1e-6)  # a loop may also move what the task does not command
        there = self.open_robot.singularity(solution.axes, frame)
        if there.is_singular or min(map(abs, there.margins.values())) < _REGULAR:
            return None
        branches = solution.configuration[: self.robot.BRANCHES]
        bytes_ = (*branches, *(0 for _ in self.robot.PERIOD_AXES))
        units = np.array([np.pi / 180.0 if axis.unit == "deg" else 1.0 for axis in self.robot.AXES])
        columns = []
        try:
            for row in self.robot.JACOBIAN_ROWS:
                ends = [self.open_robot.inverse(_moved(frame, row, s * _STEP), bytes_, solution.axes) for s in (1, -1)]
                size = _size(frame) if row in ("x", "y", "z") else 1.0
                columns.append((np.array(ends[0]) - ends[1]) * units / (2.0 * _STEP * size))
        except KinematicsError:
            return None
        return Solved(frame, solution.axes, bytes_, np.linalg.inv(np.array(columns).T))


def _frames(kin: Kinematics, within: tuple[float, float]) -> Iterator[Frame]:
    given = {p.name: np.asarray(p.nominal) for p in kin.parameters}
    constants, _ = run(kin.setup, given)
    rng = np.random.default_rng(7)
    drawn = poses_around_home(kin.mechanism, {**given, **constants}, rng, within, _DRAWN)
    positions = np.stack([drawn[c] for c in "xyz"], axis=1)
    rotations = np.stack([drawn[f"r{i}{k}"] for i in (1, 2, 3) for k in (1, 2, 3)], axis=1).reshape(-1, 3, 3)
    if any(j.name == "Z1" for j in kin.mechanism.joints):  # a lift moves it up as well
        positions[:, 2] = rng.uniform(50.0, 150.0, _DRAWN)
    for position, rotation in zip(positions.tolist(), rotations.tolist(), strict=True):
        yield Frame(tuple(position), tuple(map(tuple, rotation)))


def _size(frame: Frame) -> float:
    return 1.0 + max(map(abs, frame.position))


def _moved(frame: Frame, row: str, step: float) -> Frame:
    """A frame moved along a row of the Jacobian: along or about an axis of the base, or about one of the tool."""
    kind, letter = row.split() if " " in row else ("", row)
    axis = np.eye(3)["xyz".index(letter)]
    if not kind:
        return Frame(tuple(np.array(frame.position) + step * _size(frame) * axis), frame.rotation)
    turn = rodrigues(axis, step)
    own = np.array(frame.rotation)
    turned = own @ turn if kind == "tilt" else turn @ own
    return Frame(frame.position, tuple(map(tuple, turned.tolist())))


@cache
def platform(name: str) -> Platform:
    """A machine of the catalogue, or one of its own."""
    if name in (*CATALOGUE, *TURNING):
        mechanism = next(m for _, m in catalogue() if m.name == name)
        robot_class = softkin.catalogue()[name]
        parts: dict[str, Part] = {}
    else:
        mechanism = validate(GUIDED[name])
        built = built_of(mechanism)
        robot_class, parts = imported_class(mechanism, built), dict(built.parts)
    return Platform(mechanism, robot_class(**{p.name: p.nominal for p in mechanism.parameters}), parts)
