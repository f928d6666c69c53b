"""The answers of a package held against recorded ones.

Axes: within 1e-9 of scale (180 degrees; the reach) over the smallest margin of the solution. Where that margin is below
`SINGULAR`, the pose counts: forward kinematics brings both to the same frame. Everything else is equal: slots,
statuses, reasons, turns, bytes; reals of frames, Jacobians and amounts within the digits that their margin leaves.
"""

from collections.abc import Callable, Iterator
from math import isfinite
from typing import Any

import softkin

from tests.corpus.answers import Answer, Question, answer
from tests.corpus.robots import Robot

AXES = 1e-9
FRAME = 1e-10
SINGULAR = 1e-4
COINCIDENT = 1e-9
"""Branches with a margin below this may be written as coinciding or not."""
ROUNDED = 1e-7
"""What a singular pose lacks is known to this share, and a margin below may have the other sign."""
Ask = Callable[[Robot, Question], Answer]


def differences(one: Robot, asked: list[Question], recorded: list[Answer], ask: Ask = answer) -> Iterator[str]:
    for question, old in zip(asked, recorded, strict=True):
        new = ask(one, question)
        is_singular = question["kind"] == "singular"
        compare = _inverse if question["call"] == "inverse" else _other
        for found in compare(one, old, new, ROUNDED if is_singular else AXES):
            yield f"{question['kind']} {question['call']} of {one.made!r}: {found}; asked: {question}"


def _inverse(one: Robot, old: Answer, new: Answer, share: float) -> Iterator[str]:
    olds, news = old.get("slots"), new.get("slots")
    if olds is None or news is None:
        yield from _exact("call", {**old, "named": 0}, {**new, "named": 0})
    elif len(olds) != len(news):
        yield f"{len(olds)} slots were {len(news)}"
    else:
        for number, (was, now) in enumerate(zip(olds, news, strict=True)):
            yield from _solution(one, f"slot {number}", was, now, share)
    for number, (was, now) in enumerate(zip(old["named"], new["named"], strict=True)):
        yield from _solution(one, f"configuration {number}", was, now, share)
    if "trusted" in old:
        yield from _trusted(one, old, new)


def _trusted(one: Robot, old: Answer, new: Answer) -> Iterator[str]:
    """The slots for inner loops: in any turn."""
    if [axes is None for axes in old["trusted"]] != [axes is None for axes in new["trusted"]]:
        yield f"trusted slots: {old['trusted']} were {new['trusted']}"
        return
    for slot, (was, now) in enumerate(zip(old["trusted"], new["trusted"], strict=True)):
        if was is not None:
            turns = [
                360.0 * round((a - b) / 360.0) * axis.multi_turn
                for a, b, axis in zip(was, now, one.made.AXES, strict=True)
            ]
            margin = old["slots"][slot].get("margin", 0.0) if "slots" in old else 0.0
            yield from axes_differ(
                one, f"trusted slot {slot}", was, [b + t for b, t in zip(now, turns, strict=True)], margin
            )


def _solution(one: Robot, place: str, old: Answer, new: Answer, share: float) -> Iterator[str]:
    yield from _reals(one, f"{place}, why", old.get("why"), new.get("why"), share=share)
    keys = ("status", "message")
    yield from _exact(place, {k: old.get(k) for k in keys}, {k: new.get(k) for k in keys})
    if "axes" in old and "axes" in new:
        margin = min(old["margin"], new["margin"])
        yield from axes_differ(one, place, old["axes"], new["axes"], margin)
        if margin > SINGULAR:
            yield from _exact(f"{place}, bytes", old.get("configuration"), new.get("configuration"))
        was, now = old.get("others", []), new.get("others", [])
        if len(was) != len(now):
            yield f"{place}: {len(was)} further solutions were {len(now)}"
        for a, b in zip(was, now, strict=False):
            yield from axes_differ(one, f"{place}, further", a, b, 0.0)


def axes_differ(one: Robot, place: str, old: list[float], new: list[float], margin: float) -> Iterator[str]:
    """Whether axes are others: by their distance, near a singularity by their frames."""
    scales = [(180.0 if angle else one.reach) + abs(a) for angle, a in zip(one.is_angle, old, strict=True)]
    allowed = AXES / max(margin, SINGULAR)
    if all(abs(a - b) <= allowed * scale for a, b, scale in zip(old, new, scales, strict=True)):
        return
    if margin < SINGULAR and _same_frame(one, old, new):
        return
    yield f"{place}: axes {old} were {new}, with the margin {margin}"


def _same_frame(one: Robot, old: list[float], new: list[float]) -> bool:
    try:
        (first, _), (second, _) = one.made.forward(old), one.made.forward(new)
    except softkin.KinematicsError:
        return False
    size = one.reach + max(map(abs, first.position))
    near = all(abs(a - b) <= AXES * size for a, b in zip(first.position, second.position, strict=True))
    rows = zip(first.rotation, second.rotation, strict=True)
    return near and all(abs(a - b) <= AXES for row, other in rows for a, b in zip(row, other, strict=True))


def _other(one: Robot, old: Answer, new: Answer, share: float) -> Iterator[str]:
    if "axes" in old and "axes" in new:
        yield from axes_differ(one, "axes", old["axes"], new["axes"], min(old["margin"], new["margin"]))
        old, new = old | {"axes": 0, "margin": 0}, new | {"axes": 0, "margin": 0}
    margin = old.get("margin", 1.0)
    if "configuration" in old and "configuration" in new and margin < max(COINCIDENT, share):
        pairs = zip(old["configuration"], new["configuration"], strict=True)
        if share == ROUNDED or all(a == b or 3 in (a, b) for a, b in pairs):
            new = new | {"configuration": old["configuration"]}
    yield from _reals(one, "", {**old, "margin": 0}, {**new, "margin": 0}, max(margin, SINGULAR), share)


def _reals(one: Robot, place: str, old: Any, new: Any, margin: float = 1.0, share: float = AXES) -> Iterator[str]:
    """Trees of the same form, texts and whole numbers equal, reals within the digits that are left."""
    if isinstance(old, dict) and isinstance(new, dict) and old.keys() == new.keys():
        for key in old:
            if not (key == "missing" and _same_amount(one, old, new, share)):
                within = max(margin, 0.01) if key == "margins" else margin
                yield from _reals(one, f"{place} {key}", old[key], new[key], within, share)
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        size = one.reach if place.endswith(("position", "jacobian")) else 1.0
        size = max((size, *(abs(x) for x in old if isinstance(x, float) and isfinite(x))))
        if place.endswith("jacobian"):  # an entry may be a sign of the machine, which Python has as a whole number
            old, new = ([float(x) if type(x) is int else x for x in row] for row in (old, new))
        for a, b in zip(old, new, strict=True):
            if not (_are_reals(a, b) and abs(a - b) <= FRAME * size / margin):
                yield from _reals(one, place, a, b, margin, share)
    elif _are_reals(old, new):
        if abs(old - new) > AXES * max(1.0, abs(old)) / margin:
            yield f"{place}: {new!r} was {old!r}"
    else:
        yield from _exact(place, old, new)


def _same_amount(one: Robot, old: Answer, new: Answer, share: float) -> bool:
    """Whether two amounts that are missing are one: by the unit that the reason names."""
    unit = str(old.get("reason", "")).rpartition("[")[2].partition("]")[0]
    size = {"deg": 180.0, "u": one.reach}.get(unit, 1.0)
    return abs(old["missing"] - new["missing"]) <= share * max(size, abs(old["missing"]))


def _are_reals(*values: Any) -> bool:
    return all(isinstance(v, float) and isfinite(v) for v in values)


def _exact(place: str, old: Any, new: Any) -> Iterator[str]:
    if repr(old) != repr(new):
        yield f"{place}: {new} was {old}"
