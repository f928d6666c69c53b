"""Softkin_SkewGantry3: a gantry whose beam is not at right angles to its rails."""

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Vendor, angle, linear, radians

SKEW = angle("skew", "Slide X to the beam; 90 at right angles", nominal=80.0, low=1.0, high=179.0)

X = linear("X", "Rails along X")
Y = linear("Y", "Slide along the beam")
Z = linear("Z", "Slide along Z, up")

MECHANISM = Mechanism(
    name="Softkin_SkewGantry3",
    vendor=Vendor.TEXTBOOK,
    family="gantry",
    source="gantries whose slides are not at right angles",
    summary="Gantry with three slides whose beam stands at an angle to the rails.",
    parameters=(SKEW,),
    joints=(X, Y, Z),
    chain=Tx(X) * Rz(radians(SKEW)) * Tx(Y) * Rz(-radians(SKEW)) * Tz(Z),
    task=Task("xyz"),
)
