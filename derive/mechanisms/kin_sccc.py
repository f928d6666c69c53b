"""Kin_SCCC: three turning links in a plane, driven through belts that couple them."""

from sympy import sin

from derive.frames import Rz, Tx
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    branch,
    coupling,
    length,
    limited,
    optional_length,
    rotary,
)

L1 = length("link_length_1", "Length of link 1, joint 1 to joint 2", nominal=300.0)
L2 = length("link_length_2", "Length of link 2, joint 2 to joint 3", nominal=250.0)
L3 = optional_length("link_length_3", "Length of link 3, joint 3 to the flange", nominal=80.0)
K12 = coupling("coupling_12", "Turn of joint 2 per turn of motor 1", nominal=-1.0)
K13 = coupling("coupling_13", "Turn of joint 3 per turn of motor 1", nominal=0.5)
K23 = coupling("coupling_23", "Turn of joint 3 per turn of motor 2", nominal=-1.0)

A1 = rotary("A1", "Link 1 about Z")
A2 = rotary("A2", "Link 2 about Z", coupling=K12 * A1.motor)
A3 = rotary("A3", "Link 3 about Z", coupling=K13 * A1.motor + K23 * A2.motor)

MECHANISM = Mechanism(
    name="Kin_SCCC",
    vendor=Vendor.SINSEGYE,
    family="planar",
    source="Sinsegye SF512x catalogue by name; parameters as Beckhoff 3D Type 8 (S_CCC)",
    summary="Planar arm with three turning links and gear couplings between motors and joints.",
    parameters=(L1, L2, L3, K12, K13, K23),
    joints=(A1, A2, A3),
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Rz(A3) * Tx(L3),
    task=Task("xy", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
    limited=(limited("joint_2", A2, "joint 2", angle=True), limited("joint_3", A3, "joint 3", angle=True)),
    notes=(
        "A belt arm with all motors in the base typically has coupling_12 = coupling_23 = -1.",
        "An open period is chosen nearest to the reference joint by joint; a commanded one counts on the axis.",
        "With a third link, the elbow of the offset interface is that of the line from joint 2 to the point, also "
        "where the offset is zero.",
    ),
)
