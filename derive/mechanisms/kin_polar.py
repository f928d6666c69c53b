"""Kin_Polar: a turning arm of variable length."""

from derive.frames import Rz, Tx
from derive.mechanism import Mechanism, Task, Vendor, linear, rotary

C = rotary("C", "Arm about Z")
R = linear("R", "Radius, never negative", domain=(0.0, 1e9), nominal=200.0)

MECHANISM = Mechanism(
    name="Kin_Polar",
    vendor=Vendor.CODESYS,
    family="polar",
    source="CODESYS SM3_Transformation, Kin_Polar",
    summary="Polar kinematics: an arm of variable length that turns about Z.",
    joints=(C, R),
    chain=Rz(C) * Tx(R),
    task=Task("xy"),
    positive=(R,),
    offset_interface=False,
    notes=(
        'As CODESYS\'s own block it has no orientation mode "Axis": a point beside the arm has two radii.',
        "The centre is a singularity: the direction of the arm is then the reference's.",
    ),
)
