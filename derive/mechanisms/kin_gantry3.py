"""Kin_Gantry3: Cartesian axes."""

from derive.frames import Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Vendor, linear

X = linear("X", "Carriage along X")
Y = linear("Y", "Carriage along Y")
Z = linear("Z", "Carriage along Z")

MECHANISM = Mechanism(
    name="Kin_Gantry3",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_Transformation, Kin_Gantry3",
    summary="Gantry with three Cartesian axes.",
    joints=(X, Y, Z),
    chain=Tx(X) * Ty(Y) * Tz(Z),
    task=Task("xyz"),
)
