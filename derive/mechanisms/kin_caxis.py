"""Kin_CAxis: a turn about Z at the flange."""

from derive.frames import Rz
from derive.mechanism import Mechanism, Task, Turning, Vendor, rotary

C = rotary("C", "Turn about the flange's Z")

MECHANISM = Mechanism(
    name="Kin_CAxis",
    vendor=Vendor.CODESYS,
    family="orientation",
    source="CODESYS SM3_Transformation",
    summary="Orientation kinematics with one axis about Z.",
    joints=(C,),
    chain=Rz(C),
    task=Task("", Turning.ABOUT_Z),
)
