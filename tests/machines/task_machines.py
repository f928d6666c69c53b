"""Machines whose task or whose drives need a rule of their own: pitch, pitch and roll, gears, belts, differentials."""

from __future__ import annotations

from collections.abc import Mapping

from sympy import cos, sin

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import (
    Branch,
    Joint,
    Mechanism,
    Parameter,
    Task,
    Turning,
    Vendor,
    branch,
    distance,
    length,
    linear,
    rotary,
)

X, Y, Z = (linear(name, f"slide {name}") for name in ("X", "Y", "Z"))
A, B, C, A1, A2, A3, A4, A5 = (rotary(name, f"turn {name}") for name in ("A", "B", "C", "A1", "A2", "A3", "A4", "A5"))
SHOULDER, HEIGHT = (distance(n, n, nominal=v) for n, v in (("shoulder_x", 50.0), ("shoulder_z", 200.0)))
BESIDE = distance("beside", "how far the plane of the arm is beside its first axis", nominal=40.0)
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((300.0, 400.0, 350.0, 120.0), 1))
PITCH, PITCH_ROLL = Task("xyz", Turning.PITCH), Task("xyz", Turning.PITCH_ROLL)


def _machine(
    name: str,
    joints: tuple[Joint, ...],
    chain: Chain,
    parameters: tuple[Parameter, ...],
    task: Task,
    branches: tuple[Branch, ...] = (),
    **details: object,
) -> Mechanism:
    stated = {"offset_interface": False, **details}
    return Mechanism(
        name=f"Kin_{name}",
        vendor=Vendor.TEXTBOOK,
        family="articulated",
        source="the tests",
        summary="A machine that is in no catalogue.",
        joints=joints,
        parameters=parameters,
        chain=chain,
        task=task,
        branches=branches,
        **stated,  # type: ignore[arg-type]
    )


def _arm(reach: object, bend: object) -> tuple[Branch, Branch]:
    return branch("shoulder", reach, front=+1, back=-1), branch("elbow", bend, up=+1, down=-1)


_UPRIGHT = _arm(SHOULDER + L2 * sin(A2) + L3 * sin(A2 + A3) + L4 * sin(A2 + A3 + A4), sin(A3))
_COLUMN = Rz(A1) * Tx(SHOULDER) * Tz(HEIGHT)
_LINKS = Ry(A2) * Tz(L2) * Ry(A3) * Tz(L3) * Ry(A4) * Tz(L4)

WITH_PITCH = {
    "arm with four axes": _machine(
        "FourAxes", (A1, A2, A3, A4), _COLUMN * _LINKS, (SHOULDER, HEIGHT, L2, L3, L4), PITCH, _UPRIGHT
    ),
    "arm with four axes over its column": _machine(
        "OverColumn",
        (A1, A2, A3, A4),
        Tz(HEIGHT) * Rz(-A1) * Rx(A2) * Ty(L2) * Rx(A3) * Ty(L3) * Rx(A4) * Tz(L4),
        (HEIGHT, L2, L3, L4),
        PITCH,
        _arm(L2 * cos(A2) + L3 * cos(A2 + A3) - L4 * sin(A2 + A3 + A4), sin(A3)),
    ),
    "slides and a tilting head": _machine(
        "TiltingHead", (X, Y, Z, B), Tx(X) * Ty(Y) * Tz(Z) * Ry(B) * Tz(L4), (L4,), PITCH
    ),
}

WITH_PITCH_AND_ROLL = {
    "arm with five axes": _machine(
        "FiveAxes", (A1, A2, A3, A4, A5), _COLUMN * _LINKS * Rz(A5), (SHOULDER, HEIGHT, L2, L3, L4), PITCH_ROLL,
        _UPRIGHT,
    ),
    "arm with five axes, tool along x": _machine(
        "FiveAlongX",
        (A1, A2, A3, A4, A5),
        _COLUMN * Ry(A2) * Tz(L2) * Ry(A3) * Tx(L3) * Ry(A4) * Tx(L4) * Rx(-A5),
        (SHOULDER, HEIGHT, L2, L3, L4),
        PITCH_ROLL,
        _arm(SHOULDER + L2 * sin(A2) + L3 * cos(A2 + A3) + L4 * cos(A2 + A3 + A4), cos(A3)),
    ),
    "arm with five axes beside its column": _machine(
        "FiveBeside",
        (A1, A2, A3, A4, A5),
        Rz(A1) * Ty(BESIDE) * Tz(HEIGHT) * _LINKS * Rz(A5),
        (BESIDE, HEIGHT, L2, L3, L4),
        PITCH_ROLL,
        _arm(L2 * sin(A2) + L3 * sin(A2 + A3) + L4 * sin(A2 + A3 + A4), sin(A3)),
    ),
}  # fmt: skip

TASK_MACHINES: Mapping[str, Mechanism] = {**WITH_PITCH, **WITH_PITCH_AND_ROLL}

TASK_SOLUTIONS = {
    "arm with four axes": 4,
    "arm with four axes over its column": 4,
    "slides and a tilting head": 1,
    "arm with five axes": 4,
    "arm with five axes, tool along x": 4,
    "arm with five axes beside its column": 4,
}
"""The largest number of solutions, as a search of the closure from many starts finds them."""
