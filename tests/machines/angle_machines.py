"""Machines whose chains state angles and lengths as numbers, in millimetres and in metres."""

from collections.abc import Mapping

from sympy import Rational, cos, pi, sin

from derive.description.mechanism import Mechanism
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.mechanism import DEGREE, Task, Turning, Vendor, branch, linear, rotary

X, Y, Z = (linear(name, f"slide {name}") for name in "XYZ")
B, C, A1, A2, A3, A4, A5, A6 = (rotary(n, f"turn {n}") for n in ("B", "C", "A1", "A2", "A3", "A4", "A5", "A6"))
_TILT = (branch("tilt", sin(B), positive=+1, negative=-1),)
_ABOUT = "The numbers of its chain are constants of the machine."


def _machine(name: str, **stated: object) -> Mechanism:
    common = {"vendor": Vendor.TEXTBOOK, "family": "articulated", "source": "the tests", "offset_interface": False}
    return Mechanism(name=f"Kin_{name}", summary=_ABOUT, **{**common, **stated})  # type: ignore[arg-type]


def _urdf(first: object, second: object, third: object) -> Mechanism:
    """An arm with three parallel axes, as its file states it: three of its angles are right, but for rounding."""
    return _machine(
        "Urdf",
        joints=(A1, A2, A3, A4, A5, A6),
        chain=denavit_hartenberg(
            (A1, 0.1625, 0.0, first),
            (A2, 0, -0.425, 0),
            (A3, 0, -0.3922, 0),
            (A4, 0.1333, 0, second),
            (A5, 0.0997, 0, third),
            (A6, 0.0996, 0, 0),
        ),
        task=Task("xyz", Turning.FULL),
        branches=(
            branch("shoulder", -0.425 * cos(A2) - 0.3922 * cos(A2 + A3) + 0.0997 * sin(A2 + A3 + A4), front=1, back=-1),
            branch("elbow", sin(A3), up=+1, down=-1),
            branch("wrist", sin(A5), positive=+1, negative=-1),
        ),
    )


NUMBERS: Mapping[str, Mechanism] = {
    "arm of a URDF file": _urdf(1.570796327, 1.5708, -1.570796325),
    "table with an axis at 60 degrees": _machine(
        "Table60",
        joints=(X, Y, Z, B, C),
        chain=Rz(C) * Tz(80) * Rx(60 * DEGREE) * Rz(B) * Rx(-pi / 3) * Tx(X) * Ty(Y) * Tz(Z),
        task=Task("xyz", Turning.DIRECTION),
        branches=_TILT,
    ),
    "head with an axis at 0.96 radians": _machine(
        "Head096",
        joints=(X, Y, Z, B, C),
        chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(C) * Rx(0.96) * Rz(B) * Rx(-0.96) * Tz(Rational(9, 100)),
        task=Task("xyz", Turning.DIRECTION),
        branches=_TILT,
    ),
    "skewed rails by numbers": _machine(
        "Skewed135",
        joints=(X, Y, Z),
        chain=Tx(X) * Rz(2.356194490192345) * Ty(Y) * Rz(-0.7853981634) * Rz(-pi / 2) * Tz(0.5 * Z),
        task=Task("xyz"),
        offset_interface=True,
    ),
    "slides whose angles add up": _machine(
        "Wedge35", joints=(X, Y, Z), chain=Ry(0.35) * Tx(X) * Ry(-0.85) * Tx(Z) * Ry(0.5) * Ty(Y), task=Task("xyz")
    ),
    "SCARA that is turned where it stands": _machine(
        "Scara45",
        joints=(A1, A2, Z, A4),
        chain=Rz(A1 + pi / 4) * Tx(0.35) * Rz(A2 - 0.5) * Tx(0.25) * Tz(Z - 0.1) * Rz(A4),
        task=Task("xyz", Turning.ABOUT_Z),
        branches=(branch("elbow", sin(A2 - 0.5), right=+1, left=-1),),
    ),
}
MEANT = {"arm of a URDF file": _urdf(pi / 2, pi / 2, -pi / 2)}
"""The machine that is meant, where numbers are rounded."""
