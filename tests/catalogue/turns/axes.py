"""Axes with several turns, the ranges around them, and those who ask: the package, its batches, and the block."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
import softkin
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import Joint, Mechanism
from tests.mechanisms import catalogue
from tests.text.controller import OK, UNREACHABLE, Controller
from tests.text.units import compiled

WIDTHS = (180.0, 340.0, 350.0, 351.0, 360.0, 361.0, 540.0)
GAP_THAT_NO_STEP_CROSSES = 10.0
STEPS = (1e-9, 1e-6, 0.1, 9.0)
"""Degrees; the last one is the longest that a path takes."""
FEW_WIDTHS = (340.0, 350.0, 351.0, 360.0, 540.0)
FEW_STEPS = (1e-6, 9.0)


@dataclass(frozen=True)
class Range:
    """The limits of an axis, in degrees."""

    lower: float
    upper: float

    @property
    def width(self) -> float:
        """From end to end."""
        return self.upper - self.lower

    @property
    def tolerance(self) -> float:
        """How far beyond an end is inside."""
        return 1e-9 * (1.0 + abs(self.lower) + abs(self.upper))

    @property
    def has_one_value(self) -> bool:
        """Whether the gap beyond its ends is one that no step crosses."""
        return self.width <= 360.0 - GAP_THAT_NO_STEP_CROSSES + self.tolerance

    def has(self, value: float) -> bool:
        return self.lower - self.tolerance <= value <= self.upper + self.tolerance

    def is_sharp(self, value: float) -> bool:
        """Whether no value of that direction is where rounding decides if it is inside: next to an end as tolerated."""
        ends = (self.lower - self.tolerance, self.upper + self.tolerance)
        return all(abs(v - end) > 1e-10 for v in _turns(value) for end in ends)

    def inside(self, value: float) -> list[float]:
        """The values inside that are whole turns from a value."""
        return [v for v in _turns(value) if self.has(v)]

    def answer(self, value: float, reference: float) -> float | None:
        """The axis value of a direction where its turn is open; None where it is refused."""
        if self.has_one_value:
            inside = self.inside(value)
            assert len(inside) <= 1
            return inside[0] if inside else None
        nearest = min(_turns(value), key=lambda v: abs(v - reference))
        return nearest if self.has(nearest) else None


def placed(width: float) -> Iterator[Range]:
    """A range around 0, and two beside it."""
    yield Range(-width / 2, width / 2)
    yield Range(77.3 - width, 77.3)
    yield Range(-33.1, width - 33.1)


def number_of(value: float) -> int:
    """The number of the turn of an axis value: 1 is -180 to 180, -1 the turn below; there is no 0."""
    below = 0
    while value >= 180.0 - 1e-9:
        value, below = value - 360.0, below + 1
    while value < -180.0 - 1e-9:
        value, below = value + 360.0, below - 1
    return below + 1 if below >= 0 else below


def _turns(value: float) -> list[float]:
    return [value + 360.0 * k for k in range(-8, 9)]


MECHANISMS = tuple(m for _, m in catalogue() if m.period_joints)
FULL = ("Kin_Scara2_Z", "Kin_ArticulatedRobot_6DOF")
"""A SCARA and a six-axis arm, which are tested on all ranges and steps."""
REACH = 14.0
"""Degrees that an axis can go from its pose, either way, without a singular pose."""
REGULAR = 0.03

Axes = tuple[float, ...]


@dataclass(frozen=True)
class TurningAxis:
    """An axis of a machine without offsets and limits, and axis values away from singular poses."""

    mechanism: Mechanism
    index: int
    given: Mapping[str, float]
    base: Axes

    def __str__(self) -> str:
        """Machine and axis."""
        return f"{self.mechanism.name} {self.joint.name}"

    @property
    def joint(self) -> Joint:
        return self.mechanism.joints[self.index]

    @property
    def byte(self) -> int:
        """The place of its turn in the configuration."""
        return len(self.mechanism.branches) + [j.name for j in self.mechanism.period_joints].index(self.joint.name)

    def allows(self, lower: float, upper: float) -> bool:
        """Whether the vendor's ranges allow these limits."""
        low, high = self.joint.limit_range or (-1e9, 1e9)
        return low <= lower and upper <= high

    def parameters(self, value: float, lower: float, upper: float) -> dict[str, float]:
        """Of the machine whose axis has a value at the base, by its offset, and limits."""
        key, (low, high) = self.joint.key, self.joint.offset_range or (-1e9, 1e9)
        offset = value - self.base[self.index]
        while offset < low:
            offset += 360.0
        while offset > high:
            offset -= 360.0
        return {**self.given, f"offset_{key}": offset, f"lower_{key}": lower, f"upper_{key}": upper}

    def at(self, value: float) -> Axes:
        """The axis values of the base, but for this axis."""
        return (*self.base[: self.index], value, *self.base[self.index + 1 :])


def robot_of(mechanism: Mechanism, given: Mapping[str, float]) -> softkin.Mechanism:
    """The generated class with parameters."""
    return softkin.catalogue()[mechanism.name](**given)


@cache
def turning_axes(mechanism: Mechanism) -> tuple[TurningAxis, ...]:
    """Every axis of a mechanism that turns more than once; without what would make its inverse a search."""
    searched = mechanism.search.where if mechanism.search else None
    given = {p.name: 0.0 if p == searched else p.nominal for p in mechanism.parameters}
    robot = robot_of(mechanism, given)
    candidates = tuple(_regular(mechanism, robot))
    found = []
    for index, joint in enumerate(mechanism.joints):
        if joint.multi_turn:
            base = next(axes for axes in candidates if _can_go(robot, axes, index))
            found.append(TurningAxis(mechanism, index, given, base))
    return tuple(found)


def _regular(mechanism: Mechanism, robot: softkin.Mechanism) -> Iterator[Axes]:
    """Axis values of regular poses, from which the inverse returns."""
    rng = np.random.default_rng(7)
    for spread in np.linspace(0.2, 1.0, 400):
        axes = tuple(float(v) for v in _drawn(mechanism, rng, spread))
        if _is_regular(robot, axes) and _returns(robot, axes):
            yield axes


def _drawn(mechanism: Mechanism, rng: np.random.Generator, spread: float) -> list[float]:
    """Around the pose that drawings show: loops cannot be closed anywhere."""
    values = []
    for joint in mechanism.joints:
        value = joint.nominal + spread * rng.uniform(-1.0, 1.0) * (150.0 if joint.is_angle else 60.0)
        low, high = joint.domain or (-1e9, 1e9)
        values.append(min(max(value, low + 5.0), high))
    return values


def _can_go(robot: softkin.Mechanism, axes: Axes, index: int) -> bool:
    ways = np.linspace(-REACH, REACH, 5)
    moved = [(*axes[:index], axes[index] + way, *axes[index + 1 :]) for way in ways.tolist()]
    branches = robot.forward(axes)[1][: robot.BRANCHES]
    return all(
        _is_regular(robot, m) and robot.forward(m)[1][: robot.BRANCHES] == branches and _returns(robot, m)
        for m in moved
    )


def _is_regular(robot: softkin.Mechanism, axes: Axes) -> bool:
    return all(abs(margin) > REGULAR for margin in robot.singularity(axes).margins.values())


def _returns(robot: softkin.Mechanism, axes: Axes) -> bool:
    try:
        frame, configuration = robot.forward(axes)
        return bool(np.abs(np.subtract(robot.inverse(frame, configuration, axes), axes)).max() < 1e-8)
    except KinematicsError as error:
        assert error.status in (Status.IMPOSSIBLE, Status.UNREACHABLE)
        return False


Bytes = tuple[int, ...]
Reason = tuple[str, float, int]
"""The text, how much is missing, and the number of a turn that is inside."""


@dataclass(frozen=True)
class Asked:
    """The arguments of a call."""

    frame: Frame
    configuration: Bytes
    reference: Axes


class Caller(Protocol):
    """A machine."""

    def forward(self, axes: Axes) -> tuple[Frame, Bytes]:
        """The frame, and its configuration."""
        ...

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes; None where it is out of reach or beyond a limit."""
        ...

    def why(self, asked: Asked) -> Reason:
        """Why it refuses."""
        ...

    def check_alike(self) -> None:
        """Ask once more what was asked, in the other ways that there are."""


class InPython:
    """The Python class."""

    def __init__(self, mechanism: Mechanism, given: Mapping[str, float]) -> None:
        self.robot = robot_of(mechanism, given)
        self.answers: list[tuple[Asked, Axes | None]] = []
        self.forward = cache(self.robot.forward)  # the same pose is asked for with many references

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes, by a call that says the same of the turn as `diagnose` does."""
        found = None
        try:
            found = self.robot.inverse(asked.frame, asked.configuration, asked.reference)
        except KinematicsError as error:
            assert error.status is Status.UNREACHABLE
            _, _, turn = self.why(asked)
            assert self.robot.diagnose(asked.frame, asked.configuration, asked.reference).in_words in str(error)
            assert (f"which is turn {turn}" in str(error)) == (turn != 0)
        self.answers.append((asked, found))
        return found

    def why(self, asked: Asked) -> Reason:
        """What `diagnose` says."""
        status, reason, missing, turn, _ = self.robot.diagnose(asked.frame, asked.configuration, asked.reference)
        assert status is Status.UNREACHABLE
        return reason, missing, turn

    def check_alike(self) -> None:
        """As one batch, and by the slots where turns are open."""
        asked, answers = zip(*self.answers, strict=True)
        positions, rotations = (np.array(part) for part in zip(*(one.frame for one in asked), strict=True))
        configurations, references = np.array([a.configuration for a in asked]), np.array([a.reference for a in asked])
        axes, statuses = self.robot.inverse_batch(positions, rotations, configurations, references)
        wanted = np.array([a or (np.nan,) * axes.shape[1] for a in answers])
        is_refused = np.isnan(wanted[:, 0])
        assert (np.isnan(axes) == np.isnan(wanted)).all()
        assert (statuses == np.where(is_refused, Status.UNREACHABLE, Status.OK)).all()
        assert np.abs(axes - wanted)[~is_refused].max(initial=0.0) < 1e-9
        branches = self.robot.BRANCHES
        is_open = ~configurations[:, branches:].any(axis=1)
        slots, outcomes = self.robot.inverse_all_batch(positions[is_open], rotations[is_open], references[is_open])
        own = ((configurations[is_open, :branches] - 1) * 2 ** np.arange(branches)).sum(axis=1)
        assert (outcomes[range(len(own)), own] == statuses[is_open]).all()
        assert np.nanmax(np.abs(slots[range(len(own)), own] - axes[is_open]), initial=0.0) < 1e-9
        scalar = self.robot.inverse_all(asked[0].frame, asked[0].reference)[own[0]]
        assert scalar.status == statuses[0]
        assert (scalar.axes is None) == bool(is_refused[0])


class OnController:
    """The function block, executed; frames are made in Python."""

    def __init__(self, mechanism: Mechanism, given: Mapping[str, float]) -> None:
        self.robot = robot_of(mechanism, given)
        self.controller = Controller(compiled(mechanism), mechanism)
        assert self.controller.initialise(self.robot.parameters) == OK

    def forward(self, axes: Axes) -> tuple[Frame, Bytes]:
        """The frame, and its configuration."""
        return self.robot.forward(axes)

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes."""
        status, found = self.controller.inverse(*asked.frame, asked.configuration, asked.reference)
        assert status in (OK, UNREACHABLE)
        return None if found is None else tuple(found[: len(asked.reference)])

    def why(self, asked: Asked) -> Reason:
        """What Diagnose says."""
        return self.controller.explain(*asked.frame, asked.configuration, asked.reference)[:3]

    def check_alike(self) -> None:
        """There is one way."""
