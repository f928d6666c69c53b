"""Kin_Hexapod: six legs of variable length carry a platform that moves freely (Gough, Stewart)."""

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
    linear,
    on_plate,
    radians,
    rod,
)

BASE = ((338.0, -91.0), (338.0, 91.0), (-90.0, 338.0), (-248.0, 247.0), (-248.0, -247.0), (-90.0, -338.0))
PLATFORM = ((142.0, -141.0), (142.0, 141.0), (52.0, 193.0), (-193.0, 52.0), (-193.0, -52.0), (52.0, -193.0))

Point = tuple[Parameter, Parameter, Parameter]


def _joint(side: str, number: int, x: float, y: float) -> Point:
    of = f"of the {side} joint of leg {number}, in the frame of the {side}"
    return (
        coordinate(f"{side}_{number}_x", f"X {of}", nominal=x),
        coordinate(f"{side}_{number}_y", f"Y {of}", nominal=y),
        distance(f"{side}_{number}_z", f"Z {of}", nominal=0.0),
    )


def _leg(number: int) -> Joint:
    return linear(f"L{number}", f"Length of leg {number}, between its joints", domain=(0.0, 1e9), nominal=650.0)


def _rod(number: int, base: Point, platform: Point, leg: Joint) -> Rod:
    return rod(str(number), base, on_plate(*platform), leg, radians(BASE_CONE), radians(PLATFORM_CONE))


BASE_JOINTS = tuple(_joint("base", i, *p) for i, p in enumerate(BASE, 1))
PLATFORM_JOINTS = tuple(_joint("platform", i, *p) for i, p in enumerate(PLATFORM, 1))
BASE_CONE, PLATFORM_CONE = (
    angle(
        f"max_angle_{side}_joint",
        f"Largest lean of a leg from home, as the {side} sees it; 180: no bound",
        nominal=180.0,
        low=0.0,
        high=180.0,
        default=180.0,
    )
    for side in ("base", "platform")
)
LEGS = tuple(_leg(i) for i in range(1, 7))
HOME = (
    distance("home_x", "X of the platform at its home pose", nominal=0.0),
    distance("home_y", "Y of the platform at its home pose", nominal=0.0),
    coordinate("home_z", "Z of the platform at its home pose", nominal=600.0),
)
HOME_TURN = tuple(
    angle(f"home_{name}", f"{name.capitalize()} of the home pose: Rz(yaw) Ry(pitch) Rx(roll)", nominal=0.0, default=0.0)
    for name in ("roll", "pitch", "yaw")
)

MECHANISM = Mechanism(
    name="Kin_Hexapod",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="Control Engineering, Kinematics Equations for Control of Robotic Systems; Gough and Stewart",
    summary="Hexapod: six legs of variable length carry a platform with all six degrees of freedom.",
    parameters=(
        *(p for points in (BASE_JOINTS, PLATFORM_JOINTS) for point in points for p in point),
        *HOME,
        *HOME_TURN,
        BASE_CONE,
        PLATFORM_CONE,
    ),
    joints=LEGS,
    rods=tuple(map(_rod, range(1, 7), BASE_JOINTS, PLATFORM_JOINTS, LEGS)),
    task=Task("xyz", Turning.FULL),
    positive=LEGS,
    home=(*HOME, *(radians(turn) for turn in HOME_TURN)),
    offset_interface=False,
    notes=(
        "Six lengths allow up to 40 poses. Forward kinematics finds the one in the assembly mode of the home pose, "
        "by Newton's method from there; it refuses where that does not converge in 20 passes. On six machines of "
        "different "
        "shape it found every pose that the inverse accepts within 40 degrees of home about each axis. Beyond 60 "
        "degrees it "
        "may refuse, or find another pose of the same mode with these lengths: bound the joints.",
        "The frame of the platform is the tool frame: give platform joints in it. Base joints are given in the "
        "machine's frame.",
        "Initialize refuses a home pose that is singular: there the legs do not hold the platform.",
        "The inverse tests the lengths of the legs and the cones of their joints, max_angle_base_joint and "
        "max_angle_platform_joint. A cone is about the leg at the home pose: choose the home pose where the joints "
        "are in "
        "the middle of their range. It does not test whether legs touch each other: exclude that by the limits.",
    ),
)
