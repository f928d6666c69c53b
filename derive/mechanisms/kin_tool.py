"""Kin_Tool: a tool that is shifted from the flange and does not turn."""

from derive.frames import Txyz
from derive.mechanism import Mechanism, Task, Vendor, distance

TX = distance("tool_x", "Flange to the tool, along X", nominal=15.0)
TY = distance("tool_y", "Flange to the tool, along Y", nominal=-8.0)
TZ = distance("tool_z", "Flange to the tool, along Z", nominal=-60.0)

MECHANISM = Mechanism(
    name="Kin_Tool",
    vendor=Vendor.CODESYS,
    family="orientation",
    source="CODESYS SM3_Transformation",
    summary="Orientation kinematics without an axis: a tool that is shifted from the flange.",
    parameters=(TX, TY, TZ),
    joints=(),
    chain=Txyz(TX, TY, TZ),
    task=Task(""),
    notes=("A tool that is also turned against the flange is set by SMC_GroupSetTool.",),
)
