"""Kin_ArticulatedRobot_6DOF: an articulated arm with a spherical wrist, by its Denavit-Hartenberg parameters."""

from sympy import cos, pi, sin

from derive.frames import denavit_hartenberg
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, length, optional_length, rotary

D1 = distance("d1", "Height of axis A2 above the base", nominal=350.0)
L1 = optional_length("a1", "Axis A1 to axis A2, forward", nominal=80.0)
L2 = length("a2", "Upper arm, axis A2 to axis A3", nominal=310.0)
D3 = distance("d3", "How far the forearm is beside the upper arm", nominal=50.0)
L3 = optional_length("a3", "Axis A3 to the axis of the forearm", nominal=30.0)
D4 = length("d4", "Forearm, to the wrist centre", nominal=290.0)
D6 = distance("d6", "Wrist centre to the flange", nominal=75.0)
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"Axis {k}", value=f"q{k}") for k in range(1, 7))

MECHANISM = Mechanism(
    name="Kin_ArticulatedRobot_6DOF",
    vendor=Vendor.CODESYS,
    family="articulated",
    source="CODESYS SM3_Transformation",
    summary="Articulated arm with six axes and a spherical wrist.",
    parameters=(D1, L1, L2, D3, L3, D4, D6),
    joints=(A1, A2, A3, A4, A5, A6),
    chain=denavit_hartenberg(
        (A1, D1, L1, pi / 2),
        (A2 + pi / 2, 0, L2, 0),
        (A3, D3, L3, pi / 2),
        (A4, D4, 0, pi / 2),
        (A5, 0, 0, -pi / 2),
        (A6, D6, 0, 0),
    ),
    task=Task("xyz", Turning.FULL),
    branches=(
        branch(
            "arm",
            L1 - L2 * sin(A2) + D4 * cos(A2 + A3) - L3 * sin(A2 + A3),
            front=+1,
            back=-1,
            margin="wrist_on_axis_1",
        ),
        branch("elbow", L3 * sin(A3) - D4 * cos(A3), down=-1, up=+1),
        branch("hand", sin(A5), down=+1, up=-1, margin="a4_parallel_a6"),
    ),
    offset_interface=False,
)
