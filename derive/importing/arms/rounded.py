"""The exact values of angles that a file has rounded: 1.5708 is a right angle, and so is 1.570796325.

An angle becomes a multiple of 15 degrees where it equals that multiple rounded to the decimals that the file writes, or
where the difference is within the default limit. With two decimals it does where the limit allows that. With a limit
of 0 no angle is changed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from derive.form.headings import orientation, product
from derive.importing.arms.lines import ROUNDING
from derive.importing.arms.snapping import SNAP, Snapped, angle_between, nearest_angle, right_angled
from derive.importing.formats.documents import COARSE
from derive.importing.robot import Array, Moving, Place, Robot, Shifted, Step, Triple, Turned


def snapped_robot(robot: Robot, limit: float) -> tuple[Robot, tuple[Snapped, ...]]:
    """The robot with the exact angles, and the record of the changes. limit: 0 changes nothing."""
    moved: list[Snapped] = []
    steps = tuple(_step(step, limit, moved) for step in robot.steps)
    return replace(robot, steps=steps), tuple(moved)


def nearly(robot: Robot) -> list[float]:
    """The amounts by which unchanged angles miss a multiple of 15 degrees that they round to two decimals."""
    places = [p for s in robot.steps for p in s.places if isinstance(p, Turned)]
    missed = [(nearest_angle(p.angle), abs(p.angle - nearest_angle(p.angle)), p.rounding) for p in places]
    return [
        amount for nearest, amount, rounding in missed if amount > ROUNDING and _is_rounded(nearest, amount, rounding)
    ]


def _step(step: Step, limit: float, moved: list[Snapped]) -> Step:
    places = tuple(_place(step, place, limit, moved) for place in step.places)
    return replace(step, places=places, moving=_moving(step, step.moving, limit, moved))


def _place(step: Step, place: Place, limit: float, moved: list[Snapped]) -> Place:
    if isinstance(place, Shifted):
        return place
    if isinstance(place, Turned):
        angle = _angle(step.name, place.angle, place.rounding, limit, moved)
        return replace(place, angle=angle, rounding=place.rounding if angle == place.angle else 0.0)
    stated = np.array(place.rows)
    simple, words = _simple(stated, place.rounding, limit)
    amount = angle_between(simple, stated)
    if amount > ROUNDING:
        moved.append(Snapped(f"{step.name}: its orientation {words}", amount, True))
    first, second, third = (_triple(row) for row in simple)
    return replace(place, rows=(first, second, third), rounding=0.0 if words else place.rounding)


def _triple(row: Array) -> Triple:
    return float(row[0]), float(row[1]), float(row[2])


def _moving(step: Step, moving: Moving | None, limit: float, moved: list[Snapped]) -> Moving | None:
    """The movement; if it turns, with the exact value of its offset."""
    if moving is None or not moving.offset or not moving.turns:
        return moving
    offset = _angle(f"{step.name}, offset", moving.offset, moving.rounding, limit, moved)
    return replace(moving, offset=offset)


def _angle(place: str, angle: float, rounding: float, limit: float, moved: list[Snapped]) -> float:
    nearest = nearest_angle(angle)
    amount = abs(nearest - angle)
    if amount <= max(min(limit, SNAP), ROUNDING):
        words = f"{angle:.10g} read as {np.degrees(nearest):g}°"
    elif _is_rounded(nearest, amount, rounding) and limit > 0.0 and (rounding < COARSE or amount <= limit):
        words = f"{angle:.10g} is {np.degrees(nearest):g}° rounded, off"
    else:
        return angle
    if amount > ROUNDING:
        moved.append(Snapped(f"{place}: {words}", amount, True))
    return nearest


def _is_rounded(nearest: float, amount: float, rounding: float) -> bool:
    """Whether an angle is the nearest multiple, rounded; a file that means 0 writes 0."""
    return nearest != 0.0 and _is_within(amount, rounding)


def _is_within(amount: float, rounding: float) -> bool:
    """Whether an amount is within rounding; the comparison allows for errors of calculation."""
    return amount <= rounding * (1.0 + 1e-9)


def _simple(stated: Array, rounding: float, limit: float) -> tuple[Array, str]:
    """The rotation by right angles, or by multiples of 15 degrees, that a rotation stands for; else the rotation."""
    right = right_angled(stated)
    if right is not None and angle_between(right, stated) <= max(min(limit, SNAP), ROUNDING):
        return right, "read as one of right angles"
    if limit > 0.0 and rounding > 0.0:
        turns = orientation(stated, looks_down=False, same=rounding)
        simple = product(tuple((axis, nearest_angle(angle)) for axis, angle in turns))
        if _is_within(angle_between(simple, stated), rounding):
            return simple, "is rounded, off"
    return stated, ""
