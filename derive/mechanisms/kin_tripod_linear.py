"""Kin_Tripod_Linear: three equal rails inclined to the vertical, equal rods."""

from sympy import Or, Rational, cos, pi, sin

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
    linear,
    optional_length,
    radians,
    rod,
)
from derive.vectors import cross, dot, minus, triple, vector

OUTER = length(
    "outer_radius", "Radius of the circle of the points A, where the rail axes meet the XY plane", nominal=300.0
)
INNER = optional_length("inner_radius", "Plate centre to the rod joints", nominal=60.0)
L = length("arm_length", "Length of the rods", nominal=400.0)
TILT = angle("rail_angle", "Angle of the rails to the vertical, outward going down", nominal=30.0, low=0.0, high=90.0)
SWING = angle(
    "max_angle_ball_joint",
    "Largest swing of a rod out of the plane of its rail",
    nominal=45.0,
    low=0.0,
    high=90.0,
    default=45.0,
)
AXES = tuple(linear(f"A{k}", f"Carriage {k}; positive goes down its rail", nominal=50.0) for k in (1, 2, 3))
DIRECTIONS = [vector(cos(pi * k), sin(pi * k)) for k in (Rational(1), Rational(5, 3), Rational(1, 3))]
DOWN = (sin(radians(TILT)), cos(radians(TILT)))

CARRIAGES = [
    vector((OUTER + a * DOWN[0]) * c, (OUTER + a * DOWN[0]) * s, -a * DOWN[1])
    for a, (c, s) in zip(AXES, DIRECTIONS, strict=True)
]
PLATES = [vector(X + INNER * c, Y + INNER * s, Z) for c, s in DIRECTIONS]
RODS = [minus(plate, carriage) for plate, carriage in zip(PLATES, CARRIAGES, strict=True)]

MECHANISM = Mechanism(
    name="Kin_Tripod_Linear",
    vendor=Vendor.CODESYS,
    family="parallel",
    source="CODESYS SM3_Transformation, Kin_Tripod_Linear; azimuths and the sense of the tilt are Softkin's definition",
    summary="Tripod with three inclined rails; the plate keeps its orientation.",
    parameters=(OUTER, INNER, L, TILT, SWING),
    joints=AXES,
    rods=tuple(rod(str(k), base, plate, L) for k, (base, plate) in enumerate(zip(CARRIAGES, PLATES, strict=True), 1)),
    task=Task("xyz"),
    branches=tuple(
        branch(f"carriage_{k}", r[2] * DOWN[1] - dot(r, d) * DOWN[0], margin=f"square_{k}", below=+1, above=-1)
        for k, (r, d) in enumerate(zip(RODS, DIRECTIONS, strict=True), 1)
    ),
    assembly=assembly("tcp", triple(RODS), margin="rods_coplanar", above=+1, below=-1),
    constraints=(Constraint(Or(TILT.symbol > 0, abs(OUTER - INNER) < L), "the rods must be able to reach the plate"),),
    bounds=tuple(
        bound(cross(d, r) / L, sin(radians(SWING)), f"ball joint of rod {k}")
        for k, (r, d) in enumerate(zip(RODS, DIRECTIONS, strict=True), 1)
    ),
)
