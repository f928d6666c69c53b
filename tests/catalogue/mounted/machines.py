"""Every mechanism of the catalogue as one machine, with poses of its flange that its equations give."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import softkin

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.closure import Array
from tests.catalogue.coupling.parts import EVERYTHING, ORIENTATIONS, orientation_parts
from tests.catalogue.driven_machines import driven_machines_of
from tests.catalogue.loop_machines import loop_machines_of
from tests.catalogue.machines import machines_of
from tests.catalogue.search.arms import arm
from tests.catalogue.search.arms import frame as frame_of_arm
from tests.catalogue.turning_machines import turning_machines_of
from tests.mechanisms import catalogue

EVERY = tuple(m for _, m in catalogue())
POSES = 6
LATERAL = 60.0


@dataclass(frozen=True)
class Sample:
    """A machine, and regular poses of its flange: axis values (n, axes), matrices (n, 4, 4)."""

    mechanism: Mechanism
    robot: softkin.Mechanism
    axes: Array
    flange: Array
    reach: float

    @property
    def turns_by_itself(self) -> bool:
        """Whether the flange turns, and the commanded rotation does not say how."""
        turning = np.ptp(self.flange[:, :3, :3], axis=0).max() > 1e-9
        return bool(turning) and self.mechanism.task.turning is Turning.NONE

    @property
    def follows_the_direction(self) -> bool:
        """Whether the turn about the tool is passive."""
        return self.mechanism.task.turning is Turning.DIRECTION


def matrices(positions: Array, rotations: Array) -> Array:
    """Homogeneous matrices (n, 4, 4)."""
    found = np.tile(np.eye(4), (len(positions), 1, 1))
    found[:, :3, :3], found[:, :3, 3] = rotations, positions
    return found


@cache
def sample_of(mechanism: Mechanism | str) -> Sample:
    """A random machine of the mechanism, off its nominal dimensions, with offsets; or a coupling."""
    rng = np.random.default_rng(71)
    if isinstance(mechanism, str):
        robot = couplings()[mechanism]
        axes = rng.uniform(20.0, 80.0, (POSES, len(robot.AXES)))
        flange = matrices(*robot.forward_batch(axes)[:2])
        return Sample(EVERYTHING[robot.orientation_part.NAME], robot, axes, flange, 600.0)
    if mechanism in ORIENTATIONS:
        one = orientation_parts(mechanism)[-1]
        axes = one.draw(POSES, rng)
        return Sample(mechanism, one.robot, axes, matrices(*one.closure.frames(one.closure.joints(axes))), 300.0)
    if mechanism.search is not None:
        axes = rng.uniform(-120.0, 120.0, (POSES, 6))
        axes[:, 1:3] = rng.uniform(20.0, 70.0, (POSES, 2))
        return Sample(mechanism, arm(LATERAL), axes, frame_of_arm(axes, LATERAL), 2000.0)
    if mechanism.is_platform:
        machine = turning_machines_of(mechanism)[-1]
    elif mechanism.drives:
        machine = driven_machines_of(mechanism)[-1]
    else:
        machine = (loop_machines_of if mechanism.rods else machines_of)(mechanism)[-1]
    axes = machine.draw(POSES, rng, 170.0)
    return Sample(mechanism, machine.robot, axes, matrices(*machine.closure.poses(axes)), machine.reach)


def couplings() -> dict[str, softkin.Coupled]:
    """Couplings of every kind of flange, and one that is a tool."""
    scara = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0, offset_a1=7.0)
    arm_of_three = softkin.PosRRR(d1=350.0, a1=80.0, a2=310.0, d3=50.0, a3=30.0, d4=290.0)
    quill = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0, offset_a4=11.0)
    return {
        "gantry, tool": softkin.Coupled(softkin.Gantry3(), softkin.Tool(tool_x=12.0, tool_z=-30.0)),
        "gantry, C": softkin.Coupled(softkin.Gantry3(), softkin.CAxisTool(tool_x=12.0, tool_z=-30.0)),
        "gantry, wrist": softkin.Coupled(softkin.Gantry3(), softkin.Wrist2(tool_length=90.0)),
        "scara, C": softkin.Coupled(scara, softkin.CAxis(offset_c=5.0)),
        "scara, wrist": softkin.Coupled(scara, softkin.Wrist3(tool_offset_z=75.0)),
        "arm, wrist": softkin.Coupled(arm_of_three, softkin.Wrist3(tool_offset_z=75.0)),
        "quill, tool": softkin.Coupled(quill, softkin.Tool(tool_x=30.0, tool_y=-12.0, tool_z=-60.0)),
    }


BASE = softkin.Frame.from_euler(35.0, 70.0, -15.0, (410.0, -230.0, 95.0))
"""A base that is inclined."""
TOOL = softkin.Frame.from_euler(25.0, 40.0, -60.0, (31.0, -17.0, 44.0))
"""A tool to the side, and inclined."""


def tools_of(sample: Sample) -> tuple[softkin.Frame, ...]:
    """Tools that the machine can carry: any one, where its flange is determined."""
    straight = softkin.Frame.from_euler(50.0, 0.0, 0.0, (0.0, 0.0, 44.0))
    if sample.robot.ROLE == "orientation":
        return (straight,) if sample.follows_the_direction else (straight, TOOL)
    if sample.follows_the_direction:
        return (straight,)
    if sample.turns_by_itself:
        if sample.robot.FREEDOM == "three":
            return (softkin.Frame((0.0, 0.0, 0.0), TOOL.rotation),)
        axis = sample.robot.orientation_image().flange_axis
        along = (44.0 * axis[0], 44.0 * axis[1], 44.0 * axis[2])
        return (softkin.Frame(along, TOOL.rotation), softkin.Frame(along))
    return (straight, TOOL)
