"""Kin_TGantry2: two fixed belt drives in T layout."""

from derive.frames import Tx, Ty
from derive.mechanism import Mechanism, Task, Vendor, limited, linear

A = linear("A", "Belt drive A")
B = linear("B", "Belt drive B")

CARRIAGE_X = (A + B) / 2
CARRIAGE_Y = (B - A) / 2

MECHANISM = Mechanism(
    name="Kin_TGantry2",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_Transformation, Kin_TGantry2; the factor 1/2 follows from the belt",
    summary="T-gantry: two fixed belt drives move a carriage in the plane.",
    joints=(A, B),
    chain=Tx(CARRIAGE_X) * Ty(CARRIAGE_Y),
    belt="T",
    task=Task("xy"),
    limited=(
        limited("x", CARRIAGE_X, "X of the carriage", angle=False),
        limited("y", CARRIAGE_Y, "Y of the carriage", angle=False),
    ),
)
