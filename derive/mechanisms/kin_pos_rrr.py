"""Kin_Pos_RRR: an arm of three turning axes that carries any wrist, by its Denavit-Hartenberg parameters."""

from sympy import cos, pi, sin

from derive.frames import Tz, denavit_hartenberg
from derive.mechanism import Mechanism, Task, Vendor, branch, distance, length, optional_length, rotary

D1 = distance("d1", "Height of axis A2 above the base", nominal=350.0)
L1 = optional_length("a1", "Axis A1 to axis A2, forward", nominal=80.0)
L2 = length("a2", "Upper arm, axis A2 to axis A3", nominal=310.0)
D3 = distance("d3", "How far the forearm is beside the upper arm", nominal=50.0)
L3 = optional_length("a3", "Axis A3 to the axis of the forearm", nominal=30.0)
D4 = length("d4", "Forearm, to the flange", nominal=290.0)
A1, A2, A3 = (rotary(f"A{k}", f"Axis {k}", value=f"q{k}") for k in range(1, 4))

MECHANISM = Mechanism(
    name="Kin_Pos_RRR",
    vendor=Vendor.CODESYS,
    family="articulated",
    source="CODESYS SM3_Transformation",
    summary="Arm with three turning axes, the position part of an articulated robot.",
    parameters=(D1, L1, L2, D3, L3, D4),
    joints=(A1, A2, A3),
    chain=denavit_hartenberg((A1, D1, L1, pi / 2), (A2 + pi / 2, 0, L2, 0), (A3, D3, L3, pi / 2)) * Tz(D4),
    task=Task("xyz"),
    branches=(
        branch(
            "arm",
            L1 - L2 * sin(A2) + D4 * cos(A2 + A3) - L3 * sin(A2 + A3),
            front=+1,
            back=-1,
            margin="point_on_axis_1",
        ),
        branch("elbow", L3 * sin(A3) - D4 * cos(A3), down=-1, up=+1),
    ),
)
