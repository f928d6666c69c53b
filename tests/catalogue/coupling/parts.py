"""The parts of couplings: every position and every orientation kinematics of the catalogue, and axis values of them."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import softkin
from numpy.random import Generator
from softkin import Status

from derive.description.mechanism import Mechanism, Role, Turning
from tests.catalogue.closure import Array, Closure
from tests.catalogue.driven_machines import DrivenClosure
from tests.mechanisms import catalogue, has_struts

EVERYTHING = {m.name: m for _, m in catalogue()}
POSITIONS = tuple(
    m for m in EVERYTHING.values() if m.task.position and m.task.turning in (Turning.NONE, Turning.ABOUT_Z)
)
ORIENTATIONS = tuple(m for m in EVERYTHING.values() if m.is_orientation)
SHIFTS: dict[str, tuple[dict[str, float], ...]] = {
    "Kin_CAxis": ({},),
    "Kin_CAxis_Tool": ({}, {"tool_z": -60.0}, {"tool_x": 15.0, "tool_y": -8.0, "tool_z": -60.0}),
    "Kin_Tool": ({}, {"tool_z": -60.0}, {"tool_y": 12.0}),
    "Kin_Wrist2": (
        {"tool_length": 90.0},
        {"tool_length": 90.0, "roll_axis_offset_z": -40.0},
        {"tool_length": 90.0, "roll_axis_offset_y": -7.0},
        {"tool_length": 90.0, "roll_axis_offset_x": 12.0, "roll_axis_offset_z": -40.0, "tool_side": -1},
    ),
    "Kin_Wrist3": ({"tool_offset_x": 10.0, "tool_offset_y": -6.0, "tool_offset_z": 75.0},),
}
"""The shifts with which every orientation kinematics is tried: along the axis of the flange, off it, in between."""
REGULAR = 0.05


@dataclass(frozen=True)
class Part:
    """A mechanism with parameters, in Python and as its equations."""

    mechanism: Mechanism
    robot: softkin.Mechanism
    closure: Closure

    def draw(self, count: int, rng: Generator) -> Array:
        """Axis values with a pose away from every singularity, within one turn."""
        joints = self.mechanism.joints
        if not joints:
            return np.zeros((count, 0))
        offsets = self.closure.offsets
        low, high = (np.array([_range(self, j)[end] for j in joints]) for end in (0, 1))
        drawn = offsets + rng.uniform(low, high, (400 * count, len(joints)))
        possible = drawn[self.robot.forward_batch(drawn)[3] == Status.OK]
        chosen = []
        for axes in possible.tolist():
            if len(chosen) == count:
                break
            margins = self.robot.singularity(axes).margins.values()
            if all(abs(m) > REGULAR for m in margins) and _returns(self.robot, tuple(axes)):
                chosen.append(axes)
        assert len(chosen) == count, self.robot
        return np.array(chosen)


def part(mechanism: Mechanism, **given: float) -> Part:
    """A part with nominal dimensions and with offsets; of an orientation kinematics, all shifts as given, else 0."""
    lengths = {p.name: p.nominal for p in mechanism.parameters if p.role is not Role.FLAG}
    known = dict(given) if mechanism in ORIENTATIONS else lengths | given
    offsets = {j.offset.name: 3.0 + 2.0 * k for k, j in enumerate(mechanism.joints) if j.domain is None}
    robot = softkin.catalogue()[mechanism.name](**(offsets | known))
    if mechanism.drives:
        return Part(mechanism, robot, DrivenClosure(mechanism, robot.parameters, sum(map(abs, lengths.values()))))
    return Part(mechanism, robot, Closure(mechanism, robot.parameters))


@cache
def position_part(mechanism: Mechanism) -> Part:
    """A position kinematics with nominal dimensions."""
    return part(mechanism)


@cache
def orientation_parts(mechanism: Mechanism) -> tuple[Part, ...]:
    """An orientation kinematics with every set of shifts."""
    return tuple(part(mechanism, **shifts) for shifts in SHIFTS[mechanism.name])


def frames(carrier: Part, first: Array, wrist: Part, second: Array) -> tuple[Array, Array, Array, Array]:
    """Poses of the flange, then of the end point, by equations; a loop's flange is where forward has it."""
    if carrier.mechanism.chain is None:
        places, turns = carrier.robot.forward_batch(first)[:2]
    else:
        places, turns = carrier.closure.frames(carrier.closure.joints(first))
    ends, rotations = wrist.closure.frames(wrist.closure.joints(second))
    return places, turns, ends, rotations


def _range(one: Part, joint: object) -> tuple[float, float]:
    found = one.mechanism.joints[[j is joint for j in one.mechanism.joints].index(True)]
    if found.loops or (found.domain and has_struts(one.mechanism)):  # a cylinder or a strut: where its loop closes
        return min(0.8 * found.nominal, 1.2 * found.nominal), max(0.8 * found.nominal, 1.2 * found.nominal)
    size = 170.0 if found.is_angle else 400.0
    low, high = found.domain or (-size, size)
    return max(low, -size), min(high, size)


def _returns(robot: softkin.Mechanism, axes: tuple[float, ...]) -> bool:
    """Whether the inverse accepts the pose: the swing of a ball joint is the inverse's."""
    frame, configuration = robot.forward(axes)
    try:
        robot.inverse(frame, configuration, axes)
    except softkin.KinematicsError:
        return False
    return True
