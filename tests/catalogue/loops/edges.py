"""Machines at the end of what can be assembled: their dimensions, and axis values where something ends."""

from collections.abc import Mapping
from math import cos, radians, sin, sqrt

JUST = 1.0 - 1e-13
"""Rods shorter by this still meet, flat: the boundary belongs to the workspace."""
Edge = tuple[Mapping[str, float], tuple[float, ...]]


def azimuths(*values: float) -> dict[str, float]:
    """The directions of the legs, in degrees, as parameters."""
    return {f"azimuth_{i}": v for i, v in enumerate(values, 1)}


def arms(**sizes: float) -> dict[str, float]:
    """The same dimensions for three arms."""
    return {f"{name}_{i}": size for name, size in sizes.items() for i in (1, 2, 3)}


def rails(arm: float, *points: tuple[float, float]) -> dict[str, float]:
    """Rods of one length, and vertical rails at these points."""
    named = {f"rail_{c}_{i}": v for i, point in enumerate(points, 1) for c, v in zip("xy", point, strict=True)}
    return {"arm_length": arm} | named


def around(radius: float, *directions: float) -> list[tuple[float, float]]:
    """Points of a circle, at 90, 210 and 330 degrees where no others are given."""
    turns = [radians(a) for a in directions or (90.0, 210.0, 330.0)]
    return [(radius * cos(turn), radius * sin(turn)) for turn in turns]


def five_bar(inner: float, outer: float, displacement: float, plate: float) -> dict[str, float]:
    """A five-bar: its arms, half the distance of its drives and half that of the joints on its plate."""
    return {"inner_arm": inner, "outer_arm": outer, "displacement": displacement, "tcp_displacement": plate}


def linked(inner: float, outer: float, displacement: float, plate: float) -> dict[str, float]:
    """The same five-bar with the distance of the joints on its plate as one parameter."""
    return {"inner_arm": inner, "outer_arm": outer, "displacement": displacement, "tcp_link_distance": 2 * plate}


def links(*lengths: float) -> dict[str, float]:
    """The five lengths of a type 12."""
    return {f"link_length_{i}": v for i, v in enumerate(lengths, 1)}


def rotary(rod: float, drives: float, plate: float) -> dict[str, float]:
    """A tripod with rotary drives: its rods, the radius of its drives and that of its plate."""
    sizes = {"arm_length_1": 200.0, "arm_length_2": rod, "arm_1_radius": drives, "stewart_radius": plate}
    return sizes | {"max_angle_ball_joint": 45.0}


def inclined(rod: float, inner: float) -> dict[str, float]:
    """A tripod with rails inclined by 30 degrees: its rods, and the radius of its plate."""
    sizes = {"outer_radius": 300.0, "inner_radius": inner, "arm_length": rod}
    return sizes | {"rail_angle": 30.0, "max_angle_ball_joint": 45.0}


def delta(base: float, rod: float, plate: float) -> dict[str, float]:
    return {"base_radius": base, "arm_length": 200.0, "rod_length": rod, "plate_radius": plate}


def two_arms(rod: float, apart: float) -> dict[str, float]:
    sizes = {f"arm_length_{i}": 250.0 for i in (1, 2)} | {f"rod_length_{i}": rod for i in (1, 2)}
    return sizes | {"base_distance": apart}


def anchored(what: str, sense: float = 1.0) -> tuple[Edge, ...]:
    """Struts whose anchors are corners of a right triangle, 500 from its centre: flat, too short, apart, too long."""
    corners = enumerate(((0.0, 0.0, 0.0), (600.0, 0.0, 0.0), (0.0, sense * 800.0, 0.0)), 1)
    places = {f"{what}_{k}_{c}": v for k, corner in corners for c, v in zip("xyz", corner, strict=True)}
    return tuple((places, axes) for axes in ((500.0 * JUST,) * 3, (400.0,) * 3, (100.0, 100.0, 2000.0), (1e9,) * 3))


T_LAYOUT = azimuths(0.0, 90.0, 180.0)
CORNERS = ((150.0, 0.0), (0.0, 150.0), (-150.0, 0.0))
FIVE_BARS: tuple[Edge, ...] = (
    (five_bar(250.0, 330.0 * JUST, 120.0, 40.0), (0.0, 0.0)),
    (five_bar(250.0, 300.0, 120.0, 40.0), (0.0, 0.0)),
    (five_bar(250.0, 300.0, 40.0, 40.0), (90.0, 90.0)),
)
EDGES: dict[str, tuple[Edge, ...]] = {
    "Kin_P2C_Type1": FIVE_BARS,
    "Kin_Bipod_Rotary": FIVE_BARS,
    "Softkin_Bipod_C": tuple((sizes, (*axes, 30.0)) for sizes, axes in FIVE_BARS),
    "Kin_P2C_Type2": (
        (linked(250.0, 330.0 * JUST, 120.0, 40.0), (180.0, 0.0)),
        (linked(250.0, 300.0, 120.0, 40.0), (180.0, 0.0)),
        (linked(250.0, 300.0, 40.0, 40.0), (90.0, 90.0)),
    ),
    "Kin_P2X_Type1": (
        ({"arm_length_1": 400.0 * JUST, "arm_length_2": 400.0 * JUST}, (-400.0, 400.0)),
        ({"arm_length_1": 400.0, "arm_length_2": 400.0}, (-500.0, 500.0)),
        ({"arm_length_1": 400.0, "arm_length_2": 400.0}, (70.0, 70.0)),
    ),
    "Kin_P2X_Type2": (
        ({"arm_length": 400.0 * JUST}, (-400.0, 400.0)),
        ({"arm_length": 400.0}, (-500.0, 500.0)),
        ({"arm_length": 400.0}, (300.0, -300.0)),
    ),
    "MC_KIN_TYPE_12_XY": (
        (links(300.0, 350.0, 200.0 * JUST, 300.0, 400.0), (0.0, 0.0)),
        (links(300.0, 350.0, 200.0, 299.0, 400.0), (0.0, 0.0)),
        (links(300.0, 350.0, 200.0, 299.0, 300.0), (0.0, -90.0)),
    ),
    "Kin_Delta_P3C_Type3": (
        (arms(base_radius=140.0, inner_arm=200.0, outer_arm=300.0 * JUST, tcp_radius=40.0) | T_LAYOUT, (0.0, 0.0, 0.0)),
        (arms(base_radius=140.0, inner_arm=200.0, outer_arm=250.0, tcp_radius=40.0) | T_LAYOUT, (0.0, 0.0, 0.0)),
        (arms(base_radius=140.0, inner_arm=200.0, outer_arm=450.0, tcp_radius=140.0) | T_LAYOUT, (90.0, 90.0, 90.0)),
    ),
    "Softkin_Delta_C": (
        (delta(140.0, 300.0 * JUST, 40.0), (0.0, 0.0, 0.0, 30.0)),
        (delta(140.0, 250.0, 40.0), (0.0, 0.0, 0.0, 30.0)),
        (delta(140.0, 450.0, 140.0), (90.0, 90.0, 90.0, 30.0)),
    ),
    "Softkin_DualScara": (
        (two_arms(330.0 * JUST, 160.0), (180.0, 0.0, 20.0, 30.0)),
        (two_arms(300.0, 160.0), (180.0, 0.0, 20.0, 30.0)),
        (two_arms(300.0, 0.0), (90.0, 90.0, 20.0, 30.0)),
    ),
    "Kin_Tripod_Rotary": (
        (rotary(260.0 * JUST, 140.0, 200.0), (180.0, 180.0, 180.0)),
        (rotary(200.0, 140.0, 200.0), (180.0, 180.0, 180.0)),
        (rotary(450.0, 200.0, 200.0), (90.0, 90.0, 90.0)),
    ),
    "Kin_Tripod_Linear": (
        (inclined(240.0 * JUST, 60.0), (0.0, 0.0, 0.0)),
        (inclined(200.0, 60.0), (0.0, 0.0, 0.0)),
        (inclined(200.0, 300.0), (0.0, 0.0, 0.0)),
    ),
    "Softkin_ThreeCables": anchored("cable"),
    "Softkin_Tripod_Struts": anchored("strut"),
    "Kin_Tripod_P3Z": (
        (rails(150.0, *CORNERS), (20.0, 20.0, 20.0)),
        (rails(160.0, *CORNERS), (20.0, 20.0, 500.0)),
        (
            rails(150.0, (100.0, 0.0), (-100.0, 0.0), (0.0, 10.0)) | {"tcp_displacement": 10.0 - 1e-12},
            (20.0, 20.0, 20.0),
        ),
    ),
}
"""Rods that meet flat (nothing holds the plate), rods that do not meet, centres that coincide or lie on a line."""
OTHER_WAY_ROUND: dict[str, Edge] = {
    "Kin_Delta_P3C_Type3": (
        arms(base_radius=140.0, inner_arm=200.0, outer_arm=450.0, tcp_radius=45.0) | azimuths(180.0, 90.0, 0.0),
        (10.0, 20.0, 30.0),
    ),
    "Kin_Tripod_P3Z": (rails(200.0, *CORNERS[::-1]), (10.0, 20.0, 30.0)),
    "Softkin_ThreeCables": (anchored("cable", -1.0)[0][0], (600.0, 700.0, 650.0)),
    "Softkin_Tripod_Struts": (anchored("strut", -1.0)[0][0], (600.0, 700.0, 650.0)),
    "MC_KIN_TYPE_12_XY": (links(300.0, 350.0, 110.0, 280.0, 90.0) | {"swap_xy": 1.0}, (10.0, 20.0)),
}
"""Machines whose legs are numbered the other way round, and axis values."""
_PLANE = sqrt(300.0**2 - (140.0 + 200.0 - 50.0) ** 2)
"""The height of the drives of the rotary tripod below: its origin is the plate."""
FIVE_BAR_PLACES = ((-80.0, 0.0, 0.0), (80.0, 0.0, 0.0))
PLACES: dict[str, tuple[tuple[Mapping[str, float], tuple[tuple[float, ...], ...]], ...]] = {
    "Kin_P2C_Type1": ((five_bar(250.0, 350.0, 120.0, 40.0), FIVE_BAR_PLACES),),
    "Kin_Bipod_Rotary": ((five_bar(250.0, 350.0, 120.0, 40.0), FIVE_BAR_PLACES),),
    "Softkin_Bipod_C": ((five_bar(250.0, 350.0, 120.0, 40.0), FIVE_BAR_PLACES),),
    "Kin_P2C_Type2": ((linked(250.0, 350.0, 120.0, 40.0), FIVE_BAR_PLACES),),
    "Kin_P2X_Type1": (({"arm_length_1": 400.0, "arm_length_2": 380.0}, ((0.0, -390.0, 0.0), (0.0, -410.0, 0.0))),),
    "MC_KIN_TYPE_12_XY": (
        (links(300.0, 350.0, 110.0, 280.0, 90.0), ((0.0, 0.0, 0.0), (60.0, 0.0, 0.0))),
        (links(300.0, 350.0, 300.0, 280.0, 90.0), ((0.0, -650.0, 0.0), (650.0, 0.0, 0.0))),
    ),
    "Kin_Delta_P3C_Type3": (
        (
            arms(base_radius=140.0, inner_arm=200.0, outer_arm=250.0, tcp_radius=45.0) | T_LAYOUT,
            ((95.0, 0.0, 0.0), (0.0, 95.0, 0.0), (-95.0, 0.0, 0.0)),
        ),
    ),
    "Softkin_Delta_C": (
        (
            delta(140.0, 250.0, 45.0),
            tuple((95.0 * cos(radians(a)), 95.0 * sin(radians(a)), 0.0) for a in (0.0, 120.0, 240.0)),
        ),
    ),
    "Softkin_DualScara": ((two_arms(350.0, 160.0), FIVE_BAR_PLACES),),
    "Kin_Tripod_Rotary": (
        (
            rotary(300.0, 140.0, 50.0),
            tuple((90.0 * cos(radians(a)), 90.0 * sin(radians(a)), _PLANE) for a in (180.0, 300.0, 60.0)),
        ),
    ),
}
"""Places that one leg cannot aim at: its joint on the plate is on the axis of its drive, or too far away."""
