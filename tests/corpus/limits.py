"""Questions about limits: an axis just inside and just outside, another turn inside, limits that are not tested."""

from collections.abc import Iterator
from typing import Any

import softkin

from tests.corpus.answers import Question
from tests.corpus.poses import Axes
from tests.corpus.robots import Recipe, Robot

BESIDE = 1e-6


def questions(one: Robot, chosen: list[Axes]) -> Iterator[tuple[Recipe, list[Question]]]:
    """Robots whose limits are set about poses, and the inverse of those."""
    for number, axes in enumerate(chosen[:2]):
        frame, own = one.made.forward(axes)
        is_searched = hasattr(one.made, "SIDES")
        every = [list(own)] if is_searched else [list(own), [0] * len(own)]
        references = (None, list(axes))[is_searched:]
        for i, axis in enumerate(one.made.AXES):
            lower, upper = f"lower_{_short(axis.name)}", f"upper_{_short(axis.name)}"
            if lower not in _parameters(one):
                continue
            for low, high in _ranges(axes[i], axis.multi_turn, number):
                limited = _limited(one, {lower: low, upper: high})
                if limited is not None:
                    yield limited.recipe, [_asked(frame, reference, every) for reference in references]
            untested = _limited(one, {lower: axes[i] + 1.0, upper: axes[i] + 2.0, "check_limits": 0.0})
            if untested is not None and number == 0:
                yield untested.recipe, [_asked(frame, list(axes), every)]
        for lower, upper in _others(one):
            for low, high in ((-10.0, 10.0), (5.0, 400.0)):
                limited = _limited(one, {lower: low, upper: high})
                if limited is not None:
                    yield limited.recipe, [_asked(frame, list(axes), every)]


def _ranges(value: float, turns: bool, number: int) -> Iterator[tuple[float, float]]:
    """Just inside either end, just outside either end; other turns of a narrow and of a wide range."""
    yield value - 40.0, value + BESIDE
    yield value - 40.0, value - BESIDE
    if number == 0:
        yield value - BESIDE, value + 30.0
        yield value + BESIDE, value + 30.0
        if turns:
            yield value + 340.0, value + 380.0
            yield value + 200.0, value + 700.0
            yield value - 1300.0, value - 800.0


def _asked(frame: softkin.Frame, reference: Any, configurations: Any) -> Question:
    given = [list(frame.position), [list(row) for row in frame.rotation]]
    asked = {"call": "inverse", "kind": "limits", "frame": given, "reference": reference}
    return asked | {"configurations": configurations, "trusted": False}


def _limited(one: Robot, parameters: dict[str, float]) -> Robot | None:
    try:
        return one.changed(**parameters)
    except softkin.KinematicsError:
        return None


def _others(one: Robot) -> Iterator[tuple[str, str]]:
    """Limits on what is no axis: joints that a drive moves together with others."""
    axes = {_short(axis.name) for axis in one.made.AXES}
    for name in _parameters(one):
        short = name.removeprefix("lower_")
        if name.startswith("lower_") and short not in axes:
            yield name, f"upper_{short}"


def _parameters(one: Robot) -> list[str]:
    parts = (one.made,) if len(one.recipe) == 1 else (one.made.position_part, one.made.orientation_part)
    return [p.name for part in parts for p in type(part).PARAMETERS]


def _short(name: str) -> str:
    return name.lower()
