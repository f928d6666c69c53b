"""What a refused arm misses: amounts by which neighbouring axes do not meet or are not parallel, and tasks that fit.

The axes are those of the machine with its nominal lengths, at joint values of zero. How two neighbouring axes lie does
not depend on these values; a joint that is held is at zero.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import inf

import numpy as np
import sympy as sp

from derive.description.joints import Kind
from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning
from derive.geometry.frames import Factor, Motion
from derive.importing.arms.lines import Line, relation, spread
from derive.importing.robot import Array
from derive.ir.constants import DEGREE
from derive.kinematics.inverse import solve_pose
from derive.solver.unsolved import Unsolved

_SAME = 1e-9
"""Amounts below this share of the machine's size, or of one radian, are rounding."""
_NAMED = 2
"""The number of changes that a message names, the smallest first."""
_QUANTITIES = {Turning.PITCH_ROLL: 2, Turning.DIRECTION: 2, Turning.ABOUT_Z: 1, Turning.PITCH: 1, Turning.NONE: 0}
"""The number of quantities of the rotation that a task commands, the most first."""


def what_misses(mechanism: Mechanism) -> str:
    """The changes that would help, with joints and amounts; empty of a machine without three axes that turn."""
    lines, tip, size = _lines(mechanism)
    found = [change for three in zip(lines, lines[1:], lines[2:], strict=False) for change in _of_three(three, size)]
    if mechanism.task.turning is Turning.DIRECTION and lines:
        found.insert(0, _of_the_tool(*lines[-1], tip, size))
    exact = [is_so for share, is_so, _ in found if share < _SAME]
    near = sorted((share, wanted) for share, _, wanted in found if _SAME <= share < inf)
    known = f"{' and '.join(exact)}, which is not enough" if exact else ""
    wanted = ", or if ".join(words for _, words in near[:_NAMED])
    return "; ".join(part for part in (known, wanted and f"it would help if {wanted}") if part)


_Change = tuple[float, str, str]
"""The share of the size, or of one radian, by which a relation is missed; the words where it holds, and where not."""


def _of_three(three: Sequence[tuple[str, Line]], size: float) -> Iterator[_Change]:
    """Three neighbouring axes that are parallel, or meet in one point."""
    names, axes = ", ".join(name for name, _ in three), [line for _, line in three]
    if any(line.kind is Kind.LINEAR for line in axes):
        return
    angle = max(relation(*axes[:2]).angle, relation(*axes[1:]).angle)
    apart = spread(axes)
    missed = f"which they miss by {np.degrees(angle):.3g}°"
    yield angle, f"the axes of {names} are parallel", f"the axes of {names} were parallel, {missed}"
    missed = f"which they miss by {apart:.4g}"
    yield apart / size, f"the axes of {names} meet in one point", f"the axes of {names} met in one point, {missed}"


def _of_the_tool(name: str, last: Line, tip: Array, size: float) -> _Change:
    """The line of the tool, of a task that commands its direction, and the last axis."""
    apart = relation(last, Line(Kind.ROTARY, tip[:3, 3], tip[:3, 2], ())).distance
    line = "the line of the tool, through its point,"
    return (
        apart / size,
        f"{line} meets the axis of {name}",
        f"{line} met the axis of {name}, which it misses by {apart:.4g}",
    )


def fitting_task(mechanism: Mechanism) -> str:
    """Another task for which these joints are solved, the last of them held where it commands fewer quantities; in
    words, empty if none is found.
    """
    joints = mechanism.solved_joints
    for turning, commanded in _QUANTITIES.items():
        left = len(joints) - 3 - commanded
        if left < 0 or turning is mechanism.task.turning:
            continue
        held = (*mechanism.held, *joints[len(joints) - left :])
        try:
            solve_pose(replace(mechanism, task=Task("xyz", turning), branches=(), held=held))
        except (Unsolved, DescriptionError):
            continue
        names = ", ".join(j.name for j in held) + "," * (len(held) == 1)
        held_too = f", held=({names})" if held else ""
        return f'with task=Task("xyz", Turning.{turning.name}){held_too} these joints are solved'
    return ""


def _lines(mechanism: Mechanism) -> tuple[list[tuple[str, Line]], Array, float]:
    """The axes of the joints that are solved for, with their names, the pose of the tip, and the machine's size."""
    assert mechanism.chain is not None
    values: dict[sp.Symbol, object] = {p.symbol: p.nominal for p in mechanism.parameters} | {DEGREE: float(np.pi / 180)}
    joints = {j.symbol: j for j in mechanism.solved_joints}
    frame, size = np.eye(4), 0.0
    found: dict[str, Line] = {}
    for factor in mechanism.chain.factors:
        for symbol in sorted(factor.amount.free_symbols & joints.keys(), key=str):
            kind = Kind.ROTARY if factor.motion is Motion.TURN else Kind.LINEAR
            found[joints[symbol].name] = Line(kind, frame[:3, 3].copy(), frame[:3, factor.axis].copy(), ())
        still = dict.fromkeys(factor.amount.free_symbols - values.keys(), 0.0)
        amount = float(factor.amount.xreplace({**values, **still}))
        size += abs(amount) if factor.motion is Motion.SHIFT else 0.0
        frame = frame @ np.array(Factor(factor.motion, factor.axis, sp.Float(amount)).matrix(), dtype=float)
    return list(found.items()), frame, size or 1.0
