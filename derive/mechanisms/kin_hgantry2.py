"""Kin_HGantry2: two fixed belt drives in H layout."""

from derive.frames import Tx, Ty
from derive.mechanism import Mechanism, Task, Vendor, limited, linear

A = linear("A", "Belt drive A")
B = linear("B", "Belt drive B")

CARRIAGE_X = (A - B) / 2
CARRIAGE_Y = -(A + B) / 2

MECHANISM = Mechanism(
    name="Kin_HGantry2",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_Transformation, Kin_HGantry2; the factor 1/2 follows from the belt",
    summary="H-gantry: two fixed belt drives move a carriage in the plane.",
    joints=(A, B),
    chain=Tx(CARRIAGE_X) * Ty(CARRIAGE_Y),
    belt="H",
    task=Task("xy"),
    limited=(
        limited("x", CARRIAGE_X, "X of the carriage", angle=False),
        limited("y", CARRIAGE_Y, "Y of the carriage", angle=False),
    ),
)
