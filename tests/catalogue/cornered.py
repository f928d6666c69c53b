"""The machines of the tests of corners: special dimensions, random ones, both assembly modes."""

from collections.abc import Iterator, Mapping
from functools import cache

import numpy as np
import softkin

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.corners import DISTANCES, Corner, can_be_at, corners
from tests.catalogue.loop_machines import loop_machines_of
from tests.catalogue.machines import Machine, bare_machine, machine, machines_of
from tests.catalogue.robots import KR6_R900, PUMA_560, UR5
from tests.mechanisms import catalogue

PLACES = 2
"""The number of corners of every combination of factors."""
KR6_D3 = {**KR6_R900, "d3": 40.0}
SPECIAL: dict[str, dict[str, Mapping[str, float]]] = {
    "Kin_Ac6_ThreeParallel": {
        "UR5": UR5,
        "no shift": {**UR5, "d4": 0.0},
        "two links and nothing else": {name: UR5[name] for name in ("a2", "a3")},
        "equal links": {**UR5, "a3": UR5["a2"]},
        "equal links, no shift": {**UR5, "a3": UR5["a2"], "d4": 0.0},
    },
    "Kin_ArticulatedRobot_6DOF": {
        "KR6": KR6_R900,
        "KR6, shifted": KR6_D3,
        "PUMA": PUMA_560,
        "equal links": {**KR6_D3, "a1": 0.0, "a3": 0.0, "a2": 420.0},
    },
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": {
        "KR6": {**KR6_R900, "j6_offset_x": 0.0},
        "equal links": {**KR6_R900, "a1": 0.0, "a3": 0.0, "a2": 420.0, "j6_offset_x": 0.0},
    },
}
"""Dimensions of robots that are sold, and dimensions with coinciding singularities."""
SPECIAL["Kin_Pos_RRR"] = {
    name: {k: v for k, v in given.items() if k != "d6"} for name, given in SPECIAL["Kin_ArticulatedRobot_6DOF"].items()
}
APART = {"Kin_P2X_Type1", "MC_KIN_TYPE_12_XY", "Softkin_ThreeCables", "Softkin_Tripod_Struts"}
"""Loops whose factors vanish together only where nothing controls the plate."""
CANDIDATES = tuple(m for _, m in catalogue() if not (m.is_platform or m.is_orientation or m.drives))
SINGLE = {"Kin_P2X_Type2", "Kin_Polar", "Kin_Polar_Z", "Softkin_SwivelArm", "Softkin_Transmit"}
"""Mechanisms with one factor."""
PAIRED = tuple(m for m in CANDIDATES if softkin.catalogue()[m.name].MARGINS and m.name not in SINGLE)
"""Mechanisms with two factors or more."""


def robots(mechanism: Mechanism) -> Iterator[Machine]:
    if mechanism.rods:
        yield from loop_machines_of(mechanism)[1:3]
        return
    for name, given in SPECIAL.get(mechanism.name, {}).items():
        yield machine(mechanism, name, given)
    if mechanism.search is None:
        yield from machines_of(mechanism)[-1:]
        yield bare_machine(mechanism)


@cache
def places(mechanism: Mechanism) -> tuple[tuple[Machine, Corner], ...]:
    """Corners of two factors, and of three with the first dimensions."""
    rng = np.random.default_rng(5)
    machines = tuple(robots(mechanism))
    wanted = [*((one, 2) for one in machines), (machines[0], 3)]
    return tuple((one, corner) for one, of in wanted for corner in corners(one, PLACES, rng, of=of))


def poses(one: Machine, corner: Corner) -> Array:
    """Axis values at every distance from a corner: one factor, all, one against the others, and any."""
    count, rng = len(corner.names), np.random.default_rng(7)
    ways = [*np.eye(count), np.ones(count), np.array([1.0, -1.0, 1.0])[:count]]
    axes = np.concatenate([corner.beside(d * way) for d in DISTANCES for way in (*ways, rng.uniform(-1.0, 1.0, count))])
    found: Array = axes[can_be_at(one, axes)]
    return found
