"""Machines with an angle that the pose may leave free, while a later joint has solutions for some values only."""

from collections.abc import Mapping

from sympy import pi

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Joint, Mechanism, Parameter, Task, Turning, length, linear, rotary

X, Y, Z = (linear(name, f"slide {name}") for name in ("X", "Y", "Z"))
A, B, C = (rotary(name, f"turn {name}") for name in ("A", "B", "C"))
L1, L2, L3 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((120.0, 200.0, 50.0), 1))
M1, M2, M3 = (length(f"link_{k}", f"link {k}, in metres", nominal=v) for k, v in enumerate((0.12, 0.3, 0.05), 1))


def _machine(name: str, joints: tuple[Joint, ...], chain: Chain, parameters: tuple[Parameter, ...]) -> Mechanism:
    return Mechanism(
        name=f"Kin_{name}", joints=joints, parameters=parameters, chain=chain, task=Task("xyz", Turning.DIRECTION)
    )


FREED: Mapping[str, Mechanism] = {
    "arm on a rocker between slides that may be parallel": _machine(
        "RockerSlides", (Y, C, B, A, Z), Ty(Y) * Rz(-C) * Tx(L1) * Ry(B) * Rz(A) * Tx(L2) * Tz(Z), (L1, L2)
    ),
    "arm on a rocker between slides, in metres, along other axes": _machine(
        "RockerMetres", (Z, A, C, B, X), Tz(Z) * Rx(A) * Ty(M1) * Rz(C) * Rx(B) * Ty(M2) * Tx(X) * Ry(pi / 2), (M1, M2)
    ),
    "head whose swivel makes its arm short": _machine(
        "ShortArmHead", (Z, Y, C, B, A), Tz(Z) * Ty(Y) * Tx(L1) * Rz(C) * Ry(-B) * Tz(L2) * Ry(A) * Tz(L3), (L1, L2, L3)
    ),
    "head whose swivel makes its arm short, in metres, along other axes": _machine(
        "ShortArmMetres",
        (X, Z, A, B, C),
        Tx(X) * Tz(Z) * Ty(M1) * Rx(A) * Rz(-B) * Tx(M2) * Rz(C) * Tx(M3) * Ry(pi / 2),
        (M1, M2, M3),
    ),
}
