"""Kin_GantryCutter3: Cartesian axes and a knife that turns about Z."""

from derive.frames import Rz, Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, linear, rotary, sign

DIRECTION = sign("direction_r", "Direction of the knife axis: 1 counter-clockwise, -1 clockwise")

X = linear("X", "Carriage along X")
Y = linear("Y", "Carriage along Y")
Z = linear("Z", "Carriage along Z")
R = rotary("R", "Knife about Z")

MECHANISM = Mechanism(
    name="Kin_GantryCutter3",
    vendor=Vendor.CODESYS,
    family="gantry",
    source="CODESYS SM3_CNC, SMC_TRAFO_GantryCutter, as a kinematics of an axis group: Softkin's definition",
    summary="Gantry with three Cartesian axes and a knife that turns about Z.",
    parameters=(DIRECTION,),
    joints=(X, Y, Z, R),
    chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(DIRECTION * R),
    task=Task("xyz", Turning.ABOUT_Z),
)
