"""The part of a commanded pose that a chain can follow, and the joints that have to be held: by the rank of its
Jacobian."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, Line, moved, relation, spread
from derive.importing.robot import Array, UnreadableRobot

_SAMPLES = 6
_SMALL = 1e-9
_NEARLY = 1e-6
_WELL = 5e-3
"""A motion smaller than this share comes from axes that nearly meet, and is no reason to hold a joint."""


@dataclass(frozen=True)
class Followed:
    """The task as a description writes it (position, and the name of a `Turning`), and the joints that are held."""

    position: str
    turning: str
    held: tuple[int, ...] = ()
    facing: int = 2
    """The axis x, y or z (0, 1, 2) of the tip that is the direction of the tool, which a description calls z."""


@dataclass(frozen=True)
class Motions:
    """Jacobians of the tip at some joint values (samples x 6 x axes, lengths over the size), its rotations there."""

    jacobians: Array
    rotations: Array

    def rank(self, rows: slice = slice(0, 6), axes: Sequence[int] | None = None, least: float = 1e-7) -> int:
        """The rank of some rows at a general position; singular values below the least one count as zero."""
        chosen = self.jacobians[:, rows] if axes is None else self.jacobians[:, rows][:, :, list(axes)]
        return int(max(np.linalg.matrix_rank(j, tol=least) for j in chosen))

    def least(self, axes: Sequence[int]) -> float:
        """The least singular value with some axes, the mean of all samples."""
        return float(np.mean([np.linalg.svd(j[:, list(axes)], compute_uv=False)[-1] for j in self.jacobians]))

    def span(self, rows: slice) -> Array:
        """Directions (rows) that the motions of all samples span."""
        every = np.concatenate(list(self.jacobians[:, rows]), axis=1)
        left, sizes, _ = np.linalg.svd(every)
        return np.asarray(left[:, : int(np.sum(sizes > 1e-7))].T)


def motions(arm: Arm, count: int) -> Motions:
    """Jacobians at general joint values, which are always the same."""
    rng = np.random.default_rng(5)
    jacobians, rotations = [], []
    for _ in range(_SAMPLES):
        values = rng.uniform(0.3, 1.2, count) * rng.choice([-1.0, 1.0], count)
        sized = np.array([v * _unit(arm, k) for k, v in enumerate(values)])
        jacobian, frame = _jacobian(arm, sized)
        jacobians.append(jacobian)
        rotations.append(frame[:3, :3])
    return Motions(np.array(jacobians), np.array(rotations))


def _unit(arm: Arm, axis: int) -> float:
    """The size of a slide's values; 1 for an angle."""
    kinds = [line.kind for line in arm.lines for k, _ in line.drives if k == axis]
    return arm.size if Kind.LINEAR in kinds else 1.0


def _jacobian(arm: Arm, values: Array) -> tuple[Array, Array]:
    frame = np.eye(4)
    columns: list[tuple[Line, Array, Array]] = []
    for line in arm.lines:
        columns.append((line, frame[:3, :3] @ line.direction, (frame @ np.append(line.point, 1.0))[:3]))
        frame = frame @ moved(line, float(sum(values[k] * m for k, m in line.drives)))
    tip = (frame @ arm.tip)[:3, 3]
    size = arm.size
    jacobian = np.zeros((6, len(values)))
    for line, direction, point in columns:
        for axis, multiplier in line.drives:
            if line.kind is Kind.LINEAR:
                jacobian[:3, axis] += multiplier * direction * _unit(arm, axis) / size
            else:
                unit = multiplier * _unit(arm, axis)
                jacobian[:3, axis] += unit * np.cross(direction, tip - point) / size
                jacobian[3:, axis] += unit * direction
    return jacobian, frame @ arm.tip


def followed(arm: Arm, count: int, held: Sequence[int] = ()) -> Followed:
    """The task of a chain, with its held joints: those that are named, or as few as make it solvable."""
    seen = motions(arm, count)
    free = [k for k in range(count) if k not in held]
    rank = seen.rank(axes=free)
    if len(free) > rank:
        held = tuple(sorted((*held, *_to_hold(arm, seen, free, len(free) - rank))))
        free = [k for k in range(count) if k not in held]
        rank = seen.rank(axes=free)
    solved = Motions(seen.jacobians[:, :, free], seen.rotations)
    if rank == 5 or (rank == 4 and solved.rank(slice(0, 3)) == 3 and len(solved.span(slice(3, 6))) > 1):
        return _with_direction(solved, arm, rank, tuple(held))
    position, turning = _task(solved, rank)
    return Followed(position, turning, tuple(held))


def _with_direction(seen: Motions, arm: Arm, rank: int, held: tuple[int, ...]) -> Followed:
    """The task of a chain that follows a part of the tool's direction: which axis of its tip that is."""
    last = next((line.direction for line in reversed(arm.lines) if line.kind is Kind.ROTARY), np.zeros(3))
    seen_from_tip = np.abs(arm.tip[:3, :3].T @ last)
    if rank == 4:
        square = [k for k in (2, 0, 1) if seen_from_tip[k] < _NEARLY]
        found = [("PITCH", k) for k in square]
    else:
        along = [("PITCH_ROLL", k) for k in range(3) if seen_from_tip[k] > 1.0 - _NEARLY]
        aimed = [("DIRECTION", k) for k in (2, 0, 1) if _aims(seen, k)]
        is_arm = all(line.kind is Kind.ROTARY for line in arm.lines)
        found = [*(a for a in aimed if a[1] == 2), *along, *aimed]
        if is_arm and along:  # a tip that turns about the last axis points along it
            found = [a for a in aimed if a[1] == along[0][1]] or along
    if not found:
        raise UnreadableRobot(
            "no axis of its tip is a direction that the chain can follow: choose a --tip whose z axis is the tool's"
        )
    return Followed("xyz", found[0][0], held, found[0][1])


def _task(seen: Motions, rank: int) -> tuple[str, str]:
    shifts, turns = seen.span(slice(0, 3)), seen.span(slice(3, 6))
    if seen.rank(slice(0, 3)) == rank:
        return _position(shifts, rank), "NONE"
    if len(turns) == 1 and abs(turns[0][2]) > 1.0 - _SMALL:
        return _position(shifts, rank - 1), "ABOUT_Z"
    if len(turns) == 1:
        raise UnreadableRobot(
            "its tip turns about one axis that is not z of the base: choose a base link whose z is along that axis, so "
            "that the commanded turn has a name"
        )
    if len(shifts) == 0 and rank == 3:
        return "", "FULL"
    if rank == 6:
        return "xyz", "FULL"
    what = "choose another base or tip, or write the description by hand"
    if np.abs(seen.jacobians[:, :3, -1]).max() < _SMALL:
        what = "it lies on the axis of the last joint; choose a --tip beside that axis, or one before this joint"
    raise UnreadableRobot(f"its tip moves in {rank} ways that are no task of a description: {what}")


def _position(shifts: Array, rank: int) -> str:
    moved = [c for k, c in enumerate("xyz") if np.abs(shifts[:, k]).max(initial=0.0) >= _SMALL]
    if len(moved) == rank:
        return "".join(moved)
    raise UnreadableRobot(
        f"its tip has {rank} free motion{'' if rank == 1 else 's'} and moves along {', '.join(moved)}, and a "
        "description commands each coordinate that moves: choose a base link whose axes are along the motions, or "
        "another tip"
    )


def _aims(seen: Motions, axis: int) -> bool:
    """Whether all positions and directions of an axis of the tip can be commanded together."""
    ranks = []
    others = [k for k in range(3) if k != axis]
    for jacobian, rotation in zip(seen.jacobians, seen.rotations, strict=True):
        aimed = np.concatenate([jacobian[:3], rotation[:, others].T @ jacobian[3:]])
        ranks.append(np.linalg.matrix_rank(aimed, tol=1e-7))
    return bool(max(ranks) == 5)


def _to_hold(arm: Arm, seen: Motions, free: Sequence[int], count: int) -> tuple[int, ...]:
    """The joints to hold: rails first, then the one without which neighbouring axes still meet or are parallel."""
    held: list[int] = []
    rank = seen.rank(axes=free, least=_WELL)
    for _ in range(count):
        rest = [k for k in free if k not in held]
        possible = [k for k in rest if seen.rank(axes=[r for r in rest if r != k], least=_WELL) == rank]
        if not possible:
            break
        best = min(possible, key=lambda k: _preference(arm, rest, k))
        solved = [k for k in possible if _is_solved(arm, [r for r in rest if r != k], k)]
        if solved and (best not in solved or rest.index(best) != 2):  # hold the joint without which the tip moves best
            best = max(solved, key=lambda k: seen.least([r for r in rest if r != k]))
        held.append(best)
    return tuple(held)


def _is_solved(arm: Arm, axes: Sequence[int], held: int) -> bool:
    """Whether a closed form is likely with six axes: three neighbours meet in one point or are parallel, and two
    neighbours of the other three meet or are parallel; the held one stands between none of these.
    """
    by_axis = {line.drives[0][0]: line for line in arm.lines if len(line.drives) == 1 and line.kind is not Kind.LINEAR}
    if len(axes) != 6 or any(k not in by_axis for k in axes):
        return False
    for start in range(4):
        three = axes[start : start + 3]
        others = [pair for pair in pairwise(axes) if not set(pair) & set(three)]
        lines = [by_axis[k] for k in three]
        is_parallel = max(relation(a, b).angle for a, b in pairwise(lines)) < 1e-6
        is_wrist = spread(lines) < 1e-6 * arm.size or is_parallel
        if is_wrist and not three[0] < held < three[2] and any(_is_simple(arm, by_axis, p, held) for p in others):
            return True
    return False


def _is_simple(arm: Arm, by_axis: Mapping[int, Line], pair: tuple[int, int], held: int) -> bool:
    """Whether two axes meet or are parallel, however a held one stands."""
    if pair[0] < held < pair[1] or pair[0] not in by_axis or pair[1] not in by_axis:
        return False
    stands = relation(by_axis[pair[0]], by_axis[pair[1]])
    return stands.distance < 1e-6 * arm.size or stands.angle < 1e-6


def _preference(arm: Arm, axes: Sequence[int], axis: int) -> tuple[bool, int, int]:
    """Slides first; then few neighbours among the arm's axes that neither meet nor are parallel; then the third."""
    is_slide = any(line.kind is Kind.LINEAR for line in arm.lines for k, _ in line.drives if k == axis)
    rest = [k for k in axes if k != axis]
    return not is_slide, -_simple_pairs(arm, rest, axis), abs(axes.index(axis) - 2)


def _simple_pairs(arm: Arm, axes: Sequence[int], held: int) -> int:
    """How many axes next to each other meet or are parallel, however the held one stands; the first two count more."""
    by_axis = {line.drives[0][0]: line for line in arm.lines if len(line.drives) == 1}
    return int(any(_is_simple(arm, by_axis, pair, held) for pair in pairwise(axes[:3])))
