"""Dimensions of robots as their makers publish them, by the mechanism that they are."""

UR5 = {"d1": 89.159, "a2": -425.0, "a3": -392.25, "d4": 109.15, "d5": 94.65, "d6": 82.3}
UR10 = {"d1": 127.3, "a2": -612.0, "a3": -572.3, "d4": 163.941, "d5": 115.7, "d6": 92.2}
KR6_R900 = {"d1": 400.0, "a1": 25.0, "a2": 455.0, "a3": 35.0, "d4": 420.0, "d6": 80.0}
"""A forearm whose axis is beside the elbow, and no shift sideways."""
PUMA_560 = {"d1": 660.4, "a2": 431.8, "d3": -149.09, "a3": 20.32, "d4": 433.07, "d6": 56.25}
"""An arm beside its first axis."""

ROBOTS: dict[str, dict[str, dict[str, float]]] = {
    "Kin_Ac6_ThreeParallel": {"UR5": UR5},
    "Kin_ArticulatedRobot_6DOF": {"KR6 R900": KR6_R900, "PUMA 560": PUMA_560},
    "Kin_Pos_RRR": {
        name: {k: v for k, v in r.items() if k != "d6"} for name, r in (("KR6", KR6_R900), ("PUMA", PUMA_560))
    },
}
