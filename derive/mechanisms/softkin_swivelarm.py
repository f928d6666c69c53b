"""Softkin_SwivelArm: an arm that swings on a lift; x and z are commanded, and the swing decides what y is."""

from sympy import sin

from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, length, linear, rotary

ARM = length("arm_length", "Axis A1 to axis A3", nominal=400.0)

A1 = rotary("A1", "Swing of the arm about Z")
A2 = linear("A2", "Lift along Z, up")
A3 = rotary("A3", "Tool about Z")

MECHANISM = Mechanism(
    name="Softkin_SwivelArm",
    vendor=Vendor.TEXTBOOK,
    family="polar",
    source="swivel arms: one arm that swings on a lift, and a tool that turns",
    summary="Swivel arm: an arm that swings on a lift brings its tool to x and z, and turns it about Z.",
    parameters=(ARM,),
    joints=(A1, A2, A3),
    chain=Tz(A2) * Rz(A1) * Tx(ARM) * Rz(A3),
    task=Task("xz", Turning.ABOUT_Z, passive="y"),
    branches=(branch("side", sin(A1), left=+1, right=-1),),
    notes=("The tool stays on a cylinder about axis A1.",),
)
