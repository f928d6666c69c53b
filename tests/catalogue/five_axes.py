"""Forward kinematics of five-axis machines, written by hand: see `hand_written`."""

from collections.abc import Mapping, Sequence
from functools import reduce

import numpy as np

from tests.catalogue.closure import Array

Pose = tuple[Array, Array, Array, Array | tuple[tuple[Array, ...], ...]]


def gantry_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
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


def five_axes(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The azimuth turns the inclination: the tool along +Z, or along -Z, goes to +X with a positive inclination."""
    side, a, b = p["tool_side"], q[3], q[4]
    ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), side * np.sin(b)
    rotation = ((ca * cb, -sa, ca * sb), (sa * cb, ca, sa * sb), (-sb, 0 * a, cb))
    reach = side * p["tool_length"]
    return q[0] + reach * ca * sb, q[1] + reach * sa * sb, q[2] + reach * cb, rotation


def table_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The trunnion turns the workpiece from Y to Z, the table on it from X to Y: the tool seen from there."""
    ca, sa, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    tip = q[2] - p["tool_length"]
    y, z = ca * q[1] + sa * tip - p["pivot_y"], ca * tip - sa * q[1] - p["pivot_z"]
    rotation = ((cc, sc * ca, sc * sa), (-sc, cc * ca, cc * sa), (0 * sa, -sa, ca))
    return cc * q[0] + sc * y, cc * y - sc * q[0], z, rotation


def head_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The head leans to +X, the table turns the workpiece from X to Y."""
    cb, sb, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    x = q[0] + p["head_offset"] * cb - p["pivot_length"] * sb
    z = q[2] - p["head_offset"] * sb - p["pivot_length"] * cb
    rotation = ((cc * cb, sc, cc * sb), (-sc * cb, cc, -sc * sb), (-sb, 0 * sb, cb))
    return cc * x + sc * q[1], cc * q[1] - sc * x, z, rotation


def head_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The fork turns the head about Z, the head leans."""
    cc, sc, cb, sb = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    ahead = p["fork_offset"] + p["head_offset"] * cb - p["pivot_length"] * sb
    z = q[2] - p["head_offset"] * sb - p["pivot_length"] * cb
    rotation = ((cc * cb, -sc, cc * sb), (sc * cb, cc, sc * sb), (-sb, 0 * sb, cb))
    return q[0] + cc * ahead, q[1] + sc * ahead, z, rotation


def head_table_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The head leans to -Y, the table turns the workpiece from X to Y."""
    ca, sa, cc, sc = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    y = q[1] + p["head_offset"] * ca + p["pivot_length"] * sa
    z = q[2] + p["head_offset"] * sa - p["pivot_length"] * ca
    rotation = ((cc, sc * ca, -sc * sa), (-sc, cc * ca, -cc * sa), (0 * sa, sa, ca))
    return cc * q[0] + sc * y, cc * y - sc * q[0], z, rotation


def head_head_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    """The fork turns the head about Z, the head leans to -Y."""
    cc, sc, ca, sa = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    ahead = p["fork_offset"] + p["head_offset"] * ca + p["pivot_length"] * sa
    z = q[2] + p["head_offset"] * sa - p["pivot_length"] * ca
    rotation = ((cc, -sc * ca, sc * sa), (sc, cc * ca, -cc * sa), (0 * sa, sa, ca))
    return q[0] - sc * ahead, q[1] + cc * ahead, z, rotation


def table_table_b(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
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


def nutating_head(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _forked(p, q, _inclined(p), np.eye(3)[0])


def nutating_head_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _forked(p, q, _leaning_x(p), np.eye(3)[1])


def _forked(p: Mapping[str, float], q: Sequence[Array], axis: Sequence[float], across: Array) -> Pose:
    """The offsets of the fork and of the head are across its axis."""
    fork, head = _about((0, 0, 1), q[3]), _about(axis, q[4])
    arm = np.einsum("ij...,j->i...", head, across * p["head_offset"] - (0, 0, p["pivot_length"]))
    tip = np.einsum("ij...,j...->i...", fork, arm + np.multiply.outer(across * p["fork_offset"], np.ones_like(q[3])))
    return q[0] + tip[0], q[1] + tip[1], q[2] + tip[2], tuple(map(tuple, _product(fork, head)))


def nutating_head_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
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


def nutating_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, _inclined(p))


def nutating_table_a(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, _leaning_x(p))


def dual_table(p: Mapping[str, float], q: Sequence[Array]) -> Pose:
    return _two_tables(p, q, (1, 0, 0), (0, 1, 0))
