"""Kin_Ac6_ThreeParallel: an arm whose axes A2, A3 and A4 are parallel, by its standard Denavit-Hartenberg
parameters."""

from sympy import cos, pi, sin

from derive.frames import denavit_hartenberg
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, rotary, signed_length

D1 = distance("d1", "Height of axis A2 above the base", nominal=89.159)
L2 = signed_length("a2", "Upper arm, axis A2 to axis A3", nominal=-425.0)
L3 = signed_length("a3", "Forearm, axis A3 to axis A4", nominal=-392.25)
D4 = distance("d4", "How far the wrist is beside the arm", nominal=109.15)
D5 = distance("d5", "Axis A4 to axis A6, along axis A5", nominal=94.65)
D6 = distance("d6", "Axis A5 to the flange, along axis A6", nominal=82.3)
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"Axis {k}", value=f"q{k}") for k in range(1, 7))
FORWARD = L2 * cos(A2) + L3 * cos(A2 + A3) + D5 * sin(A2 + A3 + A4)
"""How far in front of axis A1 the wrist is."""

MECHANISM = Mechanism(
    name="Kin_Ac6_ThreeParallel",
    vendor=Vendor.TEXTBOOK,
    family="articulated",
    source="standard Denavit-Hartenberg parameters as Universal Robots publishes them",
    summary="Arm with six axes of which the second, third and fourth are parallel.",
    parameters=(D1, L2, L3, D4, D5, D6),
    joints=(A1, A2, A3, A4, A5, A6),
    chain=denavit_hartenberg(
        (A1, D1, 0, pi / 2), (A2, 0, L2, 0), (A3, 0, L3, 0), (A4, D4, 0, pi / 2), (A5, D5, 0, -pi / 2), (A6, D6, 0, 0)
    ),
    task=Task("xyz", Turning.FULL),
    branches=(
        branch("shoulder", FORWARD, left=-1, right=+1, margin="wrist_on_axis_1"),
        branch("elbow", sin(A3), up=+1, down=-1),
        branch("wrist", sin(A5), down=+1, up=-1, margin="a4_parallel_a6"),
    ),
    offset_interface=False,
)
