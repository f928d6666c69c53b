"""How a frame moves with each deviation: the twist of the tool, per degree, unit of length, or one of a gain.

Of a serial machine it follows from the frames that its chain passes. A joint that moves by D M D^-1 moves the tool by
the motion of D, less the motion of D after M. Of a closed loop it is found by differences of its forward kinematics.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from softkin._calibrated import bare_of, ends_of
from softkin._chain import Chain, Placed, columns, moved_along, passed, true_chain, true_ends
from softkin._core import Mechanism
from softkin._deviations import units_of
from softkin._scalar import DEGREE
from softkin._start import IterativeForward

Array: TypeAlias = NDArray[np.float64]
_STEP = 1e-4
"""The step of differences, in degrees and lengths; of a gain a hundredth of it."""


class Model(NamedTuple):
    """The frames of a machine at N rows of axis values, and how they move."""

    positions: Array
    """(N, 3)."""
    rotations: Array
    """(N, 3, 3)."""
    twists: Array
    """(N, 6, m): lengths, then radians, for each of m deviations."""


def model(nominal: Mechanism, deviations: Mapping[str, float], names: Sequence[str], axes: Array) -> Model:
    """The machine with deviations, and its twists by some of them. nominal: in degrees, without deviations."""
    if bare_of(nominal)._chain() is None:
        return _by_differences(nominal, deviations, names, axes)
    bare, (base, tool) = bare_of(nominal), ends_of(nominal)
    chain, zeros = true_chain(bare, deviations, base, tool), bare._axis_zeros()
    units = [DEGREE if axis.unit == "deg" else 1.0 for axis in nominal.AXES]
    keys = [axis.name.lower().replace(" ", "_") for axis in nominal.AXES]
    plain = [u * (a - z) for u, a, z in zip(units, axes.T, zeros, strict=True)]
    motors = [
        m * (1.0 + deviations.get(f"{k}_gain", 0.0)) + u * deviations.get(f"{k}_offset", 0.0)
        for m, u, k in zip(plain, units, keys, strict=True)
    ]
    end, lines = passed(chain, motors, np.cos, np.sin)
    place = _stacked(end, len(axes))
    if not names:
        return Model(*place, np.zeros((len(axes), 6, 0)))
    found: dict[str, Array] = {}
    for key, unit, motor, column in zip(keys, units, plain, columns(chain, lines, end[0], len(keys)), strict=True):
        moved = np.stack([np.broadcast_to(entry, len(axes)) for entry in column], axis=1)
        found[f"{key}_offset"], found[f"{key}_gain"] = unit * moved, motor[:, None] * moved
    _add_lines(found, chain, lines, motors, place[0], deviations)
    _add_ends(found, (base, tool), deviations, place)
    return Model(*place, np.stack([found[name] for name in names], axis=2))


def _add_lines(
    found: dict[str, Array], chain: Chain, lines: Sequence[Placed], motors: Sequence[Any], tip: Array,
    deviations: Mapping[str, float],
) -> None:  # fmt: skip
    """The tilts and shifts of every joint."""
    for joint, line in zip(chain.joints, lines, strict=True):
        amount = sum(share * motors[i] for i, share in joint.motors)
        after = moved_along(line, joint.turns, amount, np.cos, np.sin)
        frames = [_stacked(one, len(tip)) for one in (line, after)]
        x, y = (DEGREE * deviations.get(f"{joint.name}_tilt_{k}", 0.0) for k in "xy")
        shifts = _turn((1, -y)) @ _turn((0, -x))
        ways = {
            "tilt_x": (True, DEGREE * _turn((1, -y))[:, 0]),
            "tilt_y": (True, DEGREE * np.array([0.0, 1.0, 0.0])),
            "shift_x": (False, shifts[:, 0]),
            "shift_y": (False, shifts[:, 1]),
        }
        for way, (turns, along) in ways.items():
            before, moved = (_twist(frame, turns, along, tip) for frame in frames)
            found[f"{joint.name}_{way}"] = before - moved


def _add_ends(
    found: dict[str, Array], ends: tuple[Placed, Placed], deviations: Mapping[str, float], place: tuple[Array, Array]
) -> None:
    """The shifts and turns of base and tool."""
    count, (positions, rotations) = len(place[0]), place
    (_, of_tool), (base, tool) = true_ends(deviations), ends
    total = _matrix(of_tool) @ _matrix(tool)
    flange = rotations @ total[:3, :3].T
    starts = {
        "base": _stacked(base, count),
        "tool": (positions - flange @ total[:3, 3], flange),
    }
    for end, (origin, rotation) in starts.items():
        x, y, z, b, c = (deviations.get(f"{end}_{k}", 0.0) for k in "xyzbc")
        pivot = origin + rotation @ np.array([x, y, z])
        about_c = _turn((2, DEGREE * c))
        turns = {"a": (about_c @ _turn((1, DEGREE * b)))[:, 0], "b": about_c[:, 1], "c": np.array([0.0, 0.0, 1.0])}
        for k, letter in enumerate("xyz"):
            found[f"{end}_{letter}"] = _twist((pivot, rotation), False, np.eye(3)[k], positions)
        for letter, along in turns.items():
            found[f"{end}_{letter}"] = _twist((pivot, rotation), True, DEGREE * along, positions)


def _twist(frame: tuple[Array, Array], turns: bool, along: Array, tip: Array) -> Array:
    """The twist (N, 6) of the tip of a body that turns about, or slides along, a direction of a frame."""
    direction = frame[1] @ along
    if not turns:
        return np.concatenate([direction, np.zeros_like(direction)], axis=1)
    return np.concatenate([np.cross(direction, tip - frame[0]), direction], axis=1)


def _stacked(frame: Placed, count: int) -> tuple[Array, Array]:
    """Columns as arrays (N, 3) and (N, 3, 3)."""
    position, rotation = frame
    entries = [np.broadcast_to(entry, count) for row in rotation for entry in row]
    place = [np.broadcast_to(entry, count) for entry in position]
    return np.stack(place, axis=1), np.stack(entries, axis=1).reshape(count, 3, 3)


def _matrix(frame: Placed) -> Array:
    found = np.eye(4)
    found[:3, 3], found[:3, :3] = frame
    return found


def _turn(turn: tuple[int, float]) -> Array:
    """A rotation about x (0), y (1) or z (2), in radians."""
    axis, amount = turn
    found, first, second = np.eye(3), (axis + 1) % 3, (axis + 2) % 3
    found[first, first] = found[second, second] = np.cos(amount)
    found[second, first], found[first, second] = np.sin(amount), -np.sin(amount)
    return found


def _by_differences(nominal: Mechanism, deviations: Mapping[str, float], names: Sequence[str], axes: Array) -> Model:
    """The same by central differences of forward kinematics, which starts at the frames where it iterates."""
    at = nominal.calibrated(deviations)
    positions, rotations, _, _ = at.forward_batch(axes)
    start = {"start": (positions, rotations)} if isinstance(at, IterativeForward) else {}
    units, twists = units_of(bare_of(nominal)), np.empty((len(axes), 6, len(names)))
    for k, name in enumerate(names):
        step = _STEP if units[name] != "1" else 0.01 * _STEP
        (p, r), (q, s) = (
            nominal.calibrated({**deviations, name: deviations.get(name, 0.0) + sign * step}).forward_batch(
                axes, **start
            )[:2]
            for sign in (1.0, -1.0)
        )
        turn = (r - s) @ rotations.transpose(0, 2, 1)
        twists[:, :3, k] = (p - q) / (2.0 * step)
        twists[:, 3:, k] = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1) / (2.0 * step)
    return Model(positions, rotations, twists)
