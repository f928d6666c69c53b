"""Kin_P2Y: an H-bot, two motors on one belt; equal motion is +Y."""

from derive.frames import Tx, Ty
from derive.mechanism import Mechanism, Task, Vendor, limited, linear

A1 = linear("A1", "Motor 1")
A2 = linear("A2", "Motor 2")

CARRIAGE_X = (A1 - A2) / 2
CARRIAGE_Y = (A1 + A2) / 2

MECHANISM = Mechanism(
    name="Kin_P2Y",
    vendor=Vendor.SINSEGYE,
    family="gantry",
    source="Beckhoff H-Bot (P_2Y); scale and signs are Softkin's definition",
    summary="H-bot: two motors move a carriage in the plane through one belt.",
    joints=(A1, A2),
    chain=Tx(CARRIAGE_X) * Ty(CARRIAGE_Y),
    belt="H",
    task=Task("xy"),
    limited=(
        limited("x", CARRIAGE_X, "X of the carriage", angle=False),
        limited("y", CARRIAGE_Y, "Y of the carriage", angle=False),
    ),
)
