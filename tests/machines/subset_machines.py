"""Machines that command some of x, y and z alone: upright planes, slides, lifts that turn."""

from collections.abc import Mapping
from functools import partial

from sympy import cos, pi, sin

from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    X,
    Z,
    assembly,
    branch,
    distance,
    length,
    linear,
    rod,
    rotary,
)
from tests.machines.textbook import textbook

S1, S2 = (linear(name, f"slide {name}") for name in ("S1", "S2"))
A1, A2, A3, C = (rotary(name, f"turn {name}") for name in ("A1", "A2", "A3", "C"))
BESIDE, HEIGHT = (distance(n, n, nominal=v) for n, v in (("beside", 40.0), ("height", 200.0)))
L1, L2, L3 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((300.0, 250.0, 80.0), 1))
ELBOW = branch("elbow", sin(A2), right=+1, left=-1)

_machine = partial(
    textbook, (S1, S2, A1, A2, A3, C, BESIDE, HEIGHT, L1, L2, L3), family="planar", offset_interface=None
)

SUBSETS: Mapping[str, Mechanism] = {
    "arm in an upright plane": _machine(
        "UprightArm", Tz(HEIGHT) * Ty(BESIDE) * Ry(A1) * Tx(L1) * Ry(A2) * Tx(L2), Task("xz"), (ELBOW,)
    ),
    "arm on a wall that leans": _machine("WallArm", Rx(pi / 2) * Ty(S1) * Rz(A1) * Tx(L1) * Tz(BESIDE), Task("xz")),
    "arm in an upright plane that points its tool": _machine(
        "UprightPitch",
        Ty(BESIDE) * Ry(A1) * Tx(L1) * Ry(A2) * Tx(L2) * Ry(A3) * Tz(L3),
        Task("xz", Turning.PITCH),
        (ELBOW,),
    ),
    "crane in a store whose fork turns": _machine("StoreCrane", Tx(S1) * Tz(S2) * Rz(C), Task("xz", Turning.ABOUT_Z)),
    "lift that turns": _machine("TurningLift", Tx(BESIDE) * Tz(S1) * Rz(C) * Tz(L3), Task("z", Turning.ABOUT_Z)),
}
SWEPT = {name: SUBSETS[name] for name in ("arm in an upright plane", "lift that turns")}
"""Those that the sweeps over all machines take."""

_BASE = length("base", "distance between the motors", nominal=180.0)
_ARM, _ROD = length("arm_length", "arm", nominal=150.0), length("rod_length", "rod", nominal=230.0)


def _across(first: tuple[object, ...], second: tuple[object, ...]) -> object:
    return first[0] * second[2] - first[2] * second[0]  # type: ignore[operator]


def _upright_loop() -> Mechanism:
    """A five-bar linkage that stands upright: its plate moves in x and z."""
    motors = tuple((side * _BASE / 2, angle) for side, angle in ((-1, A1), (1, A2)))
    arms = tuple((_ARM * cos(a), 0, _ARM * sin(a)) for _, a in motors)
    knees = tuple((at + arm[0], 0, arm[2]) for (at, _), arm in zip(motors, arms, strict=True))
    rods = tuple((X - knee[0], 0, Z - knee[2]) for knee in knees)
    return Mechanism(
        name="Kin_UprightFiveBar",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        joints=(A1, A2),
        parameters=(_BASE, _ARM, _ROD),
        rods=tuple(rod(str(k), knee, (X, 0, Z), _ROD) for k, knee in enumerate(knees, 1)),
        task=Task("xz"),
        branches=tuple(
            branch(name, _across(arm, one), outward=sign, inward=-sign)
            for name, arm, one, sign in zip(("left", "right"), arms, rods, (1, -1), strict=True)
        ),
        assembly=assembly("tcp", _across(*rods), margin="aligned", above=1, below=-1),
    )


LOOPS: Mapping[str, Mechanism] = {
    "five-bar that stands upright": _upright_loop(),
    "crank that lifts a slide": Mechanism(
        name="Kin_LiftingCrank",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        joints=(A1,),
        parameters=(_ARM, _ROD),
        rods=(rod("1", (_ARM * cos(A1), 0, _ARM * sin(A1)), (0, 0, Z), _ROD),),
        task=Task("z"),
    ),
}
