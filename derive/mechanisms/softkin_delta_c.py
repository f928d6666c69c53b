"""Softkin_Delta_C: a symmetric rotary delta whose telescopic shaft turns the tool."""

from sympy import Rational, cos, pi, sin

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
    optional_length,
    rod,
    rotary,
)
from derive.vectors import dot, minus, triple, vector

BASE = length("base_radius", "Origin to the motor axes of the arms", nominal=160.0)
ARM = length("arm_length", "Length of the arms", nominal=240.0)
ROD = length("rod_length", "Length of the rods", nominal=560.0)
PLATE = optional_length("plate_radius", "Centre of the plate to the joints of the rods", nominal=45.0)

A1, A2, A3 = ARMS = tuple(rotary(f"A{i}", f"Arm {i}, from horizontal outward; positive is down") for i in (1, 2, 3))
A4 = rotary("A4", "Telescopic shaft, which turns the tool about Z")

OUT = [vector(cos(pi * k), sin(pi * k)) for k in (Rational(0), Rational(2, 3), Rational(4, 3))]
KNEES = [
    vector((BASE + ARM * cos(a)) * c, (BASE + ARM * cos(a)) * s, -ARM * sin(a))
    for a, (c, s) in zip(ARMS, OUT, strict=True)
]
JOINTS = [vector(X + PLATE * c, Y + PLATE * s, Z) for c, s in OUT]
RODS = [minus(joint, knee) for joint, knee in zip(JOINTS, KNEES, strict=True)]

MECHANISM = Mechanism(
    name="Softkin_Delta_C",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="Clavel, Device for the Movement and Positioning of an Element in Space, US patent 4976582",
    summary="Rotary delta whose telescopic shaft turns the tool about Z.",
    parameters=(BASE, ARM, ROD, PLATE),
    joints=(*ARMS, A4),
    rods=tuple(rod(str(k), knee, joint, ROD) for k, (knee, joint) in enumerate(zip(KNEES, JOINTS, strict=True), 1)),
    heading=A4,
    task=Task("xyz", Turning.ABOUT_Z),
    branches=tuple(
        branch(f"knee_{k}", -cos(a) * r[2] - sin(a) * dot(r, d), margin=f"stretched_{k}", outward=+1, inward=-1)
        for k, (a, r, d) in enumerate(zip(ARMS, RODS, OUT, strict=True), 1)
    ),
    assembly=assembly("tcp", triple(RODS), margin="rods_coplanar", below=-1, above=+1),
    constraints=(Constraint(abs(BASE - PLATE) < ARM + ROD, "the arms must be able to reach the plate"),),
    notes=(
        "Arm 1 points to +X, arm 2 to 120 degrees from it, arm 3 to 240. The origin is the centre of the motor axes, "
        "and Z points up. The frame is that of the tool in the plate's centre, in the plane of the joints of the rods.",
        "The plate stays parallel to the base, so the shaft and its universal joints hand the turn of A4 on as it is.",
    ),
)
