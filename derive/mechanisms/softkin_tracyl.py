"""Softkin_Tracyl: milling on the mantle of a round part that turns, with the axes X, C and Z of a lathe."""

from derive.frames import Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, Vendor, driving, length, linear

RADIUS = length("radius", "Radius of the mantle", nominal=40.0)
X = linear("X", "Slide from the axis of the part to the tool", nominal=40.0)
C = driving("C", "Part about Z: positive turns it from X to Y")
Z = linear("Z", "Slide along the axis of the part")

MECHANISM = Mechanism(
    name="Softkin_Tracyl",
    vendor=Vendor.TEXTBOOK,
    family="polar",
    source="lathes with a driven tool: milling on a mantle (TRACYL, G7.1)",
    summary="Milling on a mantle with the axes X, C and Z of a lathe: the frame is the mantle, unrolled to a plane.",
    parameters=(RADIUS,),
    joints=(X, C, Z),
    chain=Tx(X) * Tx(-RADIUS) * Ty(-RADIUS * C) * Tz(Z),
    task=Task("xyz"),
    notes=(
        "x is the height above the mantle, y the way around it, z the way along it. y may be longer than the mantle "
        "is round: C then turns on.",
    ),
)
