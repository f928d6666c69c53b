"""Machines that cannot be, and ends that no axis can see."""

from __future__ import annotations

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.both_ways import inverse
from tests.catalogue.loop_machines import LoopMachine

SWING = "max_angle_ball_joint"
HAIR = 1e-9


def test_a_ball_joint_ends_sharply(mechanism: Mechanism, machines: tuple[LoopMachine, ...]) -> None:
    """A limit a hair above the swing of a pose answers, a hair below refuses; forward kinematics does not ask."""
    assert bool(mechanism.bounds) == (SWING in machines[0].robot.parameters)
    for machine in machines if mechanism.bounds else ():
        axes = machine.draw(8, np.random.default_rng(1))
        positions, rotations = machine.closure.poses(axes)
        values = np.abs(
            machine.closure.at(machine.closure.joints(axes), positions, [b.value for b in mechanism.bounds])
        )
        swings = np.degrees(np.arcsin(values.max(axis=1)))
        for row, swing in enumerate(swings):
            one = slice(row, row + 1)
            for share, expected in ((1 + HAIR, Status.OK), (1 - HAIR, Status.UNREACHABLE), (0.5, Status.UNREACHABLE)):
                robot = machine.changed(**{SWING: swing * share})
                _, statuses = inverse(
                    robot, positions[one], rotations[one], robot.forward_batch(axes[one])[2], axes[one]
                )
                assert statuses[0] == expected
                assert robot.forward(axes[row]) == machine.robot.forward(axes[row])


DELTA = {
    f"{name}_{i}": v for name, v in (("base_radius", 140.0), ("inner_arm", 200.0), ("outer_arm", 450.0)) for i in "123"
}
TRIPOD = {"arm_length_1": 200.0, "arm_length_2": 450.0, "arm_1_radius": 140.0, "max_angle_ball_joint": 45.0}
RAILS = {
    f"rail_{c}_{i}": v
    for c, vs in (("x", (0.0, -130.0, 130.0)), ("y", (150.0, -75.0, -75.0)))
    for i, v in enumerate(vs, 1)
}
LINE = {
    f"rail_{c}_{i}": v
    for c, vs in (("x", (100.0, 200.0, 300.0)), ("y", (10.0, 20.0, 30.0)))
    for i, v in enumerate(vs, 1)
}


FIVE_BAR = {"inner_arm": 100.0, "outer_arm": 200.0}
TYPE_12 = {
    "link_length_1": 300.0,
    "link_length_2": 350.0,
    "link_length_3": 100.0,
    "link_length_4": 300.0,
    "link_length_5": 100.0,
}
UPRIGHT = {"inner_radius": 60.0, "arm_length": 400.0, "rail_angle": 0.0, "max_angle_ball_joint": 45.0}
BIGLIDE = {"arm_length_1": 200.0, "arm_length_2": 100.0}
T_LAYOUT = {"azimuth_1": 0.0, "azimuth_2": 90.0, "azimuth_3": -90.0}
WIDE = T_LAYOUT | {f"base_radius_{i}": 9000.0 for i in "123"}
EVEN = {f"{name}_{i}": v for i in (1, 2, 3) for name, v in (("azimuth", 120.0 * i), ("base_radius", 700.0))}
CARRIED = {"base_radius": 160.0, "arm_length": 240.0, "rod_length": 560.0, "plate_radius": 45.0}
TWO_ARMS = {"base_distance": 140.0} | {f"{n}_length_{i}": s for i in "12" for n, s in (("arm", 200.0), ("rod", 260.0))}
IMPOSSIBLE = {
    "a plate smaller than its joints": ("Kin_Tripod_Rotary", TRIPOD, {"stewart_radius": 19.99, "distance": 40.0},
        "stewart"),
    "rods that cannot reach": ("Kin_Tripod_Rotary", TRIPOD, {"arm_length_2": 339.99}, "reach"),
    "rods that cannot reach inward": ("Kin_Tripod_Rotary", TRIPOD, {"stewart_radius": 900.0}, "reach"),
    "rails on a line": ("Kin_Tripod_P3Z", {"arm_length": 269.0}, LINE, "line"),
    "rails nowhere": ("Kin_Tripod_P3Z", {"arm_length": 269.0}, {}, "origin"),
    "a plate larger than the rails": ("Kin_Tripod_P3Z", {"arm_length": 269.0} | RAILS, {"tcp_displacement": 150.01},
        "rail"),
    "a plate larger than rail 2": (
        "Kin_Tripod_P3Z", {"arm_length": 269.0} | RAILS, {"tcp_displacement": 20.0, "rail_x_2": -9.0, "rail_y_2": -9.0},
        "rail 2"
    ),
    "a plate larger than rail 3": (
        "Kin_Tripod_P3Z", {"arm_length": 269.0} | RAILS,
        {"tcp_displacement": 20.0, "rail_x_3": 10.0, "rail_y_3": -10.0}, "rail 3"
    ),
    "arms all the same way": ("Kin_Delta_P3C_Type3", DELTA, {f"azimuth_{i}": 30.0 for i in "123"}, "azimuth"),
    "a five-bar too wide": ("Kin_P2C_Type1", FIVE_BAR, {"displacement": 301.0}, "reach the plate"),
    "a five-bar too wide, counted otherwise": ("Kin_P2C_Type2", FIVE_BAR, {"displacement": 301.0}, "reach the plate"),
    "a bipod too wide": ("Kin_Bipod_Rotary", FIVE_BAR, {"displacement": 301.0}, "reach the plate"),
    "rails too far apart": ("Kin_P2X_Type1", BIGLIDE, {"rail_y_2": 301.0}, "between the rails"),
    "an upper arm too long": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_1": 501.0}, "link 1"),
    "a forearm too long behind": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_3": 701.0}, "link 3"),
    "a rod too long": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_4": 501.0}, "link 4"),
    "a crank too long": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_5": 701.0}, "link 5"),
    "drives too far apart": ("Kin_Delta_P3C_Type3", DELTA, WIDE, "reach the plate"),
    "rods too short for the rails": ("Kin_Tripod_P3Z", {"arm_length": 20.0} | RAILS, {}, "reach the plate"),
    "rods that meet two and two": ("Kin_Tripod_P3Z", {"arm_length": 140.0} | RAILS, {}, "reach the plate"),
    "arms that meet two and two": ("Kin_Delta_P3C_Type3", DELTA, EVEN, "reach the plate"),
    "upright rails too far apart": ("Kin_Tripod_Linear", UPRIGHT, {"outer_radius": 461.0}, "reach the plate"),
    "a plate too small for the delta": ("Softkin_Delta_C", CARRIED, {"base_radius": 846.0}, "reach the plate"),
    "a dual SCARA too wide": ("Softkin_DualScara", TWO_ARMS, {"base_distance": 921.0}, "span base_distance"),
    "an arm 1 that stays away": ("Softkin_DualScara", TWO_ARMS, {"arm_length_1": 861.0}, "arm 2 must reach"),
    "an arm 2 that stays away": ("Softkin_DualScara", TWO_ARMS, {"rod_length_2": 801.0}, "arm 1 must reach"),
    "two arms the same way": ("Kin_Delta_P3C_Type3", DELTA, {"azimuth_1": 0.0, "azimuth_2": 90.0, "azimuth_3": 90.0},
        "azimuth"),
}  # fmt: skip
POSSIBLE = {
    "a plate as small as its joints": ("Kin_Tripod_Rotary", TRIPOD, {"stewart_radius": 20.0, "distance": 40.0}),
    "rods that just reach": ("Kin_Tripod_Rotary", TRIPOD, {"arm_length_2": 340.01}),
    "a plate almost as large as the rails": (
        "Kin_Tripod_P3Z",
        {"arm_length": 269.0} | RAILS,
        {"tcp_displacement": 149.99},
    ),
}


@pytest.mark.parametrize("what", IMPOSSIBLE)
def test_dimensions_that_form_no_machine(what: str) -> None:
    """One clear message about the parameters, and no robot."""
    name, given, changes, said = IMPOSSIBLE[what]
    with pytest.raises(KinematicsError, match=said) as refused:
        softkin.catalogue()[name](**given | changes)
    assert refused.value.status is Status.NOT_INITIALIZED
    assert name in str(refused.value)


@pytest.mark.parametrize("what", POSSIBLE)
def test_the_ends_of_what_is_possible(what: str) -> None:
    """Dimensions at the limits of what is possible give a machine that answers."""
    name, given, changes = POSSIBLE[what]
    robot = softkin.catalogue()[name](**given | changes)
    assert robot.forward_batch(np.random.default_rng(1).uniform(-90.0, 90.0, (200, 3)))[3].min() == Status.OK
