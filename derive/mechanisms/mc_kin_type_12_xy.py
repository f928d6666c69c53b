"""MC_KIN_TYPE_12_XY: two links driven in one point; a rod and a crank turn the forearm."""

from sympy import cos, sin

from derive.mechanism import Constraint, Mechanism, Task, Vendor, X, Y, assembly, branch, flag, length, rod, rotary
from derive.vectors import cross, minus, vector

L1 = length("link_length_1", "Upper arm, origin to T", nominal=300.0)
L2 = length("link_length_2", "Forearm, T to the TCP", nominal=350.0)
L3 = length("link_length_3", "Rear extension of the forearm, T to E", nominal=110.0)
L4 = length("link_length_4", "Rod, E to W", nominal=280.0)
L5 = length("link_length_5", "Crank, origin to W", nominal=90.0)
SWAP = flag("swap_xy", "The mirrored reading: X and Y exchanged")

A1 = rotary("A1", "Upper arm; positive clockwise, zero along -Y")
A2 = rotary("A2", "Crank; positive clockwise, zero along -X")

TCP = vector(X + SWAP * (Y - X), Y + SWAP * (X - Y))
T = vector(-L1 * sin(A1), -L1 * cos(A1))
W = vector(-L5 * cos(A2), L5 * sin(A2))
K = L3 / L2
E = vector((1 + K) * T[0] - K * TCP[0], (1 + K) * T[1] - K * TCP[1])
ORIGIN = vector(0, 0)
MIRROR = 1 - 2 * SWAP

MECHANISM = Mechanism(
    name="MC_KIN_TYPE_12_XY",
    class_name="KinType12XY",
    vendor=Vendor.REXROTH,
    family="parallel",
    source="Bosch Rexroth, ctrlX CORE: CODESYS SoftMotion, user-defined kinematics, type 12",
    summary="Two links driven in the origin; a rod and a crank turn the forearm.",
    parameters=(L1, L2, L3, L4, L5, SWAP),
    joints=(A1, A2),
    rods=(rod("upper", T, TCP, L2), rod("rear", W, E, L4)),
    bars=(rod("forearm", T, TCP, L2), rod("rear", T, E, L3), rod("rod", W, E, L4)),
    task=Task("xy"),
    branches=(
        branch("elbow", cross(minus(ORIGIN, TCP), minus(T, TCP)), margin="stretched_1", left=+1, right=-1),
        branch("crank", cross(minus(ORIGIN, E), minus(W, E)), margin="stretched_2", left=+1, right=-1),
    ),
    assembly=assembly(
        "e", MIRROR * cross(minus(W, T), minus(E, T)), margin="arms_aligned", handedness=MIRROR, left=+1, right=-1
    ),
    constraints=tuple(
        Constraint(
            longest < L1 + L3 + L4 + L5 - longest, f"link {k} must be shorter than the other links of the loop together"
        )
        for k, longest in ((1, L1), (3, L3), (4, L4), (5, L5))
    ),
    notes=(
        "elbow: on which side of the line from the TCP to the origin T is, the end of the upper arm, seen along this "
        "line. crank: on which side of the line from E to the origin W is, the end of the crank. In the mirrored "
        "reading left and right are exchanged.",
    ),
)
