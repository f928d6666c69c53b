"""Softkin_Pentapod: five struts of variable length end on rings about a spindle, and do not feel its turn."""

from derive.mechanism import (
    Joint,
    Mechanism,
    Parameter,
    Rod,
    Task,
    Turning,
    Vendor,
    coordinate,
    distance,
    linear,
    on_plate,
    ring_rod,
)

BASE = ((-418.0, 325.0), (418.0, 325.0), (418.0, -325.0), (0.0, -493.0), (-418.0, -325.0))
ALONG = (185.0, 160.0, 41.0, 14.0, 68.0)
NUMBERS = range(1, 6)

Point = tuple[Parameter, Parameter, Parameter]


def _base(number: int, x: float, y: float) -> Point:
    of = f"of the joint of strut {number} on the base"
    return (
        coordinate(f"base_{number}_x", f"X {of}", nominal=x),
        coordinate(f"base_{number}_y", f"Y {of}", nominal=y),
        distance(f"base_{number}_z", f"Z {of}", nominal=900.0),
    )


def _strut(number: int, base: Point, along: Parameter, radius: Parameter, length: Joint) -> Rod:
    return ring_rod(str(number), base, on_plate(0, 0, along), radius, length)


JOINTS = tuple(_base(i, *p) for i, p in enumerate(BASE, 1))
HEIGHTS = tuple(
    coordinate(f"ring_{i}_z", f"Tip to ring {i}, along the spindle", nominal=z) for i, z in enumerate(ALONG, 1)
)
RADII = tuple(distance(f"ring_{i}_radius", f"Spindle to the end of strut {i}", nominal=80.0) for i in NUMBERS)
STRUTS = tuple(linear(f"A{i}", f"Length of strut {i}, from its joint to its ring", domain=(0.0, 1e9)) for i in NUMBERS)
HOME = (
    distance("home_x", "X of the tip at its home pose", nominal=0.0),
    distance("home_y", "Y of the tip at its home pose", nominal=0.0),
    coordinate("home_z", "Z of the tip at its home pose", nominal=400.0),
)

MECHANISM = Mechanism(
    name="Softkin_Pentapod",
    vendor=Vendor.TEXTBOOK,
    family="parallel",
    source="pentapods: five-axis machines whose spindle five struts carry",
    summary="Pentapod: five struts that change their length carry a spindle, with five axes.",
    parameters=(*(p for joint in JOINTS for p in joint), *HEIGHTS, *RADII, *HOME),
    joints=STRUTS,
    rods=tuple(map(_strut, NUMBERS, JOINTS, HEIGHTS, RADII, STRUTS)),
    task=Task("xyz", Turning.DIRECTION),
    positive=STRUTS,
    home=(*HOME, 0, 0, 0),
    offset_interface=False,
    notes=(
        "Each ring turns freely about the spindle, so that its strut stays in a plane with it. At home the spindle is "
        "along Z.",
        "Nothing holds the turn of the frame about the spindle: forward kinematics gives it that of the least turn "
        "from home.",
    ),
)
