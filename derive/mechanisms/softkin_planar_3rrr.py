"""Softkin_Planar_3RRR: three arms with rods turn and shift a platform in the plane."""

from sympy import cos, sin

from derive.mechanism import (
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
    distance,
    length,
    on_plate,
    radians,
    rod,
    rotary,
)
from derive.vectors import Vector, cross, minus, vector

BASE = ((-260.0, -150.0), (260.0, -150.0), (0.0, 300.0))
PLATFORM = ((-70.0, -40.0), (70.0, -40.0), (0.0, 80.0))

Point = tuple[Parameter, Parameter]


def _point(side: str, number: int, what: str, x: float, y: float) -> Point:
    of = f"of {what} {number}, in the frame of the {side}"
    return (
        coordinate(f"{side}_{number}_x", f"X {of}", nominal=x),
        coordinate(f"{side}_{number}_y", f"Y {of}", nominal=y),
    )


def _arm(motor: Point, size: Parameter, joint: Joint) -> tuple[Vector, Vector]:
    """The arm, and its end."""
    arm = vector(size * cos(joint), size * sin(joint))
    return arm, vector(motor[0] + arm[0], motor[1] + arm[1])


def _elbow(number: int, arm: Vector, rod: Rod) -> Branch:
    along = minus(vector(*rod.plate), vector(*rod.base))
    return branch(f"elbow_{number}", cross(arm, along), margin=f"stretched_{number}", right=+1, left=-1)


MOTORS = tuple(_point("base", i, "motor", *p) for i, p in enumerate(BASE, 1))
JOINTS = tuple(_point("platform", i, "joint", *p) for i, p in enumerate(PLATFORM, 1))
ARMS = tuple(length(f"arm_length_{i}", f"Length of arm {i}", nominal=160.0) for i in (1, 2, 3))
RODS = tuple(length(f"rod_length_{i}", f"Length of rod {i}", nominal=180.0) for i in (1, 2, 3))
AXES = tuple(rotary(f"A{i}", f"Arm {i} about Z, from +X") for i in (1, 2, 3))
HOME = (
    distance("home_x", "X of the platform at its home pose", nominal=0.0),
    distance("home_y", "Y of the platform at its home pose", nominal=0.0),
)
HOME_TURN = angle("home_heading", "Heading of the platform at its home pose", nominal=0.0, default=0.0)

SPUN = tuple(map(_arm, MOTORS, ARMS, AXES))
LEGS = tuple(
    rod(str(i), end, on_plate(*joint), size)
    for i, ((_, end), joint, size) in enumerate(zip(SPUN, JOINTS, RODS, strict=True), 1)
)

MECHANISM = Mechanism(
    name="Softkin_Planar_3RRR",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="Gosselin and Angeles, The Optimum Kinematic Design of a Planar Three-DOF Parallel Manipulator",
    summary="Planar 3-RRR: three arms with rods shift and turn a platform in the plane.",
    parameters=(*(p for points in (MOTORS, JOINTS) for point in points for p in point), *ARMS, *RODS, *HOME, HOME_TURN),
    joints=AXES,
    rods=LEGS,
    task=Task("xy", Turning.ABOUT_Z),
    branches=tuple(_elbow(i, arm, leg) for i, ((arm, _), leg) in enumerate(zip(SPUN, LEGS, strict=True), 1)),
    home=(*HOME, radians(HOME_TURN)),
    offset_interface=False,
    notes=(
        "Three axis values allow up to six poses. Forward kinematics finds the one in the assembly mode of the home "
        "pose, by Newton's method from there; it refuses where that does not converge in 20 passes. On four machines "
        "of different shape it found every pose within 20 degrees of home, and 20 % of a leg, that the inverse accepts "
        "in the configuration of home. In a configuration with the other sign of the determinant at home it refuses.",
        "The assembly mode is the sign of the determinant of the rods at the home pose, and home_elbow_1_left to "
        "home_elbow_3_left tell how the arms stand there. Every way into the other mode "
        "leads through a type 2 singularity: of the eight configurations the inverse refuses those in the other mode.",
        "The frame of the platform is the tool frame: give its joints in it. Motors are given in the machine's frame.",
        "Initialize refuses a home pose that the legs do not reach, and one that is singular: there the rods do not "
        "hold the platform.",
    ),
)
