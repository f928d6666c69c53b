"""Forward kinematics written by hand, as the literature prints it: independent of the descriptions.

Each function takes parameters and motor values (axis value less offset, in radians and lengths), and gives
x, y, z and the turn of the flange about z, or its whole rotation, entry by entry.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce

import numpy as np

from tests.catalogue.closure import Array

Pose = tuple[Array, Array, Array, Array | tuple[tuple[Array, ...], ...]]
Formula = Callable[[Mapping[str, float], Sequence[Array]], Pose]
TURN = 2 * np.pi


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


def _table_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The trunnion turns the workpiece from Y to Z, the table on it from X to Y: the tool seen from there."""
    ca, sa, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    tip = q[2] - p["tool_length"]
    y, z = ca * q[1] + sa * tip - p["pivot_y"], ca * tip - sa * q[1] - p["pivot_z"]
    rotation = ((cc, sc * ca, sc * sa), (-sc, cc * ca, cc * sa), (0 * sa, -sa, ca))
    return cc * q[0] + sc * y, cc * y - sc * q[0], z, rotation


def _palletizer(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """Both arms by their angles against the base; the flange is level."""
    ahead = p["shoulder_offset"] + p["link_length_1"] * np.sin(q[1]) + p["link_length_2"] * np.cos(q[2])
    ahead = ahead + p["wrist_offset_x"]
    z = p["base_height"] + p["link_length_1"] * np.cos(q[1]) - p["link_length_2"] * np.sin(q[2]) + p["wrist_offset_z"]
    return ahead * np.cos(q[0]), ahead * np.sin(q[0]), z, q[0] + q[3]


def _head_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The head leans to +X, the table turns the workpiece from X to Y."""
    cb, sb, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    x = q[0] + p["head_offset"] * cb - p["pivot_length"] * sb
    z = q[2] - p["head_offset"] * sb - p["pivot_length"] * cb
    rotation = ((cc * cb, sc, cc * sb), (-sc * cb, cc, -sc * sb), (-sb, 0 * sb, cb))
    return cc * x + sc * q[1], cc * q[1] - sc * x, z, rotation


def _head_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The fork turns the head about Z, the head leans."""
    cc, sc, cb, sb = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    ahead = p["fork_offset"] + p["head_offset"] * cb - p["pivot_length"] * sb
    z = q[2] - p["head_offset"] * sb - p["pivot_length"] * cb
    rotation = ((cc * cb, -sc, cc * sb), (sc * cb, cc, sc * sb), (-sb, 0 * sb, cb))
    return q[0] + cc * ahead, q[1] + sc * ahead, z, rotation


def _head_table_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The head leans to -Y, the table turns the workpiece from X to Y."""
    ca, sa, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    y = q[1] + p["head_offset"] * ca + p["pivot_length"] * sa
    z = q[2] + p["head_offset"] * sa - p["pivot_length"] * ca
    rotation = ((cc, sc * ca, -sc * sa), (-sc, cc * ca, -cc * sa), (0 * sa, sa, ca))
    return cc * q[0] + sc * y, cc * y - sc * q[0], z, rotation


def _head_head_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The fork turns the head about Z, the head leans to -Y."""
    cc, sc, ca, sa = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    ahead = p["fork_offset"] + p["head_offset"] * ca + p["pivot_length"] * sa
    z = q[2] + p["head_offset"] * sa - p["pivot_length"] * ca
    rotation = ((cc, -sc * ca, sc * sa), (sc, cc * ca, -cc * sa), (0 * sa, sa, ca))
    return q[0] - sc * ahead, q[1] + cc * ahead, z, rotation


def _table_table_b(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The trunnion turns the workpiece from Z to X, the table on it from X to Y: the tool seen from there."""
    cb, sb, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    tip = q[2] - p["tool_length"]
    x, z = cb * q[0] - sb * tip - p["pivot_x"], cb * tip + sb * q[0] - p["pivot_z"]
    rotation = ((cc * cb, sc, -cc * sb), (-sc * cb, cc, sc * sb), (sb, 0 * sb, cb))
    return cc * x + sc * q[1], cc * q[1] - sc * x, z, rotation


def _about(axis: Sequence[float], angle: Array) -> Array:
    """Rodrigues: the rotation about a unit vector, entry by entry."""
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    c, s = np.cos(angle), np.sin(angle)
    return (
        np.multiply.outer(np.eye(3), c) + np.multiply.outer(cross, s) + np.multiply.outer(np.outer(axis, axis), 1 - c)
    )


def _inclined(p: Mapping[str, float]) -> tuple[float, float, float]:
    return 0.0, float(np.sin(np.radians(p["nutation"]))), float(np.cos(np.radians(p["nutation"])))


def _product(*turns: Array) -> Array:
    """Rotations, entry by entry, one after the other."""
    return reduce(lambda a, b: np.einsum("ij...,jk...->ik...", a, b), turns)


def _leaning_x(p: Mapping[str, float]) -> tuple[float, float, float]:
    return _inclined(p)[1], 0.0, _inclined(p)[2]


def _nutating_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _forked(p, q, _inclined(p), np.eye(3)[0])


def _nutating_head_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _forked(p, q, _leaning_x(p), np.eye(3)[1])


def _forked(p: Mapping[str, float], q: Sequence[Array], axis: Sequence[float], across: Array) -> Pose:
    """The offsets of the fork and of the head are across its axis."""
    fork, head = _about((0, 0, 1), q[3]), _about(axis, q[4])
    arm = np.einsum("ij...,j->i...", head, across * p["head_offset"] - (0, 0, p["pivot_length"]))
    tip = np.einsum("ij...,j...->i...", fork, arm + np.multiply.outer(across * p["fork_offset"], np.ones_like(q[3])))
    return q[0] + tip[0], q[1] + tip[1], q[2] + tip[2], tuple(map(tuple, _product(fork, head)))


def _nutating_head_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    head, table = _about(_inclined(p), q[3]), _about((0, 0, 1), -q[4])
    tip = np.einsum("ij...,j->i...", head, [p["head_offset"], 0, -p["pivot_length"]])
    place = np.einsum("ij...,j...->i...", table, np.array([tip[k] + q[k] for k in range(3)]))
    return *place, tuple(map(tuple, _product(table, head)))


def _two_tables(
    p: Mapping[str, float], q: Sequence[Array], outer: Sequence[float], inner: Sequence[float] = (0, 0, 1)
) -> Pose:
    """Tables one on the other, each turned back about its axis."""
    carrier, table = _about(outer, -q[3]), _about(inner, -q[4])
    tip = np.einsum("ij...,j...->i...", carrier, np.array([q[0], q[1], q[2] - p["tool_length"]]))
    tip = np.array([tip[k] - p.get(f"pivot_{c}", 0.0) for k, c in enumerate("xyz")])
    return *np.einsum("ij...,j...->i...", table, tip), tuple(map(tuple, _product(table, carrier)))


def _nutating_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, _inclined(p))


def _nutating_table_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, _leaning_x(p))


def _dual_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, (1, 0, 0), (0, 1, 0))


def _face(_: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The part turns from X to Y: the tool, seen from it, the other way."""
    return q[0] * np.cos(q[2]), -q[0] * np.sin(q[2]), q[1], -q[2]


def _mantle(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The part turns from X to Y: its mantle passes the tool the other way."""
    return q[0] - p["radius"], -p["radius"] * q[1], q[2], 0 * q[1]


def _skew(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    angle = np.radians(p["skew"])
    return q[0] + q[1] * np.cos(angle), q[1] * np.sin(angle), q[2], 0 * q[0]


CARTESIAN = _carriage((1, 0), (0, 1))
H_BOT = _carriage((0.5, -0.5), (0.5, 0.5))
H_GANTRY = _carriage((0.5, -0.5), (-0.5, -0.5))
T_GANTRY = _carriage((0.5, 0.5), (-0.5, 0.5))
FORMULAS: dict[str, Formula] = {
    "Kin_5Axes": _five_axes,
    "Softkin_HeadHead_CA": _head_head_a,
    "Softkin_HeadHead_CB": _head_head,
    "Softkin_HeadTable_AC": _head_table_a,
    "Softkin_HeadTable_BC": _head_table,
    "Softkin_NutatingHead_CA": _nutating_head_a,
    "Softkin_NutatingHead_CB": _nutating_head,
    "Softkin_NutatingTable_BC": _nutating_table,
    "Softkin_NutatingHeadTable_BC": _nutating_head_table,
    "Softkin_NutatingTable_AC": _nutating_table_a,
    "Softkin_Palletizer": _palletizer,
    "Softkin_ScaraOnRail": _scara_on_rail,
    "Softkin_SkewGantry3": _skew,
    "Softkin_TableTable_AB": _dual_table,
    "Softkin_TableTable_AC": _table_table,
    "Softkin_TableTable_BC": _table_table_b,
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
