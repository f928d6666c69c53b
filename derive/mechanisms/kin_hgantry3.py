"""Kin_HGantry3: two fixed belt drives in H layout, and Z."""

from derive.frames import Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Vendor, limited, linear

A = linear("A", "Belt drive A")
B = linear("B", "Belt drive B")
Z = linear("Z", "Carriage along Z")

CARRIAGE_X = (A - B) / 2
CARRIAGE_Y = -(A + B) / 2

MECHANISM = Mechanism(
    name="Kin_HGantry3",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_Transformation, Kin_HGantry3; the factor 1/2 follows from the belt",
    summary="H-gantry: two fixed belt drives move a carriage in the plane, a third axis lifts.",
    joints=(A, B, Z),
    chain=Tx(CARRIAGE_X) * Ty(CARRIAGE_Y) * Tz(Z),
    belt="H",
    task=Task("xyz"),
    limited=(
        limited("x", CARRIAGE_X, "X of the carriage", angle=False),
        limited("y", CARRIAGE_Y, "Y of the carriage", angle=False),
    ),
)
