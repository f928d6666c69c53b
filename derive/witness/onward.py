"""All solutions of a searched arm, one after the other: the next one ahead around the circle, as `inverse_all` asks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array, run
from derive.ir.program import Status
from derive.ir.symbols import branch_sign
from derive.kinematics.kinematics import Kinematics

_BEGIN = 2.6
"""How far ahead of the reference (radians) the way around begins."""
_AHEAD, _LONGEST = 1e-7, 0.5
"""A root that follows another stands so far ahead; the longest step where every joint value is a root (radians)."""
_TWIN = "twin"
"""The output that says whether a second solution stands at the same root; with those that begin with it."""
_MOST = 24
"""More solutions than an arm has."""


def every_root(kin: Kinematics, given: Mapping[str, Array]) -> tuple[Array, NDArray[np.bool_]]:
    """Axis values (solutions, rows, axes), and whether there is such a solution. All sides are asked for at once.

    given: the inputs of the inverse, besides the sides of branches.
    """
    assert kin.search_given is not None and kin.from_joints is not None
    find = next(program for program in kin.shared if program.name == "find_root")
    count = len(given["x"])
    values = dict(given) | {branch_sign(b.name).name: np.zeros(count) for b in kin.branches}
    values |= run(kin.search_given, values)[0] | {"onward": np.ones(count, dtype=bool)}
    at, left = values["start"] + _BEGIN, np.full(count, 2.0 * np.pi - _AHEAD)
    going, skip = np.ones(count, dtype=bool), np.zeros(count)
    axes: list[Array] = []
    answers: list[NDArray[np.bool_]] = []
    while going.any() and len(axes) < 2 * _MOST:
        found, _ = run(find, {**values, "start": at})
        left = left - (found["away"] if axes else 0.0)
        going &= found["found"].astype(bool) & (left > 0.0)
        follows = (found["away"] < 1.1 * _AHEAD) & bool(axes)  # roots without end: the arm moves while its tool rests
        skip = np.where(follows, np.clip(4.0 * skip, _AHEAD, _LONGEST), 0.0)
        at, left = at + found["away"] + skip, left - skip
        is_new = going & ~follows
        both = {"found": is_new} | ({_TWIN: is_new & found[_TWIN].astype(bool)} if _TWIN in found else {})
        for word, are in both.items():
            joints = {j.symbol.name: found[f"{word}_{j.symbol.name}"] for j in kin.mechanism.joints}
            outputs, status = run(kin.from_joints, {**values, **joints})
            axes.append(np.stack([outputs[j.axis.name] for j in kin.mechanism.joints], axis=1))
            answers.append(np.asarray(are & (status == Status.OK), dtype=bool))
    return np.stack(axes), np.stack(answers)
