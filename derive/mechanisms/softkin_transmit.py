"""Softkin_Transmit: milling on the face of a part that turns, with the axes X, Z and C of a lathe."""

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Vendor, linear, rotary

X = linear("X", "Slide from the axis of the part to the tool, never negative", domain=(0.0, 1e9), nominal=60.0)
Z = linear("Z", "Slide along the axis of the part")
C = rotary("C", "Part about Z: positive turns it from X to Y")

MECHANISM = Mechanism(
    name="Softkin_Transmit",
    vendor=Vendor.TEXTBOOK,
    family="polar",
    source="lathes with a driven tool: polar milling on a face (TRANSMIT, G12.1)",
    summary="Milling on a face with the axes X, Z and C of a lathe: the frame is that of the part, which turns.",
    joints=(X, Z, C),
    chain=Rz(-C) * Tx(X) * Tz(Z),
    task=Task("xyz"),
    positive=(X,),
    offset_interface=False,
    notes=("The axis of the part is a singularity: there C is that of the reference.",),
)
