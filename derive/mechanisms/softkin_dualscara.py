"""Softkin_DualScara: two arms with rods carry a quill, which lifts and turns the tool."""

from sympy import cos, sin

from derive.mechanism import (
    Constraint,
    Mechanism,
    Task,
    Turning,
    Vendor,
    X,
    Y,
    Z,
    assembly,
    branch,
    length,
    linear,
    optional_length,
    rod,
    rotary,
)
from derive.vectors import cross, minus, vector

APART = optional_length("base_distance", "Distance of the two motor axes", nominal=140.0)
ARM_LENGTHS = [length(f"arm_length_{i}", f"Length of arm {i}, motor to elbow", nominal=200.0) for i in (1, 2)]
ROD_LENGTHS = [length(f"rod_length_{i}", f"Length of rod {i}, elbow to quill", nominal=260.0) for i in (1, 2)]

A1 = rotary("A1", "Arm 1 about Z, from +X; its motor is on the side of -X", nominal=130.0)
A2 = rotary("A2", "Arm 2 about Z, from +X; its motor is on the side of +X", nominal=50.0)
A3 = linear("A3", "Quill along Z, up", nominal=-60.0)
A4 = rotary("A4", "Quill about Z")

ARM_1, ARM_2 = (vector(size * cos(a), size * sin(a)) for size, a in zip(ARM_LENGTHS, (A1, A2), strict=True))
ELBOW_1, ELBOW_2 = vector(ARM_1[0] - APART / 2, ARM_1[1]), vector(ARM_2[0] + APART / 2, ARM_2[1])
QUILL = vector(X, Y)
FAR = [arm + rod for arm, rod in zip(ARM_LENGTHS, ROD_LENGTHS, strict=True)]
NEAR = [abs(arm - rod) for arm, rod in zip(ARM_LENGTHS, ROD_LENGTHS, strict=True)]
ROD_1, ROD_2 = minus(QUILL, ELBOW_1), minus(QUILL, ELBOW_2)

MECHANISM = Mechanism(
    name="Softkin_DualScara",
    vendor=Vendor.TEXTBOOK,
    family="scara",
    source="Five-bar linkage with a quill in the joint of its rods, as in double-arm SCARA robots",
    summary="Dual SCARA: two arms with rods carry a quill, which lifts and turns the tool.",
    parameters=(APART, *ARM_LENGTHS, *ROD_LENGTHS),
    joints=(A1, A2, A3, A4),
    rods=(rod("1", ELBOW_1, QUILL, ROD_LENGTHS[0]), rod("2", ELBOW_2, QUILL, ROD_LENGTHS[1])),
    closure=(Z - A3,),
    heading=A4,
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(
        branch("elbow_1", -cross(ARM_1, ROD_1), margin="stretched_1", outward=+1, inward=-1),
        branch("elbow_2", cross(ARM_2, ROD_2), margin="stretched_2", outward=+1, inward=-1),
    ),
    assembly=assembly("tcp", cross(ROD_1, ROD_2), margin="rods_aligned", front=+1, back=-1),
    constraints=(
        Constraint(FAR[0] + FAR[1] > APART, "the arms and rods must be able to span base_distance"),
        Constraint(NEAR[0] < APART + FAR[1], "arm 2 must reach where arm 1 does"),
        Constraint(NEAR[1] < APART + FAR[0], "arm 1 must reach where arm 2 does"),
    ),
    notes=(
        "The origin is the middle between the motor axes, which stand on the X axis. Front is the side of +Y.",
        "A motor axis in common, base_distance 0, is a machine too: the two arms turn about Z.",
    ),
)
