"""Loops whose plate carries a joint that turns the tool: machines that are not in the catalogue."""

from collections.abc import Mapping

from sympy import cos, sin

from derive.description.mechanism import (
    TURN,
    Mechanism,
    Task,
    Turning,
    Vendor,
    X,
    Y,
    Z,
    assembly,
    branch,
    helical,
    length,
    linear,
    on_plate,
    optional_length,
    pitch,
    rod,
    rotary,
)
from derive.vectors import Vector, cross, minus, triple, vector

C, LIFT = rotary("C", "Tool"), linear("Q", "Quill, up")
CLIMB = pitch("climb", "Travel of the quill per turn", nominal=12.0)
CLIMBING = helical("C", "Tool", limit_range=(-720.0, 720.0), pitch=CLIMB)
A1, A2 = rotary("A1", "Arm 1", nominal=130.0), rotary("A2", "Arm 2", nominal=50.0)
SLIDES = tuple(linear(f"S{i}", f"Carriage {i}, up", nominal=0.1) for i in (1, 2, 3))
RAILS = ((0.3, 0.02), (-0.17, 0.24), (-0.14, -0.27))
"""In metres, and no two alike."""
PLATE = ((0.05, 0.0), (-0.02, 0.04), (-0.03, -0.05))
APART = length("apart", "Distance of the motors", nominal=160.0)
ARMS = [length(f"arm_{i}", "Arm", nominal=s) for i, s in ((1, 190.0), (2, 215.0))]
RODS = [length(f"rod_{i}", "Rod", nominal=s) for i, s in ((1, 270.0), (2, 245.0))]
BESIDE = optional_length("beside", "Quill to the tool", nominal=35.0)
FLAT = Task("xy", Turning.ABOUT_Z)


def linear_delta() -> Mechanism:
    """Three upright rails, in metres; a positive C turns the tool clockwise."""
    sizes = [length(f"rod_{i}", "Rod", nominal=0.5 + 0.02 * i) for i in (1, 2, 3)]
    bases = [vector(x, y, s) for (x, y), s in zip(RAILS, SLIDES, strict=True)]
    plates = [vector(X + x, Y + y, Z) for x, y in PLATE]
    along = [minus(p, b) for p, b in zip(plates, bases, strict=True)]
    return Mechanism(
        name="Kin_LinearDeltaC",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        source="none",
        summary="A machine.",
        parameters=tuple(sizes),
        joints=(*SLIDES, C),
        rods=tuple(rod(str(i), b, p, s) for i, (b, p, s) in enumerate(zip(bases, plates, sizes, strict=True), 1)),
        heading=-C.symbol,
        task=Task("xyz", Turning.ABOUT_Z),
        branches=tuple(
            branch(f"carriage_{i}", -r[2], margin=f"level_{i}", above=+1, below=-1) for i, r in enumerate(along, 1)
        ),
        assembly=assembly("tcp", triple(along), margin="coplanar", below=-1, above=+1),
    )


def five_bar(name: str, tip: Vector, **more: object) -> Mechanism:
    """Two unequal arms with rods that meet in a point."""
    arms = [vector(size * cos(a), size * sin(a)) for size, a in zip(ARMS, (A1, A2), strict=True)]
    elbows = [vector(arms[0][0] - APART / 2, arms[0][1]), vector(arms[1][0] + APART / 2, arms[1][1])]
    along = [minus(tip, elbow) for elbow in elbows]
    own: dict[str, object] = {
        "parameters": (APART, *ARMS, *RODS),
        "joints": (A1, A2, C),
        "heading": C.symbol,
        "task": FLAT,
        "offset_interface": True,
    }
    return Mechanism(
        name=f"Kin_{name}",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        source="none",
        summary="A machine.",
        rods=tuple(rod(str(i), b, tip, s) for i, (b, s) in enumerate(zip(elbows, RODS, strict=True), 1)),
        branches=(
            branch("elbow_1", -cross(arms[0], along[0]), outward=+1, inward=-1),
            branch("elbow_2", cross(arms[1], along[1]), outward=+1, inward=-1),
        ),
        assembly=assembly("tip", cross(*along), margin="aligned", front=+1, back=-1),
        **(own | more),  # type: ignore[arg-type]
    )


TIP = vector(X, Y)
CARRIED: Mapping[str, Mechanism] = {
    "linear delta with a reversed C": linear_delta(),
    "five-bar with C": five_bar("FiveBarC", TIP),
    "five-bar whose tool is beside its quill": five_bar(
        "FiveBarBeside", vector(*on_plate(-BESIDE, 0)), parameters=(APART, *ARMS, *RODS, BESIDE)
    ),
    "five-bar whose belt runs over arm 2": five_bar(
        "FiveBarBelt", TIP, heading=C.symbol + A2.symbol, offset_interface=False
    ),
    "five-bar with a quill that climbs": five_bar(
        "FiveBarClimbs",
        TIP,
        parameters=(APART, *ARMS, *RODS, CLIMB),
        joints=(A1, A2, LIFT, CLIMBING),
        closure=(Z - LIFT + CLIMB * CLIMBING / TURN,),
        heading=CLIMBING.symbol,
        task=Task("xyz", Turning.ABOUT_Z),
    ),
}
