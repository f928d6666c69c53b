"""Forward kinematics written by hand, as the literature prints it: independent of the descriptions.

Each function takes parameters and motor values (axis value less offset, in radians and lengths), and gives
x, y, z and the turn of the flange about z, or its whole rotation, entry by entry.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from tests.catalogue.closure import Array
from tests.catalogue.five_axes import tool

Pose = tuple[Array, Array, Array, Array | tuple[Array, ...] | tuple[tuple[Array, ...], ...]]
Formula = Callable[[Mapping[str, float], Sequence[Array]], Pose]
TURN = 2 * np.pi


def _of_order(head: str, table: str) -> Formula:
    """A five-axis machine with these turning axes in its head and in its table."""

    def formula(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
        tips, rotations = tool(head, table, p, np.asarray(q))
        return *tips.T, tuple(np.moveaxis(rotations, 0, 2))

    return formula


def _gantry_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """Turns about y, the turned x and the flange's z, multiplied out."""
    b, a, c = q[3:]
    (ca, cb, cc), (sa, sb, sc) = ([f(v) for v in (a, b, c)] for f in (np.cos, np.sin))
    rotation = (
        (cb * cc + sb * sa * sc, sb * sa * cc - cb * sc, sb * ca),
        (ca * sc, ca * cc, -sa),
        (cb * sa * sc - sb * cc, sb * sc + cb * sa * cc, cb * ca),
    )
    flange = [p[f"flange_{w}"] for w in "xyz"]
    return *(q[i] + sum(r * o for r, o in zip(rotation[i], flange, strict=True)) for i in range(3)), rotation


def _five_axes(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The azimuth turns the inclination: the tool along +Z, or along -Z, goes to +X with a positive inclination."""
    side, a, b = p["tool_side"], q[3], q[4]
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), side * np.sin(b)
    rotation = ((ca * cb, -sa, ca * sb), (sa * cb, ca, sa * sb), (-sb, 0 * a, cb))
    reach = side * p["tool_length"]
    return q[0] + reach * ca * sb, q[1] + reach * sa * sb, q[2] + reach * cb, rotation


def _arms(lengths: Sequence[float], angles: Sequence[Array]) -> tuple[Array, Array]:
    """Links one after the other at absolute angles."""
    x = sum(length * np.cos(angle) for length, angle in zip(lengths, angles, strict=True))
    y = sum(length * np.sin(angle) for length, angle in zip(lengths, angles, strict=True))
    return x, y


def _scara4(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    x, y = _arms((p["link_length_1"], p["link_length_2"]), (q[0], q[0] + q[1]))
    climb = -p["pitch_zc"] / TURN + p.get("gear_coupling", 0.0) * 180.0 / np.pi
    return x, y, q[2] + climb * q[3], q[0] + q[1] + q[3]


def _scara_on_rail(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    x, y = _arms((p["link_length_1"], p["link_length_2"]), (q[1], q[1] + q[2]))
    return q[0] + x, y, q[3], q[1] + q[2] + q[4]


def _scara3(word: str) -> Formula:
    def formula(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
        x, y = _arms((p[f"{word}_length_1"], p[f"{word}_length_2"]), (q[0], q[0] + q[1]))
        return x, y, q[2], q[0] + q[1]

    return formula


def _scara3_z(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    angles = (q[0], q[0] + q[1], q[0] + q[1] + q[2])
    x, y = _arms([p[f"arm_length_{k}"] for k in (1, 2, 3)], angles)
    return x, y, q[3], angles[2]


def _zccc(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    angles = (q[1], q[1] + q[2], q[1] + q[2] + q[3])
    x, y = _arms([p[f"link_length_{k}"] for k in (1, 2, 3)], angles)
    return x, y, q[0], angles[2]


def _sccc(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    first = q[0]
    second = first + q[1] + p["coupling_12"] * q[0]
    third = second + q[2] + p["coupling_13"] * q[0] + p["coupling_23"] * q[1]
    x, y = _arms([p[f"link_length_{k}"] for k in (1, 2, 3)], (first, second, third))
    return x, y, 0 * x, third


def _pcc(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    x, y = _arms((p["link_length_1"], p["link_length_2"]), q)
    return x, y, 0 * x, 0 * x


def _crane(_: Mapping[str, float], q: Sequence[Array]) -> Pose:
    r, theta, phi = q
    return r * np.sin(phi) * np.cos(theta), r * np.sin(phi) * np.sin(theta), r * np.cos(phi), 0 * r


def _polar(_: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return q[1] * np.cos(q[0]), q[1] * np.sin(q[0]), q[2] if len(q) > 2 else 0 * q[0], q[0]


def _carriage(x: Sequence[float], y: Sequence[float]) -> Formula:
    """Two drives move a carriage; a third axis, where there is one, lifts."""

    def formula(_: Mapping[str, float], q: Sequence[Array]) -> Pose:
        a, b = q[0], q[1]
        return x[0] * a + x[1] * b, y[0] * a + y[1] * b, q[2] if len(q) > 2 else 0 * a, 0 * a

    return formula


def _cutter(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return q[0], q[1], q[2] if len(q) > 3 else 0 * q[0], p["direction_r"] * q[-1]


def _three_parallel(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """Entry by entry, as papers on these arms print it."""
    (c1, c5, c6), (s1, s5, s6) = ([f(q[i]) for i in (0, 4, 5)] for f in (np.cos, np.sin))
    sums = (q[1], q[1] + q[2], q[1] + q[2] + q[3])
    (c2, c23, c), (s2, s23, s) = ([f(v) for v in sums] for f in (np.cos, np.sin))
    across = -(p["d4"] + p["d6"] * c5)
    along = p["a2"] * c2 + p["a3"] * c23 + p["d5"] * s - p["d6"] * s5 * c
    z = p["d1"] + p["a2"] * s2 + p["a3"] * s23 - p["d5"] * c - p["d6"] * s5 * s
    rotation = (
        (
            c6 * (s1 * s5 + c1 * c5 * c) - c1 * s6 * s,
            -s6 * (s1 * s5 + c1 * c5 * c) - c1 * c6 * s,
            c5 * s1 - c1 * s5 * c,
        ),
        (
            c6 * (s1 * c5 * c - c1 * s5) - s1 * s6 * s,
            s6 * (c1 * s5 - s1 * c5 * c) - s1 * c6 * s,
            -c1 * c5 - s1 * s5 * c,
        ),
        (c5 * c6 * s + s6 * c, c6 * c - c5 * s6 * s, -s5 * s),
    )
    return along * c1 - across * s1, along * s1 + across * c1, z, rotation


def _arm(p: Mapping[str, float], q: Sequence[Array]) -> tuple[Array, Array]:
    """An articulated arm in its plane: the wrist centre, and the frame of the forearm, rows of vectors."""
    o, one = 0 * q[0], 0 * q[0] + 1
    radial, sideways = np.array([np.cos(q[0]), np.sin(q[0]), o]), np.array([np.sin(q[0]), -np.cos(q[0]), o])
    up = np.array([o, o, one])
    lean, tilt = q[1], q[1] + q[2]
    out, high = -np.sin(tilt) * radial + np.cos(tilt) * up, np.cos(tilt) * radial + np.sin(tilt) * up
    shoulder = p["a1"] * radial + p["d1"] * up
    wrist = (
        shoulder
        + p["a2"] * (np.cos(lean) * up - np.sin(lean) * radial)
        + p["d3"] * sideways
        + p["a3"] * out
        + p["d4"] * high
    )
    return wrist, np.array([out, sideways, high])


def _pos_rrr(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    wrist, frame = _arm(p, q)
    return *wrist, tuple(tuple(frame[j, i] for j in range(3)) for i in range(3))


def _articulated(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    wrist, (x, y, z) = _arm(p, q)
    c4, s4, c5, s5, c6, s6 = (f(q[i]) for i in (3, 4, 5) for f in (np.cos, np.sin))
    towards = -c4 * s5 * x - s4 * s5 * y + c5 * z
    first = (c4 * c5 * c6 - s4 * s6) * x + (s4 * c5 * c6 + c4 * s6) * y + s5 * c6 * z
    second = -(c4 * c5 * s6 + s4 * c6) * x + (c4 * c6 - s4 * c5 * s6) * y - s5 * s6 * z
    return *(wrist + p["d6"] * towards), tuple(zip(first, second, towards, strict=True))


def _palletizer(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """Both arms by their angles against the base; the flange is level."""
    ahead = p["shoulder_offset"] + p["link_length_1"] * np.sin(q[1]) + p["link_length_2"] * np.cos(q[2])
    ahead = ahead + p["wrist_offset_x"]
    z = p["base_height"] + p["link_length_1"] * np.cos(q[1]) - p["link_length_2"] * np.sin(q[2]) + p["wrist_offset_z"]
    return ahead * np.cos(q[0]), ahead * np.sin(q[0]), z, q[0] + q[3]


def _tilting_palletizer(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The tool leaves the vertical by the tilt, in the direction of the flange."""
    x, y, z, heading = _palletizer(p, q)
    c, s, upright, aside = np.cos(heading), np.sin(heading), np.cos(q[4]), np.sin(q[4])
    rotation = ((c * upright, -s, c * aside), (s * upright, c, s * aside), (-aside, 0 * s, upright))
    reach = p["tool_length"]
    return x + reach * c * aside, y + reach * s * aside, z + reach * upright, rotation


def _face(_: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The part turns from X to Y: the tool, seen from it, the other way."""
    return q[0] * np.cos(q[2]), -q[0] * np.sin(q[2]), q[1], -q[2]


def _mantle(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The part turns from X to Y: its mantle passes the tool the other way."""
    return q[0] - p["radius"], -p["radius"] * q[1], q[2], 0 * q[1]


def _skew(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    angle = np.radians(p["skew"])
    return q[0] + q[1] * np.cos(angle), q[1] * np.sin(angle), q[2], 0 * q[0]


def _swivel(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The tool on a cylinder about axis A1."""
    return p["arm_length"] * np.cos(q[0]), p["arm_length"] * np.sin(q[0]), q[1], q[0] + q[2]


CARTESIAN = _carriage((1, 0), (0, 1))
H_BOT = _carriage((0.5, -0.5), (0.5, 0.5))
H_GANTRY = _carriage((0.5, -0.5), (-0.5, -0.5))
T_GANTRY = _carriage((0.5, 0.5), (-0.5, 0.5))
FORMULAS: dict[str, Formula] = {
    "Kin_5Axes": _five_axes,
    "Softkin_HeadHead_CA": _of_order("CA", ""),
    "Softkin_HeadHead_CB": _of_order("CB", ""),
    "Softkin_HeadTable_AC": _of_order("A", "C"),
    "Softkin_HeadTable_BC": _of_order("B", "C"),
    "Softkin_NutatingHead_CA": _of_order("CA", ""),
    "Softkin_NutatingHead_CB": _of_order("CB", ""),
    "Softkin_NutatingTable_BC": _of_order("", "BC"),
    "Softkin_NutatingHeadTable_BC": _of_order("B", "C"),
    "Softkin_NutatingTable_AC": _of_order("", "AC"),
    "Softkin_Palletizer": _palletizer,
    "Softkin_Palletizer5": _tilting_palletizer,
    "Softkin_ScaraOnRail": _scara_on_rail,
    "Softkin_SkewGantry3": _skew,
    "Softkin_SwivelArm": _swivel,
    "Softkin_TableTable_AB": _of_order("", "AB"),
    "Softkin_TableTable_AC": _of_order("", "AC"),
    "Softkin_TableTable_BC": _of_order("", "BC"),
    "Softkin_Tracyl": _mantle,
    "Softkin_Transmit": _face,
    "Kin_Ac6_TXTYTZRYRXRZ": _gantry_head,
    "Kin_Ac6_ThreeParallel": _three_parallel,
    "Kin_ArticulatedRobot_6DOF": _articulated,
    "Kin_Crane": _crane,
    "Kin_Gantry2": CARTESIAN,
    "Kin_Gantry3": CARTESIAN,
    "Kin_GantryCutter2": _cutter,
    "Kin_GantryCutter3": _cutter,
    "Kin_HGantry2": H_GANTRY,
    "Kin_HGantry3": H_GANTRY,
    "Kin_P2Y": H_BOT,
    "Kin_PCC": _pcc,
    "Kin_Polar": _polar,
    "Kin_Polar_Z": _polar,
    "Kin_Pos_RRR": _pos_rrr,
    "Kin_SCCC": _sccc,
    "Kin_Scara2_Z": _scara3("arm"),
    "Kin_Scara3_CCZ": _scara3("link"),
    "Kin_Scara3_Z": _scara3_z,
    "Kin_Scara3_ZCCC": _zccc,
    "Kin_Scara4_CCZC_ZCcoupled": _scara4,
    "Kin_Scara4_ZCCC": _zccc,
    "Kin_Scara4_ZCcoupled_Type1": _scara4,
    "Kin_TGantry2": T_GANTRY,
    "Kin_TGantry3": T_GANTRY,
}
