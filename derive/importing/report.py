"""The report of an import: neighbouring axes, the changes that a closed form would need, and the changes made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.lines import ROUNDING, Arm, Line, relation, spread
from derive.importing.arms.snapping import Snapped
from derive.importing.arms.tasks import WEAK, Followed, motions, on_axis

_NEARLY = 2e-2
"""The share of the size (or of one radian) up to which a relation of axes is called near."""


@dataclass(frozen=True)
class Bounds:
    """The largest difference of forward kinematics from the file's: a length, and an angle in radians."""

    position: float
    rotation: float


def bounds(moved: Sequence[Snapped], arm: Arm, strokes: float) -> Bounds:
    """The sum of all changes, at any joint values. strokes: the total travel of slides."""
    angles = sum(s.amount for s in moved if s.is_angle)
    lengths = sum(s.amount for s in moved if not s.is_angle)
    return Bounds(2.0 * angles * (arm.size + strokes) + 2.0 * lengths, 2.0 * angles)


def neighbours(raw: Arm, arm: Arm, names: Sequence[str], limit: float, unit: str) -> Iterator[str]:
    """A line for each pair of neighbouring axes: distance, angle, and the difference from a simple relation.

    raw: the arm of the file; arm: the arm with exact angles.
    """
    for k, (one, other) in enumerate(pairwise(names)):
        stands, back = (relation(*a.lines[k : k + 2]) for a in (raw, arm))
        degrees = float(np.degrees(stands.angle))
        is_slide = Kind.LINEAR in (arm.lines[k].kind, arm.lines[k + 1].kind)
        apart = stands.distance if stands.distance > raw.rounding else 0.0
        distance = "a slide" if is_slide else f"distance {apart:.6g} {unit}"
        own = arm.limit(k + 1, limit)
        hints = list(_angle_hints(stands.angle, back.angle, own))
        if not is_slide and back.angle > own:
            hints += _distance_hints(stands.distance / raw.size, back.distance / arm.size, own)
        yield f"  {one}-{other}: {distance}, angle {degrees:.6g}°{'; ' if hints else ''}{'; '.join(hints)}"


def redundant(arm: Arm, names: Sequence[str], limit: float) -> Iterator[str]:
    """A sentence for neighbouring joints of which one moves nothing of its own, whatever the others do."""
    for first in range(len(arm.lines)):
        for count in (2, 4):
            lines, own = arm.lines[first : first + count], names[first : first + count]
            drives = {number for line in lines for number, _ in line.drives}
            if len(lines) == count == len(drives) and (words := _shared(lines, arm.size, max(limit, ROUNDING * 100))):
                them = " and ".join(own) if count == 2 else ", ".join(own)
                yield f"{them} {words}: one of them moves nothing of its own."


def _shared(lines: Sequence[Line], size: float, tolerance: float) -> str:
    """What all of two or four lines have in common, if one of the joints is too many for it; else nothing."""
    related = [relation(lines[0], other) for other in lines[1:]]
    are_parallel = all(one.angle <= tolerance for one in related)
    slides = [line.kind is Kind.LINEAR for line in lines]
    if len(lines) == 2 and are_parallel and all(slides):
        return "slide in the same direction"
    if any(slides):
        return ""
    if len(lines) == 2:
        return "turn about the same line" if are_parallel and related[0].distance <= tolerance * size else ""
    if are_parallel:
        return "are parallel"
    across = [np.eye(3) - np.outer(line.direction, line.direction) for line in lines]
    at = np.concatenate([a @ line.point for a, line in zip(across, lines, strict=True)])
    missed = np.concatenate(across) @ np.linalg.lstsq(np.concatenate(across), at, rcond=None)[0] - at
    return "meet in one point" if np.abs(missed).max() <= tolerance * size else ""


def closed_form(arm: Arm, names: Sequence[str], limit: float) -> str:
    """Whether three neighbouring axes meet in one point or are parallel, or the least amount by which they do not."""
    found: list[tuple[float, str]] = []
    for k in range(len(arm.lines) - 2):
        three, three_names = arm.lines[k : k + 3], ", ".join(names[k : k + 3])
        if any(line.kind is Kind.LINEAR for line in three):
            continue
        apart = max(relation(a, b).angle for a, b in zip(three, three[1:], strict=False))
        found.append((spread(three) / arm.size, f"{three_names} meet in one point"))
        found.append((apart, f"{three_names} are parallel"))
    if not found:
        return "Slides among the axes: most chains with them have a closed form."
    amount, words = min(found)
    if amount <= max(ROUNDING * 100, *(arm.limit(place, limit) for place in range(len(arm.lines)))):
        return f"A closed form is likely: {words}."
    if amount > _NEARLY:
        return "No three neighbouring axes meet in one point or are parallel: a closed form is unlikely."
    return f"No three neighbouring axes meet in one point or are parallel; with --snap {_above(amount)} {words}."


def weak_axes(arm: Arm, task: Followed, axes: Sequence[str]) -> Iterator[str]:
    """A line for each axis that hardly moves what is commanded beyond what the other axes do."""
    free = [k for k in range(len(axes)) if k not in task.held]
    shares = motions(on_axis(arm, task), len(axes)).of(free).own_shares(task.position, task.turning, task.facing)
    for k, share in zip(free, shares, strict=True):
        if share < WEAK:
            yield (
                f"{axes[k]} hardly moves what is commanded: {share:.2g} of its own motion, beyond the other axes. "
                "Near most poses targets are out of reach: hold it (--hold), or choose another --tip."
            )


def _distance_hints(distance: float, put_back: float, limit: float) -> Iterator[str]:
    """distance, put_back: in the file, and with exact angles, both as shares of the size."""
    if distance <= ROUNDING * 100:
        yield "they meet"
    elif put_back <= max(limit, ROUNDING * 100):
        yield "they meet, snapped"
    elif put_back <= _NEARLY:
        yield f"they would meet with --snap {_above(put_back)}"


def _angle_hints(angle: float, put_back: float, limit: float) -> Iterator[str]:
    for value, word in ((0.0, "parallel"), (np.pi / 2, "square")):
        off = abs(put_back - value)
        if abs(angle - value) <= ROUNDING * 100:
            yield word
        elif off <= max(limit, ROUNDING * 100):
            yield f"{word}, snapped"
        elif off <= _NEARLY:
            yield f"nearly {word}: {word} with --snap {_above(off)}"


def _above(amount: float) -> str:
    """An upper bound of an amount with two digits."""
    digits = 10.0 ** (np.floor(np.log10(amount)) - 1)
    return f"{np.ceil(amount / digits * (1 - 1e-12)) * digits:.2g}"


def snaps(
    moved: Sequence[Snapped],
    missed: Sequence[float],
    found: Bounds,
    snap: float,
    unit: str,
    what: str = "Forward kinematics",
) -> Iterator[str]:
    """The changes that were made, and their largest effect on a pose."""
    if missed:
        yield (
            f"Angles with two decimals that may be rounded multiples of 15°: {len(missed)}. "
            f"--snap {_above(max(missed))} reads them so."
        )
    if not moved:
        yield f"Nothing was snapped (--snap {snap:g})."
        return
    yield f"Snapped (what the file has rounded, and what is within --snap {snap:g} of the size, or of one radian):"
    for one in moved:
        yield f"  {one.what} by {one.amount:.2g} {'rad' if one.is_angle else unit}"
    yield (f"{what} differs from the file's by at most {found.position:.2g} {unit} and {found.rotation:.2g} rad.")
