"""Softkin_SwivelArm: an arm that swings on a lift; x and z are commanded, and the swing decides what y is."""

from sympy import cos, sin

from derive.mechanism import Mechanism, Task, Turning, Vendor, X, Z, branch, length, linear, rotary

ARM = length("arm_length", "Axis A1 to the axis of the tool", nominal=400.0)

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
    closure=(X - ARM * cos(A1), Z - A2),
    heading=A1 + A3,
    task=Task("xz", Turning.ABOUT_Z),
    branches=(branch("side", sin(A1), left=+1, right=-1),),
    notes=("The tool stays on a cylinder about the axis of the arm: y is not commanded.",),
)
