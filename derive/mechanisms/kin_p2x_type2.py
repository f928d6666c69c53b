"""Kin_P2X_Type2: a symmetric scissor on two carriages along X."""

from derive.mechanism import Mechanism, Task, Vendor, X, Y, assembly, distance, length, linear, rod

L = length("arm_length", "Length of the arms", nominal=400.0)
W = distance("tcp_link_distance", "Distance of the two joints of the plate; negative: crossed arms", nominal=60.0)

A1 = linear("A1", "Carriage 1 along X", nominal=-250.0)
A2 = linear("A2", "Carriage 2 along X", nominal=250.0)

HALF = (A2 - A1 - W) / 2

MECHANISM = Mechanism(
    name="Kin_P2X_Type2",
    vendor=Vendor.SINSEGYE,
    family="parallel",
    source="Beckhoff 2D Scissor Type 1 (P_2X); the frame is Softkin's definition",
    summary="Symmetric scissor: two carriages along X lift a plate that keeps its orientation.",
    parameters=(L, W),
    joints=(A1, A2),
    closure=(X - (A1 + A2) / 2,),
    rods=(rod("1", (HALF, 0), (0, Y), L),),
    bars=(rod("1", (A1, 0), (X - W / 2, Y), L), rod("2", (A2, 0), (X + W / 2, Y), L)),
    task=Task("xy"),
    positive=(HALF,),
    assembly=assembly("tcp", Y, margin="flat", below=-1, above=+1),
)
