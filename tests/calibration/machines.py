"""Machines of the catalogue with dimensions, and random deviations of them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import softkin
from numpy.random import Generator

from tests.catalogue.robots import KR6_R900, UR5

SCARA = {"link_length_1": 325.0, "link_length_2": 225.0}
TILT, SHIFT, GAIN = np.degrees(5e-3), 5.0, 1e-4
"""The largest deviations: 5 mrad, 5 mm, and one part in ten thousand."""
SERIAL: dict[str, dict[str, float]] = {
    "Kin_ArticulatedRobot_6DOF": KR6_R900,
    "Kin_Ac6_ThreeParallel": UR5,
    "Kin_Scara3_Z": {"arm_length_1": 300.0, "arm_length_2": 250.0, "arm_length_3": 80.0, "offset_a2": 12.0},
    "Kin_Scara4_ZCcoupled_Type1": {**SCARA, "pitch_zc": 20.0},
    "Kin_Scara4_CCZC_ZCcoupled": {**SCARA, "gear_coupling": 0.05, "flange_down": 1.0},
    "Softkin_TableTable_AC": {"pivot_y": 40.0, "pivot_z": -60.0, "tool_length": 120.0},
    "Softkin_HeadTable_BC": {"head_offset": 35.0, "pivot_length": 240.0},
    "Softkin_ScaraOnRail": SCARA,
    "Kin_SCCC": {"link_length_1": 300.0, "link_length_2": 250.0, "link_length_3": 80.0, "coupling_12": -1.0},
    "Kin_Gantry2": {},
    "Kin_TGantry3": {},
    "Kin_Wrist3": {},
}
DELTA = {"azimuth_1": 0.0, "azimuth_2": 120.0, "azimuth_3": -120.0}
ARM = {"base_radius": 140.0, "inner_arm": 200.0, "outer_arm": 450.0, "tcp_radius": 45.0}
LOOPS = {"Kin_Delta_P3C_Type3": {**DELTA, **{f"{word}_{i}": value for word, value in ARM.items() for i in "123"}}}


@dataclass(frozen=True)
class Planted:
    """A machine with planted deviations."""

    name: str
    given: Mapping[str, float]
    deviations: Mapping[str, float]

    @property
    def nominal(self) -> softkin.Mechanism:
        """As it is drawn."""
        return softkin.catalogue()[self.name](**self.given)

    @property
    def true(self) -> softkin.Mechanism:
        """As it is."""
        return self.nominal.calibrated(self.deviations)


def planted(name: str, rng: Generator, share: float = 1.0) -> Planted:
    """A machine with random deviations. share: their size, in shares of the largest ones."""
    given = SERIAL.get(name) or LOOPS.get(name) or {}
    names = softkin.catalogue()[name](**given).deviations
    sizes = {n: share * (GAIN if n.endswith("gain") else TILT if _turns(n) else SHIFT) for n in names}
    return Planted(name, given, {n: float(size * rng.uniform(-1.0, 1.0)) for n, size in sizes.items()})


def _turns(name: str) -> bool:
    return "tilt" in name or "azimuth" in name or name.rpartition("_")[2] in ("a", "b", "c", "offset")


def drawn_axes(robot: softkin.Mechanism, count: int, rng: Generator) -> list[tuple[float, ...]]:
    """Random axis values: angles up to 170 degrees, lengths from 20 to 300."""
    ends = [(-170.0, 170.0) if axis.unit == "deg" else (20.0, 300.0) for axis in robot.AXES]
    return [tuple(rng.uniform(low, high) for low, high in ends) for _ in range(count)]
