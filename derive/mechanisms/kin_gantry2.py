"""Kin_Gantry2: Cartesian axes."""

from derive.frames import Tx, Ty
from derive.mechanism import Mechanism, Task, Vendor, linear

X = linear("X", "Carriage along X")
Y = linear("Y", "Carriage along Y")

MECHANISM = Mechanism(
    name="Kin_Gantry2",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_Transformation, Kin_Gantry2",
    summary="Gantry with two Cartesian axes.",
    joints=(X, Y),
    chain=Tx(X) * Ty(Y),
    task=Task("xy"),
)
