"""Softkin_Bipod_C: a planar delta, two arms and a plate, whose third motor turns the tool by brackets."""

from sympy import cos, sin

from derive.mechanism import (
    Constraint,
    Mechanism,
    Task,
    Turning,
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
PLATE = optional_length("tcp_displacement", "Centre of the plate to its rod joints", nominal=40.0)

A1 = rotary("A1", "Arm on the side of -X, from horizontal outward; positive is down")
A2 = rotary("A2", "Arm on the side of +X, from horizontal outward; positive is down")
A3 = rotary("A3", "Motor on the base that turns the tool about Z, by brackets")

ARM_1 = vector(-L1 * cos(A1), -L1 * sin(A1))
ARM_2 = vector(L1 * cos(A2), -L1 * sin(A2))
KNEE_1 = vector(ARM_1[0] - BASE, ARM_1[1])
KNEE_2 = vector(ARM_2[0] + BASE, ARM_2[1])
JOINT_1, JOINT_2 = vector(X - PLATE, Y), vector(X + PLATE, Y)
ROD_1, ROD_2 = minus(JOINT_1, KNEE_1), minus(JOINT_2, KNEE_2)

MECHANISM = Mechanism(
    name="Softkin_Bipod_C",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="planar deltas with a tool that turns; the bracket as Softkin defines it: the tool turns as its motor does",
    summary="Planar delta whose third motor turns the tool by brackets, in the X-Y plane.",
    parameters=(L1, L2, BASE, PLATE),
    joints=(A1, A2, A3),
    rods=(rod("1", KNEE_1, JOINT_1, L2), rod("2", KNEE_2, JOINT_2, L2)),
    heading=A3,
    task=Task("xy", Turning.ABOUT_Z),
    branches=(
        branch("knee_1", cross(ARM_1, ROD_1), margin="stretched_1", outward=+1, inward=-1),
        branch("knee_2", -cross(ARM_2, ROD_2), margin="stretched_2", outward=+1, inward=-1),
    ),
    assembly=assembly("tcp", cross(ROD_1, ROD_2), margin="arms_aligned", below=-1, above=+1),
    constraints=(Constraint(abs(BASE - PLATE) < L1 + L2, "the arms must be able to reach the plate"),),
    notes=(
        "The brackets are parallelograms along an arm and a rod: the tool has the angle of the motor A3, wherever the "
        "plate is. The plate itself does not turn.",
    ),
)
