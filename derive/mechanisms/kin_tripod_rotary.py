"""Kin_Tripod_Rotary: a symmetric rotary delta whose origin is the plate with horizontal arms."""

from sympy import Rational, cos, pi, sin, sqrt

from derive.mechanism import (
    Constraint,
    Mechanism,
    Task,
    Vendor,
    X,
    Y,
    Z,
    angle,
    assembly,
    bound,
    branch,
    length,
    optional_length,
    radians,
    rod,
    rotary,
)
from derive.vectors import Vector, cross, dot, minus, triple, vector

L1 = length("arm_length_1", "Length of the upper arms", nominal=200.0)
L2 = length("arm_length_2", "Length of the rods", nominal=450.0)
DRIVES = length("arm_1_radius", "Radius of the circle of the drive axes", nominal=140.0)
STEWART = optional_length("stewart_radius", "Radius of the circle of the six rod joints on the plate", nominal=50.0)
APART = optional_length("distance", "Distance of the two rods of a pair", nominal=40.0)
SWING = angle(
    "max_angle_ball_joint",
    "Largest swing of a rod out of the plane of its arm",
    nominal=45.0,
    low=0.0,
    high=90.0,
    default=45.0,
)
AXES = tuple(rotary(f"A{k}", f"Arm {k}, from horizontal outward; positive is down") for k in (1, 2, 3))
DIRECTIONS = [vector(cos(pi * k), sin(pi * k)) for k in (Rational(1), Rational(5, 3), Rational(1, 3))]

PLATE = sqrt(STEWART**2 - APART**2 / 4)
HEIGHT = sqrt(L2**2 - (DRIVES + L1 - PLATE) ** 2)
KNEES = [
    vector((DRIVES + L1 * cos(a)) * c, (DRIVES + L1 * cos(a)) * s, HEIGHT - L1 * sin(a))
    for a, (c, s) in zip(AXES, DIRECTIONS, strict=True)
]
JOINTS = [vector(X + PLATE * c, Y + PLATE * s, Z) for c, s in DIRECTIONS]
RODS = [minus(joint, knee) for joint, knee in zip(JOINTS, KNEES, strict=True)]


def beside(point: Vector, direction: Vector, side: int) -> Vector:
    """Where one rod of a pair ends."""
    return vector(point[0] - side * APART / 2 * direction[1], point[1] + side * APART / 2 * direction[0], point[2])


MECHANISM = Mechanism(
    name="Kin_Tripod_Rotary",
    vendor=Vendor.CODESYS,
    family="parallel",
    source="CODESYS SM3_Transformation, Kin_Tripod_Rotary; order and sense of the drives are Softkin's definition",
    summary="Symmetric rotary delta; the origin is the plate centre with all upper arms horizontal.",
    parameters=(L1, L2, DRIVES, STEWART, APART, SWING),
    joints=AXES,
    rods=tuple(rod(str(k), knee, joint, L2) for k, (knee, joint) in enumerate(zip(KNEES, JOINTS, strict=True), 1)),
    bars=tuple(
        rod(f"{k}{side}", beside(knee, d, s), beside(joint, d, s), L2)
        for k, (knee, joint, d) in enumerate(zip(KNEES, JOINTS, DIRECTIONS, strict=True), 1)
        for side, s in (("a", 1), ("b", -1))
    ),
    task=Task("xyz"),
    branches=tuple(
        branch(f"knee_{k}", -cos(a) * r[2] - sin(a) * dot(r, d), margin=f"stretched_{k}", outward=+1, inward=-1)
        for k, (a, r, d) in enumerate(zip(AXES, RODS, DIRECTIONS, strict=True), 1)
    ),
    assembly=assembly("tcp", triple(RODS), margin="rods_coplanar", below=-1, above=+1),
    bounds=tuple(
        bound(cross(d, r) / L2, sin(radians(SWING)), f"ball joint of rod {k}")
        for k, (r, d) in enumerate(zip(RODS, DIRECTIONS, strict=True), 1)
    ),
    constraints=(
        Constraint(2 * STEWART >= APART, "stewart_radius must be at least half of distance"),
        Constraint(abs(DRIVES + L1 - PLATE) < L2, "the rods must reach the plate with horizontal arms"),
    ),
)
