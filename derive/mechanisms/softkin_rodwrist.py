"""Softkin_RodWrist: two cranks with rods tilt a plate that hangs on a universal joint."""

from sympy import Expr, Matrix, cos, sin

from derive.mechanism import (
    ROTATION,
    Branch,
    Joint,
    Mechanism,
    Parameter,
    Rod,
    Task,
    Turning,
    Vendor,
    angle,
    branch,
    coordinate,
    guide,
    length,
    radians,
    rod,
    rotary,
)

MOTORS = ((-10.0, 45.0, -200.0), (-10.0, -45.0, -130.0))
PLATE = ((-60.0, 45.0, 0.0), (-60.0, -45.0, 0.0))

Point = tuple[Parameter, Parameter, Parameter]


def _point(side: str, number: int, what: str, *xyz: float) -> Point:
    x, y, z = (
        coordinate(
            f"{side}_{number}_{c}",
            f"{c.upper()} of {what} {number}, in the frame of the {side}, from the universal joint",
            nominal=v,
        )
        for c, v in zip("xyz", xyz, strict=True)
    )
    return x, y, z


def _crank(motor: Point, size: Parameter, joint: Joint) -> tuple[Expr, ...]:
    """The end of a crank about Y."""
    x, y, z = motor
    return x - size * cos(joint), y.symbol, z + size * sin(joint)


def _side(number: int, motor: Point, crank: Rod) -> Branch:
    x, _, z = (b - m for b, m in zip(crank.base, motor, strict=True))
    along, _, up = (p - b for p, b in zip(crank.plate, crank.base, strict=True))
    return branch(f"crank_{number}", z * along - x * up, margin=f"stretched_{number}", back=+1, front=-1)


MOTOR = tuple(_point("base", i, "motor", *p) for i, p in enumerate(MOTORS, 1))
JOINT = tuple(_point("platform", i, "the joint of rod", *p) for i, p in enumerate(PLATE, 1))
CRANKS = tuple(length(f"crank_length_{i}", f"Length of crank {i}", nominal=50.0) for i in (1, 2))
RODS = tuple(length(f"rod_length_{i}", f"Length of rod {i}", nominal=n) for i, n in ((1, 200.0), (2, 130.0)))
AXES = tuple(rotary(f"A{i}", f"Crank {i} about Y: zero along -X, positive upward") for i in (1, 2))
PITCH, ROLL = (
    angle(f"home_{word}", f"{word.capitalize()} of the plate at its home pose", nominal=0.0, default=0.0)
    for word in ("pitch", "roll")
)

ON_ROLL_AXIS = tuple(ROTATION * Matrix((CRANKS[0], 0, 0)))
"""A point of the plate on the roll axis, which pitch alone moves; its distance, a length of the machine, is free."""
LEGS = tuple(
    rod(str(i), _crank(motor, crank, axis), tuple(ROTATION * Matrix(joint)), size)
    for i, (motor, crank, axis, joint, size) in enumerate(zip(MOTOR, CRANKS, AXES, JOINT, RODS, strict=True), 1)
)

MECHANISM = Mechanism(
    name="Softkin_RodWrist",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="ankles of legged robots, wrists with two motors in the forearm",
    summary="Wrist with two pushrods: two cranks with rods tilt a plate on a universal joint.",
    parameters=(*(p for points in (MOTOR, JOINT) for point in points for p in point), *CRANKS, *RODS, PITCH, ROLL),
    joints=AXES,
    rods=LEGS,
    guides=(guide("universal", (0, 1, 0), ON_ROLL_AXIS),),
    task=Task("", Turning.DIRECTION),
    branches=tuple(_side(i, motor, leg) for i, (motor, leg) in enumerate(zip(MOTOR, LEGS, strict=True), 1)),
    home=(radians(ROLL), radians(PITCH), 0),
)
