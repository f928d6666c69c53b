"""Kin_P2X_Type1: a biglide, two carriages on rails along X."""

from derive.mechanism import Constraint, Mechanism, Task, Vendor, X, Y, assembly, branch, distance, length, linear, rod
from derive.vectors import cross, minus, vector

LA = length("arm_length_1", "Length of arm 1", nominal=400.0)
LB = length("arm_length_2", "Length of arm 2", nominal=380.0)
Y1 = distance("rail_y_1", "Y of rail 1", nominal=0.0)
Y2 = distance("rail_y_2", "Y of rail 2", nominal=20.0)
D1 = distance("tcp_offset_1", "Plate joint of arm 1, to the left of the centre", nominal=30.0)
D2 = distance("tcp_offset_2", "Plate joint of arm 2, to the right of the centre", nominal=30.0)

A1 = linear("A1", "Carriage 1 along X", nominal=-300.0)
A2 = linear("A2", "Carriage 2 along X", nominal=300.0)

CARRIAGE_1, CARRIAGE_2 = vector(A1, Y1), vector(A2, Y2)
JOINT_1, JOINT_2 = vector(X - D1, Y), vector(X + D2, Y)
ROD_1, ROD_2 = minus(JOINT_1, CARRIAGE_1), minus(JOINT_2, CARRIAGE_2)

MECHANISM = Mechanism(
    name="Kin_P2X_Type1",
    vendor=Vendor.SINSEGYE,
    family="parallel",
    source="Sinsegye SF512x catalogue by name; two carriages along X are Softkin's definition",
    summary="Biglide: two carriages along X carry a plate that keeps its orientation.",
    parameters=(LA, LB, Y1, Y2, D1, D2),
    joints=(A1, A2),
    rods=(rod("1", CARRIAGE_1, JOINT_1, LA), rod("2", CARRIAGE_2, JOINT_2, LB)),
    task=Task("xy"),
    branches=(
        branch("carriage_1", ROD_1[0], margin="upright_1", left=+1, right=-1),
        branch("carriage_2", ROD_2[0], margin="upright_2", right=-1, left=+1),
    ),
    assembly=assembly("tcp", cross(ROD_1, ROD_2), margin="arms_aligned", below=-1, above=+1),
    constraints=(Constraint(abs(Y1 - Y2) < LA + LB, "the arms must be able to meet between the rails"),),
)
