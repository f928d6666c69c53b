"""Serial chains of few axes: an arm without length in some poses, arms without a closed form, and held joints."""

from __future__ import annotations

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Joint, Mechanism, Parameter, Task, Turning, Vendor, length, linear, rotary

Y = linear("Y", "slide Y")
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", f"turn A{k}") for k in range(1, 7))
L1, L2, L3, L4 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((50.0, 200.0, 300.0, 120.0), 1))


def _chain(
    name: str, joints: tuple[Joint, ...], chain: Chain, parameters: tuple[Parameter, ...], task: Task
) -> Mechanism:
    return Mechanism(
        name=f"Kin_{name}",
        vendor=Vendor.TEXTBOOK,
        family="articulated",
        source="the tests",
        summary="A serial chain.",
        joints=joints,
        parameters=parameters,
        chain=chain,
        task=task,
        offset_interface=False,
    )


WITHOUT_ARM = {
    "finger on a rocker on a slide": _chain(
        "Finger", (Y, A1, A2), Ty(Y) * Tz(L1) * Rx(A1) * Tx(L2) * Ry(A2) * Tz(L3), (L1, L2, L3), Task("xyz")
    ),
    "arm whose wrist may lie on its second axis": _chain(
        "Kneeling",
        (A1, A2, A3, A4, A5, A6),
        Ry(A1) * Tz(L1) * Rz(A2) * Tz(L2) * Rx(-A3) * Ty(L3) * Rz(A4) * Rx(A5) * Rz(A6) * Tz(L4),
        (L1, L2, L3, L4),
        Task("xyz", Turning.FULL),
    ),
    "finger beside a rocker on a slide": _chain(
        "Beside",
        (Y, A1, A2),
        Ty(Y) * Tz(L1) * Rx(A1) * Tx(L2) * Ry(A2) * Tz(L3) * Ty(L4),
        (L1, L2, L3, L4),
        Task("xyz"),
    ),
}
"""Joints fold the arm of a later joint onto its axis: that joint is free there. In the last one its size changes only."""

CHAINS = {**WITHOUT_ARM}
CHAIN_SOLUTIONS = {
    "finger on a rocker on a slide": 4,
    "arm whose wrist may lie on its second axis": 8,
    "finger beside a rocker on a slide": 4,
}
