"""The machines that are asked: dimensions (millimetres, degrees) of every mechanism, and pairs that are coupled."""

from collections.abc import Mapping

_TRIANGLE = {
    "rail_x_1": 0.0, "rail_y_1": 150.0, "rail_x_2": -130.0, "rail_y_2": -75.0, "rail_x_3": 130.0, "rail_y_3": -75.0,
}  # fmt: skip
_DELTA = {
    f"{name}_{i}": value
    for name, value in {"base_radius": 140.0, "inner_arm": 200.0, "outer_arm": 450.0, "tcp_radius": 45.0}.items()
    for i in (1, 2, 3)
}
_BASE = ((338.0, -91.0), (338.0, 91.0), (-90.0, 338.0), (-248.0, 247.0), (-248.0, -247.0), (-90.0, -338.0))
_PLATE = ((142.0, -141.0), (142.0, 141.0), (52.0, 193.0), (-193.0, 52.0), (-193.0, -52.0), (52.0, -193.0))
_HEXAPOD = {
    f"{side}_{i}_{letter}": value
    for side, points in (("base", _BASE), ("platform", _PLATE))
    for i, point in enumerate(points, 1)
    for letter, value in zip("xy", point, strict=True)
} | {"home_z": 600.0}

_3RRR = {
    f"{side}_{i}_{letter}": value
    for side, points in (
        ("base", ((-260.0, -150.0), (265.0, -145.0), (5.0, 300.0))),
        ("platform", ((-70.0, -40.0), (72.0, -38.0), (2.0, 80.0))),
    )
    for i, point in enumerate(points, 1)
    for letter, value in zip("xy", point, strict=True)
} | {f"{what}_length_{i}": size + 4.0 * i for what, size in (("arm", 150.0), ("rod", 170.0)) for i in (1, 2, 3)}

_HEXAGLIDE = {
    f"platform_{i}_{letter}": value
    for i, point in enumerate(
        ((40.0, -145.0), (145.0, -42.0), (2.0, 150.0), (-75.0, -130.0), (75.0, 133.0), (145.0, 40.0)), 1
    )
    for letter, value in zip("xy", point, strict=True)
} | {f"rail_{i}_y": y for i, y in enumerate((-320.0, -192.0, -60.0, 61.0, 190.0, 319.0), 1)}
_HEXAGLIDE |= {f"rod_length_{i}": 620.0 + 3.0 * i for i in range(1, 7)} | {"home_z": -420.0}
_HEXAGLIDE |= {f"rail_{i}_z": 2.0 * i for i in range(1, 7)}
_HEXAGLIDE |= {f"carriage_side_{i}": -1.0 for i in (2, 3, 4, 6)}

_PENTAPOD = {
    f"base_{i}_{letter}": value
    for i, point in enumerate(((-418.0, 325.0), (420.0, 324.0), (417.0, -326.0), (3.0, -493.0), (-415.0, -322.0)), 1)
    for letter, value in zip("xyz", (*point, 890.0 + 5.0 * i), strict=True)
} | {f"ring_{i}_z": z for i, z in enumerate((185.0, 160.0, 41.0, 14.0, 68.0), 1)}
_PENTAPOD |= {f"ring_{i}_radius": 70.0 + 4.0 * i for i in range(1, 6)} | {"home_z": 400.0}

_RODWRIST = {
    f"{what}_{i}_{letter}": value
    for what, points in (
        ("base", ((-12.0, 45.0, -200.0), (-8.0, -44.0, -130.0))),
        ("platform", ((-60.0, 45.0, 4.0), (-58.0, -46.0, 6.0))),
    )
    for i, point in enumerate(points, 1)
    for letter, value in zip("xyz", point, strict=True)
} | {"crank_length_1": 50.0, "crank_length_2": 48.0, "rod_length_1": 203.0, "rod_length_2": 135.0}


def _anchors(what: str, *places: tuple[float, float, float]) -> dict[str, float]:
    """The fixed ends of struts or cables."""
    points = enumerate((zip("xyz", place, strict=True) for place in places), 1)
    return {f"{what}_{k}_{letter}": value for k, point in points for letter, value in point}


DIMENSIONS: dict[str, dict[str, float]] = {
    "Kin_5Axes": {"tool_length": 90.0},
    "Softkin_HeadHead_CA": {"fork_offset": 20.0, "head_offset": 12.0, "pivot_length": 250.0},
    "Softkin_HeadHead_CB": {"fork_offset": 25.0, "head_offset": -15.0, "pivot_length": 260.0},
    "Softkin_HeadTable_AC": {"head_offset": -25.0, "pivot_length": 220.0},
    "Softkin_HeadTable_BC": {"head_offset": 35.0, "pivot_length": 240.0},
    "Softkin_NutatingHead_CA": {
        "fork_offset": 12.0, "head_offset": -18.0, "pivot_length": 270.0, "nutation": 50.0,
    },
    "Softkin_NutatingHead_CB": {
        "fork_offset": 5.0, "head_offset": -10.0, "pivot_length": 280.0, "nutation": 45.0,
    },
    "Softkin_NutatingTable_BC": {"pivot_x": 8.0, "pivot_z": 30.0, "tool_length": 110.0, "nutation": 50.0},
    "Softkin_NutatingHeadTable_BC": {"head_offset": 30.0, "pivot_length": 250.0, "nutation": 45.0},
    "Softkin_NutatingTable_AC": {"pivot_y": -12.0, "pivot_z": 35.0, "tool_length": 115.0, "nutation": 45.0},
    "Softkin_Palletizer": {
        "base_height": 320.0, "shoulder_offset": 80.0, "link_length_1": 300.0, "link_length_2": 350.0,
        "wrist_offset_x": 60.0, "wrist_offset_z": -90.0,
    },
    "Softkin_Palletizer5": {
        "base_height": 320.0, "shoulder_offset": 80.0, "link_length_1": 300.0, "link_length_2": 350.0,
        "wrist_offset_x": 60.0, "wrist_offset_z": -90.0, "tool_length": -130.0,
    },
    "Softkin_SwivelArm": {"arm_length": 400.0},
    "Softkin_CylinderPalletizer": {
        "base_height": 500.0, "shoulder_offset": 150.0, "link_length_1": 700.0, "link_length_2": 800.0,
        "wrist_offset_x": 120.0, "wrist_offset_z": -90.0, "cylinder_2_x": -420.0, "cylinder_2_z": 60.0,
        "cylinder_eye": 380.0, "cylinder_3_x": -300.0, "cylinder_3_z": -450.0, "lever_length": 250.0,
    },
    "Softkin_Excavator": {
        "boom_foot_x": 300.0, "boom_foot_z": 800.0, "boom_length": 1800.0, "stick_length": 1100.0,
        "bucket_length": 600.0, "boom_cylinder_base_x": 250.0, "boom_cylinder_base_z": -350.0,
        "boom_cylinder_eye_x": 900.0, "boom_cylinder_eye_z": -150.0, "stick_cylinder_base_x": -1000.0,
        "stick_cylinder_base_z": 350.0, "stick_cylinder_eye_x": -250.0, "stick_cylinder_eye_z": 100.0,
        "bucket_cylinder_base_x": -900.0, "bucket_cylinder_base_z": 200.0, "rocker_pivot_x": -220.0,
        "rocker_length": 200.0, "rod_length": 276.0, "bucket_ear_x": -60.0, "bucket_ear_z": 140.0,
    },
    "Softkin_RodPalletizer": {
        "base_height": 500.0, "shoulder_offset": 150.0, "link_length_1": 700.0, "link_length_2": 800.0,
        "wrist_offset_x": 120.0, "wrist_offset_z": -90.0, "cylinder_base_x": -420.0, "cylinder_base_z": 60.0,
        "cylinder_eye": 380.0, "crank_base_x": 350.0, "crank_base_z": -300.0, "crank_length": 180.0,
        "rod_length": 308.0, "lever_length": 220.0,
    },
    "Softkin_ScissorLift": {
        "beam_length": 1600.0, "table_height": 120.0,
    },
    "Softkin_ScaraOnRail": {"link_length_1": 325.0, "link_length_2": 225.0},
    "Softkin_SkewGantry3": {"skew": 78.0},
    "Softkin_TableTable_AB": {"pivot_y": 30.0, "pivot_z": -45.0, "tool_length": 125.0},
    "Softkin_TableTable_AC": {"pivot_y": 40.0, "pivot_z": -60.0, "tool_length": 120.0},
    "Softkin_TableTable_BC": {"pivot_x": -35.0, "pivot_z": 50.0, "tool_length": 130.0},
    "Softkin_ThreeCables": _anchors(
        "cable", (0.0, 2050.0, 2500.0), (-1800.0, -950.0, 2450.0), (1750.0, -1000.0, 2600.0)
    ),
    "Softkin_Tracyl": {"radius": 45.0},
    "Softkin_Transmit": {},
    "Softkin_Tripod_Struts": _anchors("strut", (10.0, 300.0, 5.0), (-250.0, -160.0, 0.0), (260.0, -150.0, -8.0)),
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": {
        "d1": 615.0, "a1": 100.0, "a2": 705.0, "a3": 135.0, "d4": 755.0, "j6_offset_x": 60.0, "d6": 85.0,
    },
    "Kin_Ac6_ThreeParallel": {"d1": 89.159, "a2": -425.0, "a3": -392.25, "d4": 109.15, "d5": 94.65, "d6": 82.3},
    "Kin_Ac6_TXTYTZRYRXRZ": {"flange_x": 40.0, "flange_y": -25.0, "flange_z": -120.0},
    "Kin_ArticulatedRobot_6DOF": {"d1": 350.0, "a1": 80.0, "a2": 310.0, "d3": 50.0, "a3": 30.0, "d4": 290.0,
        "d6": 75.0},
    "Kin_Bipod_Rotary": {"inner_arm": 250.0, "outer_arm": 500.0, "displacement": 120.0, "tcp_displacement": 40.0},
    "Kin_CAxis": {},
    "Kin_CAxis_Tool": {"tool_x": 15.0, "tool_y": -8.0, "tool_z": -60.0},
    "Kin_Crane": {},
    "Kin_Delta_P3C_Type3": {"azimuth_1": 0.0, "azimuth_2": 90.0, "azimuth_3": -90.0, **_DELTA},
    "Kin_Gantry2": {},
    "Kin_Gantry3": {},
    "Kin_GantryCutter2": {"direction_r": 1.0},
    "Kin_GantryCutter3": {"direction_r": 1.0},
    "Kin_Hexapod": _HEXAPOD,
    "Kin_HGantry2": {},
    "Kin_HGantry3": {},
    "Kin_P2C_Type1": {"inner_arm": 250.0, "outer_arm": 500.0, "displacement": 120.0, "tcp_displacement": 40.0},
    "Kin_P2C_Type2": {"inner_arm": 250.0, "outer_arm": 500.0, "displacement": 120.0, "tcp_link_distance": 80.0},
    "Kin_P2X_Type1": {
        "arm_length_1": 400.0, "arm_length_2": 380.0, "rail_y_2": 20.0, "tcp_offset_1": 30.0, "tcp_offset_2": 30.0,
    },
    "Kin_P2X_Type2": {"arm_length": 400.0, "tcp_link_distance": 60.0},
    "Kin_P2Y": {},
    "Kin_PCC": {"link_length_1": 300.0, "link_length_2": 250.0},
    "Kin_Polar": {},
    "Kin_Polar_Z": {},
    "Kin_Pos_RRR": {"d1": 350.0, "a1": 80.0, "a2": 310.0, "d3": 50.0, "a3": 30.0, "d4": 290.0},
    "Kin_Scara2_Z": {"arm_length_1": 300.0, "arm_length_2": 250.0},
    "Kin_Scara3_CCZ": {"link_length_1": 325.0, "link_length_2": 225.0},
    "Kin_Scara3_Z": {"arm_length_1": 300.0, "arm_length_2": 250.0, "arm_length_3": 80.0},
    "Kin_Scara3_ZCCC": {"link_length_1": 325.0, "link_length_2": 225.0, "link_length_3": 60.0},
    "Kin_Scara4_ZCCC": {"link_length_1": 325.0, "link_length_2": 225.0, "link_length_3": 60.0},
    "Kin_Scara4_CCZC_ZCcoupled": {
        "link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0, "gear_coupling": 0.0, "flange_down": 1.0,
    },
    "Kin_Scara4_ZCcoupled_Type1": {"link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0},
    "Kin_SCCC": {
        "link_length_1": 300.0, "link_length_2": 250.0, "link_length_3": 80.0,
        "coupling_12": -1.0, "coupling_13": 0.5, "coupling_23": -1.0,
    },
    "Kin_TGantry2": {},
    "Kin_TGantry3": {},
    "Softkin_Bipod_C": {"inner_arm": 250.0, "outer_arm": 500.0, "displacement": 120.0, "tcp_displacement": 40.0},
    "Softkin_Delta_C": {"base_radius": 160.0, "arm_length": 240.0, "rod_length": 560.0, "plate_radius": 45.0},
    "Softkin_DualScara": {
        "base_distance": 140.0, "arm_length_1": 200.0, "arm_length_2": 210.0, "rod_length_1": 260.0,
        "rod_length_2": 250.0,
    },
    "Softkin_Hexaglide": _HEXAGLIDE,
    "Softkin_Planar_3RRR": _3RRR,
    "Softkin_Pentapod": _PENTAPOD,
    "Softkin_RodWrist": _RODWRIST,
    "Kin_Tool": {"tool_x": 15.0, "tool_y": -8.0, "tool_z": -60.0},
    "Kin_Tripod_Linear": {
        "outer_radius": 300.0, "inner_radius": 60.0, "arm_length": 400.0, "rail_angle": 30.0,
        "max_angle_ball_joint": 45.0,
    },
    "Kin_Tripod_P3Z": {"arm_length": 269.0, "tcp_displacement": 20.0, **_TRIANGLE},
    "Kin_Tripod_Rotary": {
        "arm_length_1": 200.0, "arm_length_2": 450.0, "arm_1_radius": 140.0, "stewart_radius": 50.0, "distance": 40.0,
        "max_angle_ball_joint": 45.0,
    },
    "Kin_Wrist2": {"tool_length": 90.0, "roll_axis_offset_x": 12.0, "roll_axis_offset_y": -7.0,
        "roll_axis_offset_z": -40.0},
    "Kin_Wrist3": {"tool_offset_x": 10.0, "tool_offset_y": -6.0, "tool_offset_z": 75.0},
    "MC_KIN_TYPE_12_XY": {
        "link_length_1": 300.0, "link_length_2": 350.0, "link_length_3": 110.0, "link_length_4": 280.0,
        "link_length_5": 90.0,
    },
}  # fmt: skip

ALSO: dict[str, tuple[dict[str, float], ...]] = {
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": ({"j6_offset_x": 0.0}, {"j6_offset_x": -20.0, "a3": -50.0}),
    "Kin_Ac6_ThreeParallel": ({"d4": 0.0}, {"a3": -425.0, "d4": 0.0}),
    "Kin_ArticulatedRobot_6DOF": ({"d1": 400.0, "a1": 25.0, "a2": 455.0, "d3": 0.0, "a3": 35.0, "d4": 420.0,
        "d6": 80.0},
                                  {"a1": 0.0, "d3": 0.0, "a3": 0.0, "a2": 290.0}),
    "Kin_Pos_RRR": ({"a1": 0.0, "d3": 0.0, "a3": 0.0, "a2": 290.0},),
    "Kin_Scara3_CCZ": ({"link_length_2": 325.0},),
    "Kin_Scara4_ZCcoupled_Type1": ({"pitch_zc": 0.0}, {"link_length_2": 325.0}),
    "Kin_Scara4_CCZC_ZCcoupled": ({"flange_down": 0.0, "gear_coupling": 0.2, "pitch_zc": 0.0},),
    "Softkin_Palletizer": ({"shoulder_offset": 0.0, "wrist_offset_x": 0.0, "link_length_2": 300.0},),
    "Kin_SCCC": ({"link_length_3": 0.0}, {"link_length_2": 300.0, "coupling_12": 0.0, "coupling_13": 0.0}),
    "Kin_PCC": ({"link_length_2": 300.0},),
    "Kin_Wrist2": ({"tool_side": -1.0},),
    "Kin_5Axes": ({"tool_side": -1.0},),
    "Kin_GantryCutter3": ({"direction_r": -1.0},),
    "MC_KIN_TYPE_12_XY": ({"swap_xy": 1.0},),
    "Kin_Hexapod": ({"max_angle_base_joint": 35.0, "max_angle_platform_joint": 40.0},),
}  # fmt: skip
"""Further machines of some mechanisms, by what differs: equal links, nothing sideways, the other side."""

Part = tuple[str, Mapping[str, float]]
COUPLED: dict[str, tuple[Part, Part]] = {
    "Coupled_Gantry3_Wrist2": (("Kin_Gantry3", {}), ("Kin_Wrist2", DIMENSIONS["Kin_Wrist2"])),
    "Coupled_Delta_CAxis_Tool": (
        ("Kin_Delta_P3C_Type3", DIMENSIONS["Kin_Delta_P3C_Type3"]), ("Kin_CAxis_Tool", DIMENSIONS["Kin_CAxis_Tool"]),
    ),
    "Coupled_Scara3_CCZ_CAxis_Tool": (
        ("Kin_Scara3_CCZ", DIMENSIONS["Kin_Scara3_CCZ"]), ("Kin_CAxis_Tool", {"tool_z": -60.0}),
    ),
    "Coupled_Scara4_Tool": (
        ("Kin_Scara4_ZCcoupled_Type1", DIMENSIONS["Kin_Scara4_ZCcoupled_Type1"]), ("Kin_Tool", {"tool_z": -60.0}),
    ),
    "Coupled_Tripod_Tool": (("Kin_Tripod_P3Z", DIMENSIONS["Kin_Tripod_P3Z"]), ("Kin_Tool", DIMENSIONS["Kin_Tool"])),
    "Coupled_Pos_RRR_Wrist3": (("Kin_Pos_RRR", DIMENSIONS["Kin_Pos_RRR"]), ("Kin_Wrist3", {})),
    "Coupled_Polar_Z_Wrist2": (
        ("Kin_Polar_Z", {}), ("Kin_Wrist2", {"tool_length": 90.0, "roll_axis_offset_z": -40.0}),
    ),
}  # fmt: skip
