"""Softkin_Painter: a painting arm whose hollow wrist has three axes, each inclined to the next by one angle."""

from sympy import cos, sin

from derive.frames import Rx, Ry, Rz, Tx, Tz
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    angle,
    branch,
    distance,
    length,
    optional_length,
    radians,
    rotary,
)

HEIGHT = distance("base_height", "Height of axis A2 above the base", nominal=500.0)
AHEAD = optional_length("shoulder_offset", "Axis A1 to axis A2, forward", nominal=200.0)
UPPER = length("link_length_2", "Upper arm, axis A2 to axis A3", nominal=800.0)
FOREARM = length("link_length_3", "Forearm, axis A3 to the wrist centre", nominal=900.0)
FLANGE = distance("flange_length", "Wrist centre to the flange, along axis A6", nominal=150.0)
INCLINED = angle("wrist_angle", "Axis A4 to axis A5, and A5 to A6", nominal=60.0, low=1.0, high=89.0)
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"Axis {k}") for k in range(1, 7))

MECHANISM = Mechanism(
    name="Softkin_Painter",
    vendor=Vendor.TEXTBOOK,
    family="articulated",
    source="painting robots with a hollow wrist",
    summary="Painting arm with six axes: those of its hollow wrist are inclined to each other by one angle.",
    parameters=(HEIGHT, AHEAD, UPPER, FOREARM, FLANGE, INCLINED),
    joints=(A1, A2, A3, A4, A5, A6),
    chain=Rz(A1)
    * Tz(HEIGHT)
    * Tx(AHEAD)
    * Ry(A2)
    * Tz(UPPER)
    * Ry(A3)
    * Tx(FOREARM)
    * Rx(A4)
    * Ry(radians(INCLINED))
    * Rx(A5)
    * Ry(-radians(INCLINED))
    * Rx(A6)
    * Tx(FLANGE),
    task=Task("xyz", Turning.FULL),
    branches=(
        branch(
            "arm",
            AHEAD + UPPER * sin(A2) + FOREARM * cos(A2 + A3),
            front=+1,
            back=-1,
            margin="wrist_on_axis_1",
        ),
        branch("elbow", cos(A3), up=+1, down=-1),
        branch("hand", sin(A5), positive=+1, negative=-1, margin="a4_parallel_a6"),
    ),
    offset_interface=False,
    notes=(
        "The wrist is straight where A5 is 0. The flange leans from axis A4 by up to twice wrist_angle: a rotation "
        "beyond that is refused, as A5 out of reach.",
    ),
)
