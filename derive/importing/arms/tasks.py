"""The part of a commanded pose that a chain can follow, and the joints that have to be held: by the rank of its
Jacobian, and by how well its axes move what is commanded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, Line, moved, relation, spread
from derive.importing.robot import Array, UnreadableRobot

_SMALL = 1e-9
WEAK = 0.03
"""An axis that moves less than this share of the size, or this many radians, beyond the others hardly counts."""
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
    beside: tuple[float, float, float] | None = None
    """The shift, in the frame of the file's tip, onto the axis of the roll; None if the tip is on it."""


def followed(arm: Arm, count: int, held: Sequence[int] = ()) -> Followed:
    """The task of a chain, with its held joints: those that are named, or as few as make it solvable."""
    seen = motions(arm, count)
    free = [k for k in range(count) if k not in held]
    rank = seen.rank(axes=free)
    if len(free) > rank:
        held = tuple(sorted((*held, *_to_hold(arm, seen, free, len(free) - rank))))
        free = [k for k in range(count) if k not in held]
        rank = seen.rank(axes=free)
    solved = seen.of(free)
    if rank == 5 or (rank == 4 and solved.rank(slice(0, 3)) == 3 and len(solved.span(slice(3, 6))) > 1):
        return _with_direction(solved, arm, rank, tuple(held))
    position, turning = _task(solved, arm, rank)
    return Followed(position, turning, tuple(held))


def _with_direction(seen: Motions, arm: Arm, rank: int, held: tuple[int, ...]) -> Followed:
    """The task of a chain that follows a part of the tool's direction: the first one, of those that are wanted, that
    every axis moves well; else the one that they move best.
    """
    found: list[tuple[float, Followed]] = []
    for turning, axis in _pitches(arm) if rank == 4 else _directions(arm):
        task = Followed("xyz", turning, held, axis, _beside(arm) if turning == "PITCH_ROLL" else None)
        of = motions(on_axis(arm, task), _count(arm)).of(_free(arm, held)) if task.beside else seen
        least = float(of.own_shares("xyz", turning, axis).min())
        if least > WEAK or rank == 4:
            return task
        if least > _SMALL:
            found.append((least, task))
    if not found:
        raise UnreadableRobot(
            "no axis of its tip is a direction that the chain can follow: choose a --tip whose z axis is the tool's"
        )
    return max(found, key=lambda one: one[0])[1]


def _count(arm: Arm) -> int:
    return 1 + max(axis for line in arm.lines for axis, _ in line.drives)


def _free(arm: Arm, held: Sequence[int]) -> list[int]:
    return [k for k in range(_count(arm)) if k not in held]


def _turns(arm: Arm) -> list[Line]:
    """The turns of a chain, of parallel neighbours the last one."""
    found: list[Line] = []
    for line in arm.lines:
        if line.kind is Kind.ROTARY:
            is_same = bool(found) and relation(found[-1], line).angle < _NEARLY
            found = [*(found[:-1] if is_same else found), line]
    return found


def _pitches(arm: Arm) -> list[tuple[str, int]]:
    """The axes of the tip that stay square to the last turn."""
    last = _seen_from_tip(arm)
    return [("PITCH", k) for k in (2, 0, 1) if last[k] < _NEARLY]


def _directions(arm: Arm) -> list[tuple[str, int]]:
    """The tasks of five axes, those first that a user wants.

    Pitch and roll need a plane that all solutions share: a heading, parallel turns square to it, and the roll square to
    them. There a tip that turns about the last axis points along it; elsewhere its z axis is the tool's, if it can be.
    """
    last, turns = _seen_from_tip(arm), _turns(arm)
    is_square = all(abs(relation(a, b).angle - np.pi / 2) < _NEARLY for a, b in pairwise(turns))
    rolls = [("PITCH_ROLL", k) for k in range(3) if last[k] > 1.0 - _NEARLY and len(turns) <= 3 and is_square]
    is_arm = len(turns) == 3 and all(line.kind is Kind.ROTARY for line in arm.lines)
    first = [("DIRECTION", k) for _, k in rolls] + rolls if is_arm else []
    return [*first, ("DIRECTION", 2), *rolls, ("DIRECTION", 0), ("DIRECTION", 1)]


def _seen_from_tip(arm: Arm) -> Array:
    """The direction of the last turn, in the frame of the tip; without signs."""
    turns = _turns(arm)
    return np.abs(arm.tip[:3, :3].T @ turns[-1].direction) if turns else np.zeros(3)


def _beside(arm: Arm) -> tuple[float, float, float] | None:
    """The shift, in the frame of the tip, that puts the tip on the axis of the last turn; None if it is on it."""
    line, tip = _turns(arm)[-1], arm.tip[:3, 3]
    foot = line.point + line.direction * float((tip - line.point) @ line.direction)
    shift = arm.tip[:3, :3].T @ (foot - tip)
    return tuple(map(float, shift)) if np.linalg.norm(shift) > _NEARLY * arm.size else None  # type: ignore[return-value]


def on_axis(arm: Arm, task: Followed) -> Arm:
    """The arm with its tip moved onto the axis of the last turn, where the task asks for that."""
    frame = np.eye(4)
    frame[:3, 3] = task.beside or (0.0, 0.0, 0.0)
    return replace(arm, tip=arm.tip @ frame)


def _task(seen: Motions, arm: Arm, rank: int) -> tuple[str, str]:
    shifts, turns = seen.span(slice(0, 3)), seen.span(slice(3, 6))
    if seen.rank(slice(0, 3)) == rank:
        return _position(arm, shifts, rank), "NONE"
    if len(turns) == 1 and abs(turns[0][2]) > 1.0 - _SMALL:
        return _position(arm, shifts, rank - 1), "ABOUT_Z"
    if len(turns) == 1:
        raise UnreadableRobot(
            "its tip turns about one axis that is not z of the base: choose a base link whose z is along that axis, so "
            "that the commanded turn has a name"
        )
    if len(shifts) == 0 and rank == 3:
        return "", "FULL"
    if rank == 6:
        return "xyz", "FULL"
    raise _unlike(
        arm,
        f"its tip moves in {rank} ways that are no task of a description: choose another base or tip, or write the "
        "description by hand",
    )


def _unlike(arm: Arm, otherwise: str) -> UnreadableRobot:
    """What to say of a tip whose motions no task has."""
    if arm.lines[-1].kind is Kind.ROTARY and _beside(arm) is None:
        return UnreadableRobot(
            "its tip lies on the axis of its last joint, which turns it and shifts it nowhere: choose the link before "
            "that joint as --tip, or one beside its axis"
        )
    return UnreadableRobot(otherwise)


def _position(arm: Arm, shifts: Array, rank: int) -> str:
    moved = [c for k, c in enumerate("xyz") if np.abs(shifts[:, k]).max(initial=0.0) >= _SMALL]
    if len(moved) == rank:
        return "".join(moved)
    raise _unlike(
        arm,
        f"its tip has {rank} free motion{'' if rank == 1 else 's'} and moves along {', '.join(moved)}, and a "
        "description commands each coordinate that moves: choose a base link whose axes are along the motions, or "
        "another tip",
    )


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


_SAMPLES = 12


@dataclass(frozen=True)
class Motions:
    """Jacobians of the tip at some joint values (samples x 6 x axes, lengths over the size), its rotations there, and
    the directions of the last turns (samples x 3): of the last one, and of the last one that is not parallel to it.
    """

    jacobians: Array
    rotations: Array
    last: Array
    before: Array

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

    def of(self, axes: Sequence[int]) -> Motions:
        """The motions of some axes alone."""
        return Motions(self.jacobians[:, :, list(axes)], self.rotations, self.last, self.before)

    def own_shares(self, position: str, turning: str, facing: int) -> Array:
        """For each axis the median of what it alone moves of the commanded quantities, in sizes and radians."""
        shares = []
        for k, jacobian in enumerate(self.jacobians):
            seen = {
                "NONE": np.zeros((0, 3)),
                "ABOUT_Z": np.eye(3)[2:],
                "DIRECTION": np.delete(self.rotations[k].T, facing, 0),
                "PITCH": self.last[k : k + 1],
                "PITCH_ROLL": np.array([self.before[k], self.last[k]]),
                "FULL": np.eye(3),
            }[turning]
            rows = jacobian[["xyz".index(c) for c in position]]
            shares.append(_distances(np.concatenate([rows, seen @ jacobian[3:]])))
        return np.asarray(np.median(shares, axis=0))


def _distances(columns: Array) -> Array:
    """The distance of each column from the span of the others; zero if the columns are dependent."""
    if np.linalg.matrix_rank(columns, tol=1e-9) < columns.shape[1]:
        return np.zeros(columns.shape[1])
    return np.asarray(1.0 / np.linalg.norm(np.linalg.pinv(columns), axis=1))


def motions(arm: Arm, count: int) -> Motions:
    """Jacobians at general joint values, which are always the same."""
    rng = np.random.default_rng(5)
    found: list[tuple[Array, Array, Array, Array]] = []
    for _ in range(_SAMPLES):
        values = rng.uniform(0.3, 1.2, count) * rng.choice([-1.0, 1.0], count)
        in_units = np.array([v * _unit(arm, k) for k, v in enumerate(values)])
        found.append(_jacobian(arm, in_units))
    jacobians, rotations, last, before = (np.array(some) for some in zip(*found, strict=True))
    return Motions(jacobians, rotations, last, before)


def _unit(arm: Arm, axis: int) -> float:
    """The size of a slide's values; 1 for an angle."""
    kinds = [line.kind for line in arm.lines for k, _ in line.drives if k == axis]
    return arm.size if Kind.LINEAR in kinds else 1.0


def _jacobian(arm: Arm, values: Array) -> tuple[Array, Array, Array, Array]:
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
    turns = [direction for line, direction, _ in columns if line.kind is Kind.ROTARY] or [np.zeros(3)]
    others = [t for t in turns if np.linalg.norm(np.cross(t, turns[-1])) > 1e-6] or [np.zeros(3)]
    return jacobian, (frame @ arm.tip)[:3, :3], turns[-1], others[-1]
