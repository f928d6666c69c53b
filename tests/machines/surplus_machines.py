"""Points and platforms on more rods or cables than hold them, none of them in the catalogue."""

from collections.abc import Sequence

from derive.mechanism import (
    Joint,
    Mechanism,
    Parameter,
    Task,
    Turning,
    X,
    Y,
    Z,
    cable,
    coordinate,
    linear,
    on_plate,
    rod,
)

Point = tuple[float, ...]
FOUR: tuple[Point, ...] = (
    (0.0, -1620.0, -150.0),
    (1800.0, 1290.0, -150.0),
    (-1620.0, 1250.0, -150.0),
    (0.0, 0.0, 2350.0),
)
"""Three lines from the floor and one from above, as those of a printer that hangs in a room."""
THREE_IN_PLANE: tuple[Point, ...] = ((0.0, 0.0), (1000.0, 50.0), (450.0, 900.0))
THREE: tuple[Point, ...] = ((0.0, 2000.0, 2500.0), (-1800.0, -1000.0, 2400.0), (1800.0, -1000.0, 2600.0))
BODY: tuple[tuple[Point, ...], tuple[Point, ...]] = (
    ((-1000.0, -700.0), (1000.0, -720.0), (1010.0, 700.0), (-1000.0, 710.0)),
    ((-100.0, 60.0), (100.0, 50.0), (90.0, -60.0), (-100.0, -55.0)),
)
SEVEN: tuple[tuple[Point, ...], tuple[Point, ...]] = (
    (
        *((x, y, 0.0) for x in (-2000.0, 2000.0) for y in (-1500.0, 1500.0)),
        *((-2000.0, -1500.0, 2400.0), (-2000.0, 1500.0, 2400.0), (2000.0, -1500.0, 2400.0)),
    ),
    (
        *((200.0, -150.0, 150.0), (200.0, 150.0, -150.0), (-200.0, -150.0, -150.0), (-200.0, 150.0, -150.0)),
        *((200.0, -150.0, -150.0), (-200.0, 150.0, 150.0), (-200.0, -150.0, 150.0)),
    ),
)


def at_points(
    name: str, anchors: Sequence[Point], nominal: Sequence[float], *surplus: int, load: bool = False
) -> Mechanism:
    """Rods of variable length from anchors, which are parameters, to one point; or cables with a load as parameters.

    surplus: the numbers of the surplus rods, from 1; none if they are to be chosen.
    """
    letters = "xyz"[: len(anchors[0])]
    places = [_place(f"anchor_{k}", place) for k, place in enumerate(anchors, 1)]
    axes = _axes(nominal)
    force = _place("load", (*[0.0] * (len(letters) - 1), -1.0)) if load else ()
    legs = enumerate(zip(places, axes, strict=True), 1)
    return Mechanism(
        name=name,
        parameters=(*(p for place in places for p in place), *force),
        joints=axes,
        rods=tuple(
            (cable if load else rod)(str(k), place, (X, Y, Z)[: len(letters)], axis) for k, (place, axis) in legs
        ),
        surplus=tuple(axes[k - 1] for k in surplus),
        load=force,
        task=Task(letters),
    )


def on_platform(
    name: str, ends: tuple[Sequence[Point], Sequence[Point]], home: Point, *, load: bool = False
) -> Mechanism:
    """Cables to a platform that turns, all dimensions numbers."""
    bases, plates = ends
    axes, flat = _axes([1.5 * abs(bases[0][0])] * len(bases)), len(bases[0]) == 2
    legs = enumerate(zip(bases, plates, axes, strict=True), 1)
    return Mechanism(
        name=name,
        joints=axes,
        rods=tuple(cable(str(k), base, on_plate(*plate), axis) for k, (base, plate, axis) in legs),
        home=home,
        load=(*[0] * (len(bases[0]) - 1), -1) if load else (),
        task=Task("xy", Turning.ABOUT_Z) if flat else Task("xyz", Turning.FULL),
    )


def _place(name: str, place: Point) -> tuple[Parameter, ...]:
    return tuple(coordinate(f"{name}_{c}", f"{c} of {name}", nominal=v) for c, v in zip("xyz", place, strict=False))


def _axes(nominal: Sequence[float]) -> tuple[Joint, ...]:
    return tuple(linear(f"L{k}", f"Length {k}", domain=(0.0, 1e9), nominal=v) for k, v in enumerate(nominal, 1))


POINTS = {
    "four lines": (at_points("FourLines", FOUR, (2000.0,) * 4), FOUR, (100.0, 200.0, 500.0)),
    "three in a plane": (
        at_points("ThreeInPlane", THREE_IN_PLANE, (550.0, 600.0, 500.0)),
        THREE_IN_PLANE,
        (420.0, 330.0),
    ),
}
"""Machine, anchors, and the middle of the workspace."""
PLATFORMS = {
    "a body in the plane": (on_platform("FourOnBody", BODY, (0.0, 0.0, 0.0)), BODY),
    "seven cables": (on_platform("SevenCables", SEVEN, (0.0, 0.0, 1200.0, 0.0, 0.0, 0.0)), SEVEN),
}
LOADED = {
    "three cables": (at_points("ThreeLoaded", THREE, (2600.0,) * 3, load=True), THREE, (0.0, 0.0, 700.0)),
    "four cables": (at_points("FourLoaded", FOUR, (2000.0,) * 4, load=True), FOUR, (0.0, 200.0, 700.0)),
    "three in a plane": (
        at_points("PlaneLoaded", THREE_IN_PLANE, (550.0, 600.0, 500.0), load=True),
        THREE_IN_PLANE,
        (420.0, 330.0),
    ),
}
