"""Kin_Crane: a boom in spherical coordinates; the load keeps its orientation."""

from sympy import cos, sin

from derive.mechanism import Mechanism, Task, Vendor, X, Y, Z, arc, linear, rod, rotary
from derive.vectors import vector

R = linear("R", "Length of the boom", domain=(0.0, 1e9), nominal=200.0)
THETA = rotary("Theta", "Azimuth, from X")
PHI = arc("Phi", "Polar angle, from +Z", domain=(0.0, 180.0), nominal=60.0)

TIP = vector(R * sin(PHI) * cos(THETA), R * sin(PHI) * sin(THETA), R * cos(PHI))

MECHANISM = Mechanism(
    name="Kin_Crane",
    vendor=Vendor.TEXTBOOK,
    family="polar",
    source="Control Engineering, Kinematics Equations for Control of Robotic Systems",
    summary="Spherical crane: length, azimuth and polar angle of a boom.",
    joints=(R, THETA, PHI),
    closure=(X - TIP[0], Y - TIP[1], Z - TIP[2]),
    bars=(rod("boom", (0, 0, 0), TIP, R),),
    task=Task("xyz"),
    positive=(R, sin(PHI)),
    notes=("On the vertical the azimuth is the reference's; at the origin the polar angle is too.",),
)
