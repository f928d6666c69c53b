"""The usual branches of robot arms, named after the shapes of the two solutions.

shoulder: the wrist in front of axis 1 or behind it. elbow: the two links of a pair of axes bent one way or the other.
wrist: the sine (or cosine) of the angle between the first and the last axis of a wrist. For other chains no branch is
named here, and the derivation names its branches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from derive.geometry.frames import Motion
from derive.importing.arms.pieces import Piece
from derive.importing.arms.tasks import Followed


@dataclass(frozen=True)
class Named:
    """A branch as a description writes it."""

    name: str
    indicator: sp.Expr
    names: tuple[str, str]


@dataclass(frozen=True)
class Skeleton:
    """A chain with its amounts as expressions, and where the joints that the inverse solves for turn."""

    pieces: tuple[Piece, ...]
    amounts: tuple[sp.Expr, ...]
    turns: tuple[int, ...]
    """The places of their pieces in the chain."""

    def letter(self, turn: int) -> int:
        """The letter that a turn is about."""
        return self.pieces[self.turns[turn]].letter

    def amount(self, turn: int) -> sp.Expr:
        """The angle of a turn."""
        return self.amounts[self.turns[turn]]

    def is_shifted(self, start: int, end: int) -> bool:
        """Whether nothing but shifts stands between two turns."""
        between = self.pieces[self.turns[start] + 1 : self.turns[end]]
        return all(p.motion is Motion.SHIFT for p in between)

    def meet(self, start: int, end: int) -> bool:
        """Whether the axes of two turns meet in one point: nothing stands between them but shifts along the first."""
        between = self.pieces[self.turns[start] + 1 : self.turns[end]]
        return all(p.motion is Motion.SHIFT and p.letter == self.letter(start) for p in between)

    def along(self, start: int, end: int) -> sp.Matrix:
        """The vector from a turn to a later place of the chain, in the frame behind that turn."""
        total = sp.zeros(3, 1)
        passed: list[tuple[int, sp.Expr]] = []
        for piece, amount in zip(self.pieces[start + 1 : end], self.amounts[start + 1 : end], strict=True):
            if piece.motion is Motion.SHIFT:
                total += _turned(passed, sp.eye(3)[:, piece.letter]) * amount
            elif passed and passed[-1][0] == piece.letter:
                passed[-1] = (piece.letter, passed[-1][1] + amount)
            else:
                passed.append((piece.letter, amount))
        return total


def _turned(passed: Sequence[tuple[int, sp.Expr]], vector: sp.Matrix) -> sp.Matrix:
    for letter, angle in reversed(passed):
        i, j = (letter + 1) % 3, (letter + 2) % 3
        first, second = vector[i], vector[j]
        turned = sp.Matrix(vector)
        turned[i] = sp.cos(angle) * first - sp.sin(angle) * second
        turned[j] = sp.sin(angle) * first + sp.cos(angle) * second
        vector = turned
    return vector


def branches(pieces: Sequence[Piece], amounts: Sequence[sp.Expr], task: Followed) -> tuple[Named, ...]:
    """The branches of an arm; none if they have no usual names."""
    held = set(task.held)
    turns = [
        k
        for k, p in enumerate(pieces)
        if p.motion is Motion.TURN and p.drives and not {axis for axis, _ in p.drives} <= held
    ]
    arm = Skeleton(tuple(pieces), tuple(amounts), tuple(turns))
    if task.turning == "FULL" and task.position == "xyz" and len(turns) == 6:
        if arm.meet(3, 4) and arm.turns[5] == arm.turns[4] + 1:
            return _with_wrist(arm)
        if all(arm.letter(k) == arm.letter(1) and arm.is_shifted(k - 1, k) for k in (2, 3)) and arm.meet(4, 5):
            return _three_parallel(arm)
    is_planar = task.turning in ("NONE", "ABOUT_Z") and len(turns) in (2, 3) and not held
    if is_planar and arm.letter(0) == arm.letter(1) and arm.is_shifted(0, 1):
        end = turns[2] if len(turns) == 3 else len(pieces)
        return (_elbow(arm, 0, 1, end, ("right", "left")),)
    if task == Followed("xyz", "NONE") and len(turns) == 3 and _is_arm(arm):
        return _shoulder(arm, len(pieces)), _elbow(arm, 1, 2, len(pieces), ("up", "down"))
    return ()


def _is_arm(arm: Skeleton) -> bool:
    """Whether the second and the third axis are parallel, and the first one is at right angles to them."""
    return arm.letter(0) != arm.letter(1) == arm.letter(2) and arm.is_shifted(0, 1) and arm.is_shifted(1, 2)


def _with_wrist(arm: Skeleton) -> tuple[Named, ...]:
    """An arm whose last three axes meet."""
    centre = arm.turns[4]
    wrist = _wrist(arm, 3)
    if _is_arm(arm) and wrist is not None:
        return _shoulder(arm, centre), _elbow(arm, 1, 2, centre, ("up", "down")), wrist
    if arm.meet(0, 1) and arm.letter(0) != arm.letter(1) and wrist is not None:
        return _shoulder(arm, centre), _elbow(arm, 1, 2, centre, ("up", "down")), wrist
    return ()


def _three_parallel(arm: Skeleton) -> tuple[Named, ...]:
    """An arm whose second, third and fourth axis are parallel."""
    wrist = _wrist(arm, 3)
    if wrist is None or arm.letter(0) == arm.letter(1) or not arm.is_shifted(0, 1):
        return ()
    return _shoulder(arm, arm.turns[5]), _elbow(arm, 1, 2, arm.turns[3], ("up", "down")), wrist


def _wrist(arm: Skeleton, first: int) -> Named | None:
    """The turn between the first and the last axis of a wrist."""
    letters = [arm.letter(k) for k in range(first, first + 3)]
    if letters[1] in (letters[0], letters[2]):
        return None
    turn = sp.sin if letters[0] == letters[2] else sp.cos
    between = turn(arm.amount(first + 1))
    return Named("wrist", -between if between.could_extract_minus_sign() else between, ("positive", "negative"))


def _shoulder(arm: Skeleton, centre: int) -> Named:
    """The distance of the wrist in front of the first axis, at right angles to the first two axes."""
    forward = 3 - arm.letter(0) - arm.letter(1)
    return Named("shoulder", sp.expand(arm.along(arm.turns[0], centre)[forward]), ("front", "back"))


def _elbow(arm: Skeleton, before: int, at: int, end: int, names: tuple[str, str]) -> Named:
    """The cross product of the links before and behind an axis: zero if they are stretched or folded."""
    letter = arm.letter(at)
    i, j = (letter + 1) % 3, (letter + 2) % 3
    first = _back(arm, arm.turns[before], arm.turns[at])
    second = _turned([(letter, arm.amount(at))], arm.along(arm.turns[at], end))
    crossed = sp.expand(first[i] * second[j] - first[j] * second[i]) * (-1 if (letter - arm.letter(0)) % 3 == 1 else 1)
    return Named("elbow", _without_lengths(crossed), names)


def _back(arm: Skeleton, start: int, end: int) -> sp.Matrix:
    """The vector between two turns, in the frame before the later one."""
    total = sp.zeros(3, 1)
    behind: list[tuple[int, sp.Expr]] = []
    for piece, amount in reversed(list(zip(arm.pieces[start + 1 : end], arm.amounts[start + 1 : end], strict=True))):
        if piece.motion is Motion.SHIFT:
            total += _turned(behind[::-1], sp.eye(3)[:, piece.letter]) * amount
        else:
            behind.append((piece.letter, -amount))
    return total


def _without_lengths(expression: sp.Expr) -> sp.Expr:
    """The expression without the positive factors that all its terms have."""
    common, rest = sp.factor_terms(expression).as_independent(sp.sin, sp.cos, as_Add=False)
    return rest if common.is_positive else -rest if common.is_negative else expression
