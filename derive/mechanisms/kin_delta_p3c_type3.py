"""Kin_Delta_P3C_Type3: a rotary delta, every arm with dimensions of its own."""

from sympy import cos, sin

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
    branch,
    length,
    optional_length,
    radians,
    rod,
    rotary,
)
from derive.reach import discs_meet
from derive.vectors import cross, dot, minus, triple, vector

ARMS = ("1", "2", "3")
AZIMUTH = [
    angle(f"azimuth_{i}", f"Direction of arm {i}, from X", nominal=a)
    for i, a in zip(ARMS, (0.0, 90.0, -90.0), strict=True)
]
BASE = [length(f"base_radius_{i}", f"Origin to the motor axis of arm {i}", nominal=140.0) for i in ARMS]
INNER = [length(f"inner_arm_{i}", f"Inner arm {i}", nominal=200.0) for i in ARMS]
OUTER = [length(f"outer_arm_{i}", f"Outer arm {i}", nominal=450.0) for i in ARMS]
PLATE = [optional_length(f"tcp_radius_{i}", f"TCP to the rod joints of arm {i}", nominal=45.0) for i in ARMS]
AXES = tuple(rotary(f"A{i}", f"Arm {i}, from horizontal outward; positive is down") for i in ARMS)

OUT = [vector(cos(radians(a)), sin(radians(a))) for a in AZIMUTH]
KNEES = [
    vector((r + l1 * cos(q)) * u[0], (r + l1 * cos(q)) * u[1], -l1 * sin(q))
    for r, l1, q, u in zip(BASE, INNER, AXES, OUT, strict=True)
]
JOINTS = [vector(X + p * u[0], Y + p * u[1], Z) for p, u in zip(PLATE, OUT, strict=True)]
RODS = [minus(joint, knee) for joint, knee in zip(JOINTS, KNEES, strict=True)]
DRIVES = [vector((r - p) * u[0], (r - p) * u[1]) for r, p, u in zip(BASE, PLATE, OUT, strict=True)]
REACHES = [inner + outer for inner, outer in zip(INNER, OUTER, strict=True)]
TURN = cross(OUT[0], OUT[1]) + cross(OUT[1], OUT[2]) + cross(OUT[2], OUT[0])

MECHANISM = Mechanism(
    name="Kin_Delta_P3C_Type3",
    vendor=Vendor.SINSEGYE,
    family="parallel",
    source="Beckhoff 3D-Delta family (P_3C); layout is Softkin's definition",
    summary="Rotary delta whose three arms have dimensions of their own; the plate keeps its orientation.",
    parameters=(*AZIMUTH, *BASE, *INNER, *OUTER, *PLATE),
    joints=AXES,
    rods=tuple(rod(i, knee, joint, l2) for i, knee, joint, l2 in zip(ARMS, KNEES, JOINTS, OUTER, strict=True)),
    task=Task("xyz"),
    branches=tuple(
        branch(f"knee_{i}", -cos(q) * r[2] - sin(q) * dot(r, u), margin=f"stretched_{i}", outward=+1, inward=-1)
        for i, q, r, u in zip(ARMS, AXES, RODS, OUT, strict=True)
    ),
    assembly=assembly("tcp", triple(RODS), margin="rods_coplanar", handedness=TURN, below=-1, above=+1),
    constraints=(
        Constraint(abs(TURN) > 1e-6, "the arms must not all point the same way"),
        *discs_meet(DRIVES, REACHES, "arms long enough to reach the plate"),
    ),
)
