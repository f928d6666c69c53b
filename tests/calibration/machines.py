"""Machines that are calibrated, and their true dimensions, by definition alone."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import softkin
import sympy as sp
from numpy.random import Generator
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.geometry.frames import Factor, Motion
from derive.ir.constants import DEGREE
from tests.catalogue.robots import KR6_R900, UR5
from tests.mechanisms import named
from tests.orthonormal import turned

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


Array = NDArray[np.float64]
DEG = np.pi / 180.0


class Truth:
    """The chain of one machine."""

    def __init__(self, name: str, given: Mapping[str, float], deviations: Mapping[str, float]) -> None:
        """given: the parameters by name. deviations: in degrees and lengths."""
        self.mechanism: Mechanism = named(name)
        self.off, self.given = dict(deviations), given
        joints = self.mechanism.joints
        known = {p.symbol: given.get(p.name, p.default or 0.0) for p in self.mechanism.parameters} | {DEGREE: DEG}
        values = {j.symbol: sp.sympify(j.ratio * j.motor + j.coupling).subs(known) for j in joints}
        assert self.mechanism.chain is not None
        self.factors = self.mechanism.chain.factors
        amounts = [sp.sympify(f.amount) for f in self.factors]
        self.fixed = [float(a.subs(dict.fromkeys(values, 0)).subs(known)) for a in amounts]
        self.moved = sp.lambdify([j.motor for j in joints], [a.subs(values).subs(known) for a in amounts])
        self.names: list[str | None] = []
        for amount in amounts:
            own = [j.key for j in joints if j.symbol in amount.free_symbols]
            self.names.append(next((key for key in own if key not in self.names), None))

    def forward(self, axes: Sequence[float]) -> Array:
        """The matrix (4, 4) of the frame at axis values."""
        motors = []
        for j, axis in zip(self.mechanism.joints, axes, strict=True):
            moved = (axis - self.given.get(f"offset_{j.key}", 0.0)) * (1.0 + self._of(f"{j.key}_gain"))
            motors.append((DEG if j.in_degrees else 1.0) * (moved + self._of(f"{j.key}_offset")))
        found = self._end("base")
        for factor, name, fixed, amount in zip(self.factors, self.names, self.fixed, self.moved(*motors), strict=True):
            if name is not None:
                line = self._line(name, factor.axis)
                found = found @ line @ motion(factor, amount - fixed) @ np.linalg.inv(line)
            found = found @ motion(factor, fixed)
        return found @ self._end("tool")

    def _of(self, name: str) -> float:
        return self.off.get(name, 0.0)

    def _line(self, name: str, axis: int) -> Array:
        """Where the line of an axis is, seen from where it is drawn: in a frame with that axis as z."""
        own = np.eye(4)
        own[:3, :3] = np.roll(np.eye(3), axis + 1, axis=0)
        shift = np.eye(4)
        shift[:2, 3] = self._of(f"{name}_shift_x"), self._of(f"{name}_shift_y")
        return own @ shift @ about(0, self._of(f"{name}_tilt_x")) @ about(1, self._of(f"{name}_tilt_y")) @ own.T

    def _end(self, end: str) -> Array:
        found = np.eye(4)
        found[:3, 3] = [self._of(f"{end}_{k}") for k in "xyz"]
        return found @ about(2, self._of(f"{end}_c")) @ about(1, self._of(f"{end}_b")) @ about(0, self._of(f"{end}_a"))


def about(axis: int, degrees: float) -> Array:
    """A rotation about x, y or z."""
    found = np.eye(4)
    found[:3, :3] = turned(axis, DEG * degrees)
    return found


def motion(factor: Factor, amount: float) -> Array:
    """The matrix of a factor of a chain."""
    if factor.motion is Motion.SHIFT:
        found = np.eye(4)
        found[factor.axis, 3] = amount
        return found
    return about(factor.axis, 180.0 * amount if factor.motion is Motion.FLIP else amount / DEG)
