"""Kin_Tripod_P3Z: a linear delta, three carriages on vertical rails anywhere."""

from sympy import sqrt

from derive.mechanism import (
    Constraint,
    Mechanism,
    Task,
    Vendor,
    X,
    Y,
    Z,
    assembly,
    branch,
    distance,
    length,
    linear,
    optional_length,
    rod,
)
from derive.reach import discs_meet
from derive.vectors import cross, minus, triple, vector

L = length("arm_length", "Length of the rods", nominal=269.0)
SHIFT = optional_length("tcp_displacement", "TCP to the rod joints, along the direction of the rail", nominal=20.0)
RAILS = [
    (distance(f"rail_x_{k}", f"X of rail {k}", nominal=x), distance(f"rail_y_{k}", f"Y of rail {k}", nominal=y))
    for k, (x, y) in enumerate(((0.0, 150.0), (-130.0, -75.0), (130.0, -75.0)), 1)
]
AXES = tuple(linear(f"A{k}", f"Carriage {k} along Z, up", nominal=300.0) for k in (1, 2, 3))

DISTANCES = [sqrt(x**2 + y**2) for x, y in RAILS]
CARRIAGES = [
    vector(x * (1 - SHIFT / d), y * (1 - SHIFT / d), a) for (x, y), d, a in zip(RAILS, DISTANCES, AXES, strict=True)
]
TCP = vector(X, Y, Z)
RODS = [minus(TCP, carriage) for carriage in CARRIAGES]
FIRST, SECOND, THIRD = (vector(x, y) for x, y in RAILS)
AREA = cross(minus(SECOND, FIRST), minus(THIRD, FIRST))

MECHANISM = Mechanism(
    name="Kin_Tripod_P3Z",
    vendor=Vendor.SINSEGYE,
    family="parallel",
    source="Beckhoff 3D-Tripod Type 1 (P_3Z); joints along the rail's direction are Softkin's definition",
    summary="Linear delta: three carriages on vertical rails carry a plate that keeps its orientation.",
    parameters=(L, SHIFT, *(value for rail in RAILS for value in rail)),
    joints=AXES,
    rods=tuple(rod(str(k), carriage, TCP, L) for k, carriage in enumerate(CARRIAGES, 1)),
    bars=tuple(
        rod(str(k), (x, y, a), (X + SHIFT * x / d, Y + SHIFT * y / d, Z), L)
        for k, ((x, y), d, a) in enumerate(zip(RAILS, DISTANCES, AXES, strict=True), 1)
    ),
    task=Task("xyz"),
    branches=tuple(
        branch(f"carriage_{k}", a - Z, margin=f"level_{k}", above=+1, below=-1) for k, a in enumerate(AXES, 1)
    ),
    assembly=assembly("tcp", triple(RODS), margin="rods_coplanar", handedness=AREA, below=-1, above=+1),
    constraints=(
        *(
            Constraint(d > SHIFT, f"rail {k} must be farther from the origin than tcp_displacement")
            for k, d in enumerate(DISTANCES, 1)
        ),
        Constraint(abs(AREA) > 1e-6 * L**2, "the rails must not lie on a line"),
        *discs_meet([carriage[:2] for carriage in CARRIAGES], [L, L, L], "rods long enough to reach the plate"),
    ),
)
