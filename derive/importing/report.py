"""What an import tells: neighbouring axes, what would have to be moved for a closed form, and what was moved."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from derive.description.joints import Kind
from derive.importing.arms.lines import ROUNDING, Arm, Line, feet, relation
from derive.importing.arms.snapping import Snapped

_NEARLY = 2e-2
"""A share of the size (or of one radian) up to which axes are said to stand nearly so."""


@dataclass(frozen=True)
class Bounds:
    """How far forward kinematics can be from the file's: a length, and an angle in radians."""

    position: float
    rotation: float


def bounds(moved: Sequence[Snapped], arm: Arm, strokes: float) -> Bounds:
    """What everything that was moved adds up to at any joint values. strokes: how far slides reach in all."""
    angles = sum(s.amount for s in moved if s.is_angle)
    lengths = sum(s.amount for s in moved if not s.is_angle)
    return Bounds(2.0 * angles * (arm.size + strokes) + 2.0 * lengths, 2.0 * angles)


def neighbours(arm: Arm, names: Sequence[str], limit: float, unit: str) -> Iterator[str]:
    """A line for each pair of neighbouring axes: distance, angle, and what is missing to a simple relation."""
    for (first, one), (second, other) in zip(
        zip(arm.lines, names, strict=True), list(zip(arm.lines, names, strict=True))[1:], strict=False
    ):
        stands = relation(first, second)
        degrees = float(np.degrees(stands.angle))
        is_slide = Kind.LINEAR in (first.kind, second.kind)
        distance = "a slide" if is_slide else f"distance {stands.distance:.6g} {unit}"
        hints = list(_hints(stands.distance / arm.size, stands.angle, limit, is_slide))
        yield f"  {one}-{other}: {distance}, angle {degrees:.6g}°{'; ' if hints else ''}{'; '.join(hints)}"


def closed_form(arm: Arm, names: Sequence[str], limit: float) -> str:
    """Whether three neighbouring axes meet in one point or are parallel, or by how much they miss that least."""
    found: list[tuple[float, str]] = []
    for k in range(len(arm.lines) - 2):
        three, three_names = arm.lines[k : k + 3], ", ".join(names[k : k + 3])
        if any(line.kind is Kind.LINEAR for line in three):
            continue
        apart = max(relation(a, b).angle for a, b in zip(three, three[1:], strict=False))
        found.append((_spread(three) / arm.size, f"{three_names} meet in one point"))
        found.append((apart, f"{three_names} are parallel"))
    if not found:
        return "Slides among the axes: most chains with them have a closed form."
    amount, words = min(found)
    if amount <= max(limit, ROUNDING * 100):
        return f"A closed form is likely: {words}."
    if amount > _NEARLY:
        return "No three neighbouring axes meet in one point or are parallel: a closed form is unlikely."
    return f"No three neighbouring axes meet in one point or are parallel; with --snap {_above(amount)} {words}."


def _spread(lines: Sequence[Line]) -> float:
    """How far three lines are from meeting in one point: their distances, and how far apart they pass the middle."""
    first, middle, last = lines
    before, behind = feet(first, middle), feet(middle, last)
    if before is None or behind is None:
        return float("inf")
    gaps = (before[0] - before[1], behind[0] - behind[1], before[1] - behind[0])
    return float(max(np.linalg.norm(gap) for gap in gaps))


def _hints(distance: float, angle: float, limit: float, is_slide: bool) -> Iterator[str]:
    """distance: a share of the size."""
    yield from _angle_hints(angle, limit)
    if not is_slide and angle > limit:
        if distance <= ROUNDING * 100:
            yield "they meet"
        elif distance <= limit:
            yield "they meet, snapped"
        elif distance <= _NEARLY:
            yield f"they would meet with --snap {_above(distance)}"


def _angle_hints(angle: float, limit: float) -> Iterator[str]:
    for value, word in ((0.0, "parallel"), (np.pi / 2, "square")):
        off = abs(angle - value)
        if off <= ROUNDING * 100:
            yield word
        elif off <= limit:
            yield f"{word}, snapped"
        elif off <= _NEARLY:
            yield f"nearly {word}: {word} with --snap {_above(off)}"


def _above(amount: float) -> str:
    """A number with two digits that is not less."""
    digits = 10.0 ** (np.floor(np.log10(amount)) - 1)
    return f"{np.ceil(amount / digits * (1 - 1e-12)) * digits:.2g}"


def snaps(moved: Sequence[Snapped], missed: Sequence[float], found: Bounds, snap: float, unit: str) -> Iterator[str]:
    """What was moved, and what that can make of a pose."""
    if missed:
        count, them = f"{len(missed)} angles of the file are nearly multiples", "them"
        if len(missed) == 1:
            count, them = "1 angle of the file is nearly a multiple", "it"
        yield f"{count} of 15°: --snap {_above(max(missed))} puts {them} back."
    if not moved:
        yield f"Nothing was snapped (--snap {snap:g})."
        return
    yield f"Snapped (--snap {snap:g} of the size, or of one radian):"
    for one in moved:
        yield f"  {one.what} by {one.amount:.2g} {'rad' if one.is_angle else unit}"
    yield (
        f"Forward kinematics differs from the file's by at most {found.position:.2g} {unit} and "
        f"{found.rotation:.2g} rad."
    )
