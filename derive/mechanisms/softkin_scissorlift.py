"""Softkin_ScissorLift: a lifting table on scissors, whose lower rollers a horizontal cylinder moves; a table turns."""

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, distance, driven, length, linear, rotary

BEAM = length("beam_length", "Beams of the scissors, from pin to roller", nominal=1600.0)
TOP = distance("table_height", "Upper pins to the table", nominal=120.0)

LIFT = linear("H", "Upper pins above the lower ones", nominal=800.0)
S1 = linear("S1", "Cylinder: fixed lower pin to the rollers", nominal=1385.6)
A2 = rotary("A2", "Table about Z")

MECHANISM = Mechanism(
    name="Softkin_ScissorLift",
    vendor=Vendor.TEXTBOOK,
    family="gantry",
    source="scissor lifting tables with a turntable",
    summary="Scissor lift: a horizontal cylinder lifts a table, which turns.",
    parameters=(BEAM, TOP),
    joints=(S1, A2),
    chain=Tz(LIFT) * Tz(TOP) * Rz(A2),
    drives=(driven(LIFT, by=S1, start=Tx(S1), tip=Tz(LIFT), length=BEAM),),
    task=Task("z", Turning.ABOUT_Z),
)
