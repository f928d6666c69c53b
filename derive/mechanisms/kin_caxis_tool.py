"""Kin_CAxis_Tool: a turn about Z at the flange that carries a shifted tool."""

from derive.frames import Rz, Txyz
from derive.mechanism import Mechanism, Task, Turning, Vendor, distance, rotary

TX = distance("tool_x", "Flange to the tool, along the turned X", nominal=15.0)
TY = distance("tool_y", "Flange to the tool, along the turned Y", nominal=-8.0)
TZ = distance("tool_z", "Flange to the tool, along Z", nominal=-60.0)
C = rotary("C", "Turn about the flange's Z")

MECHANISM = Mechanism(
    name="Kin_CAxis_Tool",
    vendor=Vendor.CODESYS,
    family="orientation",
    source="CODESYS SM3_Transformation",
    summary="Orientation kinematics with one axis about Z and a tool that is shifted from it.",
    parameters=(TX, TY, TZ),
    joints=(C,),
    chain=Rz(C) * Txyz(TX, TY, TZ),
    task=Task("", Turning.ABOUT_Z),
    notes=("With an X or Y offset it can only be combined with a flange that keeps its orientation.",),
)
