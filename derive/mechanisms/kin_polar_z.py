"""Kin_Polar_Z: a turning arm of variable length, and Z."""

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Vendor, linear, rotary

C = rotary("C", "Arm about Z")
R = linear("R", "Radius, never negative", domain=(0.0, 1e9), nominal=200.0)
Z = linear("Z", "Lift along Z")

MECHANISM = Mechanism(
    name="Kin_Polar_Z",
    vendor=Vendor.CODESYS,
    family="polar",
    source="CODESYS SM3_Transformation, Kin_Polar",
    summary="Polar kinematics: an arm of variable length that turns about Z, and Z.",
    joints=(C, R, Z),
    chain=Rz(C) * Tx(R) * Tz(Z),
    task=Task("xyz"),
    positive=(R,),
    offset_interface=False,
    notes=(
        'As CODESYS\'s own block it has no orientation mode "Axis": a point beside the arm has two radii.',
        "The centre is a singularity: the direction of the arm is then the reference's.",
    ),
)
