"""Loops whose platform is held in planes: tilting heads that move what the task does not command, and lifted plates."""

from collections.abc import Mapping

from sympy import Expr, Float, Matrix, cos, pi, sin

from derive.description.mechanism import (
    ROTATION,
    Joint,
    Mechanism,
    Task,
    Turning,
    Z,
    distance,
    guide,
    length,
    linear,
    on_plate,
    ring_rod,
    rod,
    rotary,
)

CYLINDERS = tuple(linear(f"C{k}", f"Cylinder {k}", domain=(0.0, 1e9)) for k in (1, 2, 3))
SLIDES = tuple(linear(f"S{k}", f"Slide {k}, up") for k in (1, 2, 3))
ARMS = tuple(rotary(f"A{k}", f"Arm {k}") for k in (1, 2, 3))
LIFT, ALONG = linear("Z1", "Lift"), linear("S1", "Slide of the base")
BASE, PLATE = length("base_radius", "Base", nominal=200.0), length("plate_radius", "Plate", nominal=120.0)
RAISED = distance("raised", "Height of the base joints", nominal=50.0)
ROD, ARM = length("rod_length", "Rod", nominal=400.0), length("arm_length", "Arm", nominal=160.0)
M_BASE, M_ROD = length("base_radius", "Base", nominal=0.35), length("rod_length", "Rod", nominal=0.6)
HEIGHT = distance("height", "Plate above its slide", nominal=30.0)
TILTS, TURNED = Task("z", Turning.DIRECTION), Task("xyz", Turning.ABOUT_Z)


def _polar(radius: object, number: int, z: object = 0) -> tuple[Expr, Expr, object]:
    angle = 2 * pi * number / 3
    return radius * cos(angle), radius * sin(angle), z  # type: ignore[operator]


def _across(number: int) -> tuple[Expr, Expr, int]:
    """The direction across the radius of a leg."""
    return -sin(2 * pi * number / 3), cos(2 * pi * number / 3), 0


def _corner(x: float, y: float) -> tuple[Expr, ...]:
    return on_plate(x, y, 0)


_T = ((0.0, 0.1), (0.0, -0.1), (0.12, 0.0))
_FEET: tuple[tuple[object, object], ...] = ((-0.05, M_BASE), (-0.05, -M_BASE), (M_BASE, 0))
_MOTORS = ((-260.0, -150.0), (260.0, -150.0), (0.0, 300.0))
_CORNERS = ((-70.0, -40.0), (70.0, -40.0), (0.0, 80.0))


def _arm(number: int, arm: Joint, shift: object = 0) -> tuple[object, object]:
    x, y = _MOTORS[number]
    return x + shift + ARM * cos(arm), y + ARM * sin(arm)  # type: ignore[operator]


STRUTS = tuple(linear(f"L{k}", f"Strut {k}", domain=(0.0, 1e9)) for k in range(1, 6))
_FIVE = tuple(zip(STRUTS, ((-418.0, 325.0, -185.0), (418.0, 325.0, -160.0), (-418.0, -325.0, -68.0),
                           (418.0, -325.0, -41.0), (0.0, -493.0, -14.0)), strict=True))  # fmt: skip
"""Of each strut x and y of its joint on the base, and where it ends along the spindle."""
TABLE, _TEE = (linear("TX", "Table along X"), linear("TY", "Table along Y")), ((0, 1), (0, -1), (1, 0))
RING = length("ring_radius", "Radius of the rings", nominal=80.0)
FRAME = length("frame_height", "Height of the joints on the base", nominal=900.0)

GUIDED: Mapping[str, Mechanism] = {
    "3-RPS on a raised base": Mechanism(
        name="Kin_RaisedRps",
        joints=CYLINDERS,
        parameters=(BASE, PLATE, RAISED),
        task=TILTS,
        rods=tuple(
            rod(str(k + 1), _polar(BASE, k, RAISED), on_plate(*_polar(PLATE, k)), c) for k, c in enumerate(CYLINDERS)
        ),
        guides=tuple(guide(str(k + 1), _across(k), on_plate(*_polar(PLATE, k))) for k in range(3)),
        positive=CYLINDERS,
        home=(0, 0, 450, 0, 0, 0),
    ),
    "Z3 head with slides": Mechanism(
        name="Kin_SlideHead",
        joints=SLIDES,
        parameters=(BASE, PLATE, ROD),
        task=TILTS,
        rods=tuple(rod(str(k + 1), _polar(BASE, k, s), on_plate(*_polar(PLATE, k)), ROD) for k, s in enumerate(SLIDES)),
        guides=tuple(guide(str(k + 1), _across(k), on_plate(*_polar(PLATE, k))) for k in range(3)),
        home=(0, 0, 0, 0, 0, 0),
    ),
    "head in metres whose planes form a T, stated as equations": Mechanism(
        name="Kin_TeeHead",
        joints=SLIDES,
        parameters=(M_BASE, M_ROD),
        task=TILTS,
        rods=tuple(
            rod(str(k + 1), (*_FEET[k], s), _corner(*_T[k]), M_ROD)  # type: ignore[arg-type]
            for k, s in enumerate(SLIDES)
        ),
        closure=(_corner(*_T[0])[0], _corner(*_T[1])[0], _corner(*_T[2])[1]),
        home=(0, 0, -0.3, 0, 0, 0),
    ),
    "3-RRR on a lift": Mechanism(
        name="Kin_LiftedRrr",
        joints=(*ARMS, LIFT),
        parameters=(ARM, length("link_length", "Link", nominal=180.0), HEIGHT),
        task=TURNED,
        rods=tuple(
            rod(str(k + 1), _arm(k, a), on_plate(*_CORNERS[k]), length("link_length", "Link", nominal=180.0))
            for k, a in enumerate(ARMS)
        ),
        closure=(Z - LIFT - HEIGHT,),
        home=(0, 0, 0, 0),
    ),
    "tripod whose planes form a T, over a table with two slides": Mechanism(
        name="Kin_TableTripod",
        joints=(*TABLE, *CYLINDERS),
        parameters=(BASE, PLATE, RAISED),
        task=Task("xyz", Turning.DIRECTION),
        rods=tuple(
            rod(str(k), (x * BASE - TABLE[0], y * BASE - TABLE[1], RAISED), on_plate(x * PLATE, y * PLATE, 0), c)
            for k, ((x, y), c) in enumerate(zip(_TEE, CYLINDERS, strict=True), 1)
        ),
        guides=(
            guide("twist", (1, 0, 0), tuple(ROTATION * Matrix([0, PLATE, 0]))),
            guide("1", (1, 0, 0), on_plate(0, PLATE, 0), -TABLE[0]),
            guide("3", (0, 1, 0), on_plate(PLATE, 0, 0), -TABLE[1]),
        ),
        home=(0, 0, 450, 0, 0, 0),
    ),
    "pentapod, whose struts end on the spindle and on rings around it": Mechanism(
        name="Kin_Spindle",
        joints=STRUTS,
        parameters=(FRAME, RING),
        task=Task("xyz", Turning.DIRECTION),
        rods=(
            *(ring_rod(s.name[1:], (x, y, FRAME), on_plate(0, 0, z), RING, s) for s, (x, y, z) in _FIVE[:3]),
            *(rod(s.name[1:], (x, y, FRAME), on_plate(0, 0, z), s) for s, (x, y, z) in _FIVE[3:]),
        ),
        home=(0, 0, 400, Float(0.1), Float(-0.15), Float(0.4)),
    ),
    "plate on two cylinders along a skewed guide": Mechanism(
        name="Kin_SkewedGuide",
        joints=CYLINDERS[:2],
        parameters=(BASE,),
        task=Task("x", Turning.ABOUT_Z),
        rods=(
            rod("1", (-BASE, 0), on_plate(-50, -20), CYLINDERS[0]),
            rod("2", (BASE, -100), on_plate(60, -30), CYLINDERS[1]),
        ),
        guides=(guide("1", (sin(pi / 10), cos(pi / 10)), on_plate(0, 40), 120),),
        positive=CYLINDERS[:2],
        home=(30, 78, 0),
    ),
}
