"""Machines whose task or whose drives need a rule of their own: pitch, pitch and roll, gears, belts, differentials."""

from collections.abc import Mapping
from functools import partial

from sympy import cos, sin

from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import (
    TURN,
    Branch,
    Mechanism,
    Task,
    Turning,
    branch,
    distance,
    length,
    linear,
    rotary,
    transmission,
)
from tests.machines.textbook import textbook

X, Y, Z = (linear(name, f"slide {name}") for name in ("X", "Y", "Z"))
A, B, C, A1, A2, A3, A4, A5 = (rotary(name, f"turn {name}") for name in ("A", "B", "C", "A1", "A2", "A3", "A4", "A5"))
SHOULDER, HEIGHT = (distance(n, n, nominal=v) for n, v in (("shoulder_x", 50.0), ("shoulder_z", 200.0)))
BESIDE = distance("beside", "how far the plane of the arm is beside its first axis", nominal=40.0)
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((300.0, 400.0, 350.0, 120.0), 1))
G1 = transmission("gear_1", "turns of motor 1 per turn of its joint", nominal=3.0)
G2 = transmission("gear_2", "turns of joint 2 per turn of its motor, against it", nominal=-2.5)
_machine = partial(textbook, (X, Y, Z, A, B, C, A1, A2, A3, A4, A5, SHOULDER, HEIGHT, BESIDE, L1, L2, L3, L4, G1, G2))
PITCH, PITCH_ROLL = Task("xyz", Turning.PITCH), Task("xyz", Turning.PITCH_ROLL)


def _arm(reach: object, bend: object) -> tuple[Branch, Branch]:
    return branch("shoulder", reach, front=+1, back=-1), branch("elbow", bend, up=+1, down=-1)


_UPRIGHT = _arm(SHOULDER + L2 * sin(A2) + L3 * sin(A2 + A3) + L4 * sin(A2 + A3 + A4), sin(A3))
_COLUMN = Rz(A1) * Tx(SHOULDER) * Tz(HEIGHT)
_LINKS = Ry(A2) * Tz(L2) * Ry(A3) * Tz(L3) * Ry(A4) * Tz(L4)

WITH_PITCH = {
    "arm with four axes": _machine("FourAxes", _COLUMN * _LINKS, PITCH, _UPRIGHT, offset_interface=True),
    "arm with four axes over its column": _machine(
        "OverColumn",
        Tz(HEIGHT) * Rz(-A1) * Rx(A2) * Ty(L2) * Rx(A3) * Ty(L3) * Rx(A4) * Tz(L4),
        PITCH,
        _arm(L2 * cos(A2) + L3 * cos(A2 + A3) - L4 * sin(A2 + A3 + A4), sin(A3)),
    ),
    "slides and a tilting head": _machine("TiltingHead", Tx(X) * Ty(Y) * Tz(Z) * Ry(B) * Tz(L4), PITCH),
}

WITH_PITCH_AND_ROLL = {
    "arm with five axes": _machine("FiveAxes", _COLUMN * _LINKS * Rz(A5), PITCH_ROLL, _UPRIGHT),
    "arm with five axes, tool along x": _machine(
        "FiveAlongX",
        _COLUMN * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3) * Ry(A4) * Tx(L4) * Rx(-A5),
        PITCH_ROLL,
        _arm(SHOULDER + L2 * sin(A2) + L3 * cos(A2 + A3) + L4 * cos(A2 + A3 + A4), cos(A3)),
    ),
    "arm with five axes beside its column": _machine(
        "FiveBeside",
        Rz(A1) * Ty(BESIDE) * Tz(HEIGHT) * _LINKS * Rz(A5),
        PITCH_ROLL,
        _arm(L2 * sin(A2) + L3 * sin(A2 + A3) + L4 * sin(A2 + A3 + A4), sin(A3)),
    ),
}

TURNED, PLANE = Task("xyz", Turning.ABOUT_Z), Task("xyz")
DIRECTION = Task("xyz", Turning.DIRECTION)
R1 = rotary("A1", "geared turn A1", ratio=1 / G1.symbol)
R2 = rotary("A2", "geared turn A2", ratio=G2.symbol, coupling=R1.motor / 2)


def _bent(angle: object) -> tuple[Branch]:
    return (branch("elbow", sin(angle), right=+1, left=-1),)


WITH_GEARS = {
    "SCARA with gears": _machine(
        "Geared", Rz(A1 / 3) * Tx(L1) * Rz(A2 / 2) * Tx(L2) * Tz(Z), PLANE, _bent(A2 / 2), offset_interface=True
    ),
    "SCARA with gears of any ratio": _machine(
        "AnyGears", Rz(A1 / G1) * Tx(L1) * Rz(G2 * A2) * Tx(L2) * Tz(Z), PLANE, _bent(G2 * A2)
    ),
    "SCARA whose gears stand at its joints": _machine(
        "AtJoints",
        Rz(R1) * Tx(L1) * Rz(R2) * Tx(L2) * Tz(Z),
        PLANE,
        _bent(R2),
        joints=(R1, R2, Z),
        parameters=(L1, L2, G1, G2),
    ),
    "SCARA whose quill is geared": _machine(
        "GearedQuill",
        Rz(A1 * 3) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z - 20 * A4 / TURN) * Rz(A4 / 2),
        TURNED,
        _bent(A2),
        joints=(A1, A2, Z, A4),
    ),
}

WITH_SHARED_MOTORS = {
    "CoreXY with C": _machine(
        "CoreXyC", Tx((A + B) / 20) * Ty((A - B) / 20) * Tz(Z) * Rz(C), TURNED, offset_interface=True
    ),
    "beam on two racks": _machine("SkewBeam", Tx(L4 * A) * Rz(L4 / L3 * (A - B)) * Ty(Y), Task("xy", Turning.ABOUT_Z)),
    "head on a differential": _machine(
        "Differential",
        Tx(X) * Ty(Y) * Tz(Z) * Rz((A + B) / 2) * Ry((A - B) / 2) * Tz(L4),
        DIRECTION,
        (branch("tilt", sin((A - B) / 2), positive=+1, negative=-1),),
    ),
    "head on a differential without gears": _machine(
        "Doubled",
        Tx(X) * Ty(Y) * Tz(Z) * Rz(A + B) * Ry(A - B) * Tz(L4),
        DIRECTION,
        (branch("tilt", sin(A - B), positive=+1, negative=-1),),
    ),
    "SCARA with a nut and a spline": _machine(
        "Spline", Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(20 * (A - B) / TURN) * Rz(B), TURNED, _bent(A2)
    ),
    "wrist with three motors": _machine(
        "ThreeMotors",
        Tx(X) * Ty(Y) * Tz(Z) * Rz(A1) * Ry((A1 + A2) / 2) * Rz(A3 / 3 - A2 / 6) * Tz(L4),
        Task("xyz", Turning.FULL),
        (branch("tilt", sin((A1 + A2) / 2), positive=+1, negative=-1),),
    ),
}

WITH_ABSOLUTE_JOINTS = {
    "SCARA with belts": _machine(
        "Belts",
        Rz(A1) * Tx(L1) * Rz(A2 - A1) * Tx(L2) * Tz(Z) * Rz(A4 - A2),
        TURNED,
        _bent(A2 - A1),
        offset_interface=True,
    ),
    "arm with its elbow motor on the base, and gears": _machine(
        "GearedBelts",
        Tz(HEIGHT) * Rz(A1 / 2) * Ry(A2 / 3) * Tz(L2) * Ry(A3 / 4 - A2 / 3) * Tx(L3),
        PLANE,
        (
            branch("shoulder", L2 * sin(A2 / 3) + L3 * cos(A3 / 4), front=+1, back=-1),
            branch("elbow", cos(A3 / 4 - A2 / 3), up=+1, down=-1),
        ),
    ),
}

DRIVEN: Mapping[str, Mechanism] = {**WITH_GEARS, **WITH_SHARED_MOTORS, **WITH_ABSOLUTE_JOINTS}
WITH_FIVE_AXES = {
    "palletizer that tilts its tool": _machine(
        "TiltingPalletizer",
        _COLUMN * Ry(A2) * Tz(L1) * Ry(A3 - A2) * Tx(L2) * Ry(-A3) * Tx(BESIDE) * Tz(-L4) * Rz(A4) * Ry(A5),
        DIRECTION,
    ),
}
TASK_MACHINES: Mapping[str, Mechanism] = {**WITH_PITCH, **WITH_PITCH_AND_ROLL, **DRIVEN, **WITH_FIVE_AXES}
UNNAMED = {
    10: ("six axes by a table with angles as numbers",),
    8: (
        "arm whose wrist goes sideways",
        "palletizer that tilts its tool",
        "arm whose tool points across its last axis",
        "arm with an elbow that is held, whose shoulder is beside its base",
        "arm with an elbow that is held, whose flange is beside its wrist",
        "arm whose wrist may lie on its second axis",
        "arm whose elbow rolls, with a wrist",
        "arm whose elbow goes across, with a wrist",
        "arm with three parallel axes, the last two beside each other",
        "arm with a wrist that is bent by 60 degrees",
        "telescope between long links, with a wrist",
        "seven axes by a table, the last held",
        "seven axes with an elbow and a wrist beside them, the last held",
    ),
    2: (
        "finger that folds onto the second of two parallel axes",
        "head whose second axis leans by 45 degrees",
        "inclined head over a table on a trunnion",
    ),
}
"""By the number of solutions; all other machines whose branches the compiler names have 4."""
