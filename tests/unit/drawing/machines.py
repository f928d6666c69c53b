"""Machines whose drawings are tested: one of every kind of chain and loop; the truth is their closure."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from derive.description.mechanism import Mechanism
from derive.drawing.drawing import Drawing, drawing_of
from derive.witness.closure import Closure, closure_of
from tests.mechanisms import catalogue, kinematics_of

CATALOGUE = {mechanism.name: mechanism for _, mechanism in catalogue()}
KINDS = (
    "Kin_Scara4_CCZC_ZCcoupled", "Kin_SCCC", "Kin_HGantry3", "Kin_GantryCutter2", "Kin_Ac6_ThreeParallel", "Kin_Wrist2",
    "Kin_Polar_Z", "Kin_P2C_Type1", "Kin_P2X_Type2", "Kin_PCC", "Kin_Crane", "MC_KIN_TYPE_12_XY", "Kin_Tripod_Rotary",
    "Kin_Tripod_P3Z", "Kin_Tripod_Linear", "Kin_Delta_P3C_Type3", "Kin_Hexapod",
)  # fmt: skip

CHAINS = tuple(name for name in KINDS if CATALOGUE[name].chain is not None)
RODS = tuple(name for name in KINDS if CATALOGUE[name].rods and not CATALOGUE[name].bars)
"""Loops whose bars are their rods."""


@dataclass(frozen=True)
class Drawn:
    """A mechanism, its drawing, and its closure at nominal parameters."""

    mechanism: Mechanism
    drawing: Drawing
    closure: Closure

    @property
    def parameters(self) -> np.ndarray:
        """A row of parameters, as the closure takes them."""
        nominal = {p.name: p.nominal for p in self.mechanism.parameters}
        return np.array([[nominal.get(name, 0.0) for name in self.closure.parameters]])

    @property
    def joints(self) -> np.ndarray:
        """A row of joint values at the drawn pose."""
        return self.joints_at(self.axes)

    def joints_at(self, axes: np.ndarray) -> np.ndarray:
        """Joint values at axis values."""
        return self.closure.joints(axes, self.parameters)[:, :, 0]

    @property
    def axes(self) -> np.ndarray:
        return np.array([[value for _, value in self.drawing.axes]])

    @property
    def pose(self) -> np.ndarray:
        """A row with the tool frame of the drawing: position, then rotation by rows."""
        tool = self.drawing.scene.tool
        return np.array([[*tool.position, *(entry for row in tool.rotation for entry in row)]])


@cache
def drawn(name: str) -> Drawn:
    """The drawing of a mechanism of the catalogue."""
    mechanism = CATALOGUE[name]
    kinematics = kinematics_of(mechanism)
    return Drawn(mechanism, drawing_of(kinematics), closure_of(mechanism, kinematics.mechanism))
