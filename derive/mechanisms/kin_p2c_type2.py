"""Kin_P2C_Type2: the planar delta with both arm angles counted counter-clockwise from +X."""

from sympy import cos, sin

from derive.mechanism import (
    Constraint,
    Mechanism,
    Task,
    Vendor,
    X,
    Y,
    assembly,
    branch,
    length,
    optional_length,
    rod,
    rotary,
)
from derive.vectors import cross, minus, vector

L1 = length("inner_arm", "Length of the inner arms", nominal=250.0)
L2 = length("outer_arm", "Length of the outer arms", nominal=500.0)
BASE = optional_length("displacement", "Centre to the motor axes", nominal=120.0)
LINK = optional_length("tcp_link_distance", "Distance of the two rod joints of the plate", nominal=80.0)

A1 = rotary("A1", "Arm on the side of -X, counter-clockwise from +X", nominal=200.0)
A2 = rotary("A2", "Arm on the side of +X, counter-clockwise from +X", nominal=-20.0)

ARM_1 = vector(L1 * cos(A1), L1 * sin(A1))
ARM_2 = vector(L1 * cos(A2), L1 * sin(A2))
KNEE_1 = vector(ARM_1[0] - BASE, ARM_1[1])
KNEE_2 = vector(ARM_2[0] + BASE, ARM_2[1])
JOINT_1, JOINT_2 = vector(X - LINK / 2, Y), vector(X + LINK / 2, Y)
ROD_1, ROD_2 = minus(JOINT_1, KNEE_1), minus(JOINT_2, KNEE_2)

MECHANISM = Mechanism(
    name="Kin_P2C_Type2",
    vendor=Vendor.SINSEGYE,
    family="parallel",
    source="Beckhoff 2D Type 2 (P_2C2); zero and senses are Softkin's definition",
    summary="Planar delta whose arm angles are counted counter-clockwise from +X.",
    parameters=(L1, L2, BASE, LINK),
    joints=(A1, A2),
    rods=(rod("1", KNEE_1, JOINT_1, L2), rod("2", KNEE_2, JOINT_2, L2)),
    task=Task("xy"),
    branches=(
        branch("knee_1", cross(ARM_1, ROD_1), margin="stretched_1", outward=+1, inward=-1),
        branch("knee_2", -cross(ARM_2, ROD_2), margin="stretched_2", outward=+1, inward=-1),
    ),
    assembly=assembly("tcp", cross(ROD_1, ROD_2), margin="arms_aligned", below=-1, above=+1),
    constraints=(Constraint(abs(BASE - LINK / 2) < L1 + L2, "the arms must be able to reach the plate"),),
)
