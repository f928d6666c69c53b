"""Softkin_Hexaglide: six carriages on parallel rails carry a platform that moves freely, on rods of fixed length."""

from derive.mechanism import (
    Joint,
    Mechanism,
    Parameter,
    Rod,
    Task,
    Turning,
    Vendor,
    angle,
    coordinate,
    distance,
    length,
    linear,
    on_plate,
    radians,
    rod,
    sign,
)

RAILS = (-320.0, -190.0, -60.0, 60.0, 190.0, 320.0)
PLATFORM = ((40.0, -145.0), (145.0, -40.0), (0.0, 150.0), (-75.0, -130.0), (75.0, 130.0), (145.0, 40.0))
SIDES = (1, -1, -1, -1, 1, -1)
AT_HOME = (461.0, -286.0, -405.0, -490.0, 527.0, -215.0)
NUMBERS = range(1, 7)

Point = tuple[Parameter, Parameter, Parameter]


def _rail(number: int, y: float) -> tuple[Parameter, Parameter]:
    of = f"of rail {number}, which is parallel to X, in the frame of the machine"
    return coordinate(f"rail_{number}_y", f"Y {of}", nominal=y), distance(f"rail_{number}_z", f"Z {of}", nominal=0.0)


def _joint(number: int, x: float, y: float) -> Point:
    of = f"of the joint of rod {number}, in the frame of the platform"
    return (
        coordinate(f"platform_{number}_x", f"X {of}", nominal=x),
        coordinate(f"platform_{number}_y", f"Y {of}", nominal=y),
        distance(f"platform_{number}_z", f"Z {of}", nominal=0.0),
    )


def _rod(number: int, rail: tuple[Parameter, Parameter], joint: Point, size: Parameter, carriage: Joint) -> Rod:
    return rod(str(number), (carriage, *rail), on_plate(*joint), size, radians(BASE_CONE), radians(PLATFORM_CONE))


TRACKS = tuple(map(_rail, NUMBERS, RAILS))
JOINTS = tuple(_joint(i, *p) for i, p in enumerate(PLATFORM, 1))
LENGTHS = tuple(length(f"rod_length_{i}", f"Length of rod {i}", nominal=620.0) for i in NUMBERS)
AHEAD = tuple(
    sign(f"carriage_side_{i}", f"Carriage {i}: 1 at larger X than its joint on the platform, -1 at smaller", nominal=s)
    for i, s in enumerate(SIDES, 1)
)
BASE_CONE, PLATFORM_CONE = (
    angle(
        f"max_angle_{side}_joint",
        f"Largest lean of a rod from home, as the {side} sees it; 180: no bound",
        nominal=180.0,
        low=0.0,
        high=180.0,
        default=180.0,
    )
    for side in ("base", "platform")
)
CARRIAGES = tuple(linear(f"A{i}", f"X of carriage {i}", nominal=x) for i, x in enumerate(AT_HOME, 1))
HOME = (
    distance("home_x", "X of the platform at its home pose", nominal=0.0),
    distance("home_y", "Y of the platform at its home pose", nominal=0.0),
    coordinate("home_z", "Z of the platform at its home pose", nominal=-420.0),
)
HOME_TURN = tuple(
    angle(f"home_{name}", f"{name.capitalize()} of the home pose: Rz(yaw) Ry(pitch) Rx(roll)", nominal=0.0, default=0.0)
    for name in ("roll", "pitch", "yaw")
)
RODS = tuple(map(_rod, NUMBERS, TRACKS, JOINTS, LENGTHS, CARRIAGES))

MECHANISM = Mechanism(
    name="Softkin_Hexaglide",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="Honegger, Codourey, Burdet, Adaptive Control of the Hexaglide, a 6 DOF Parallel Manipulator",
    summary="Hexaglide: six carriages on parallel rails carry a platform with all six degrees of freedom on rods.",
    parameters=(
        *(p for rail in TRACKS for p in rail),
        *(p for joint in JOINTS for p in joint),
        *LENGTHS,
        *AHEAD,
        *HOME,
        *HOME_TURN,
        BASE_CONE,
        PLATFORM_CONE,
    ),
    joints=CARRIAGES,
    rods=RODS,
    task=Task("xyz", Turning.FULL),
    positive=tuple(side * (a - leg.plate[0]) for side, a, leg in zip(AHEAD, CARRIAGES, RODS, strict=True)),
    home=(*HOME, *(radians(turn) for turn in HOME_TURN)),
    offset_interface=False,
    notes=(
        "Six carriages allow up to 40 poses. Forward kinematics finds the one in the assembly mode of the home pose, "
        "by Newton's method from there; it refuses where that does not converge in 20 passes. On four machines of "
        "different shape it found every pose within 20 degrees of home about each axis, and 20 % of a leg, that the "
        "inverse accepts.",
        "A rod never passes the plane across its rail: carriage_side_1 to carriage_side_6 tell on which side of the "
        "joint on the platform its carriage is, and forward kinematics refuses the other.",
        "The frame of the platform is the tool frame: give platform joints in it. Rails are given in the machine's "
        "frame.",
        "Initialize refuses a home pose that the legs do not reach, and one that is singular: there the rods do not "
        "hold the platform.",
        "The inverse tests the cones of the joints, max_angle_base_joint and max_angle_platform_joint. A cone is about "
        "the rod at the home pose. It does not test whether rods touch each other: exclude that by the limits.",
    ),
)
