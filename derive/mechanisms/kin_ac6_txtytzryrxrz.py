"""Kin_Ac6_TXTYTZRYRXRZ: a gantry that carries a head with three axes."""

from sympy import cos

from derive.frames import Rx, Ry, Rz, Tx, Txyz, Ty, Tz
from derive.mechanism import Mechanism, Task, Turning, Vendor, branch, distance, linear, rotary

FX = distance("flange_x", "Centre of the head to the flange, along x", nominal=40.0)
FY = distance("flange_y", "Centre of the head to the flange, along y", nominal=-25.0)
FZ = distance("flange_z", "Centre of the head to the flange, along z", nominal=-120.0)

A1 = linear("A1", "Slide along X")
A2 = linear("A2", "Slide along Y")
A3 = linear("A3", "Slide along Z")
A4 = rotary("A4", "Head about Y")
A5 = rotary("A5", "Head about the turned X")
A6 = rotary("A6", "Flange about its Z")

MECHANISM = Mechanism(
    name="Kin_Ac6_TXTYTZRYRXRZ",
    vendor=Vendor.SINSEGYE,
    family="articulated",
    source="Sinsegye SF512x catalogue by name; details are Softkin's definition",
    summary="Gantry with three slides and a head with three axes that meet in a point.",
    parameters=(FX, FY, FZ),
    joints=(A1, A2, A3, A4, A5, A6),
    chain=Tx(A1) * Ty(A2) * Tz(A3) * Ry(A4) * Rx(A5) * Rz(A6) * Txyz(FX, FY, FZ),
    task=Task("xyz", Turning.FULL),
    branches=(branch("wrist", cos(A5), upright=+1, flipped=-1, margin="a4_parallel_a6"),),
    offset_interface=False,
)
