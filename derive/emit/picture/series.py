"""Names that are told once for all legs: a platform on six legs would have more names than its picture has room."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import sympy as sp

from derive.drawing.scene import Body, Scene

_LEAST = 3
"""A series has at least so many names."""


def without_series(scene: Scene, spelled: Callable[[sp.Expr], str]) -> tuple[Scene, tuple[str, ...]]:
    """The scene of a platform with each length at one leg alone, and the names at the others: `dRod2 to dRod6`."""
    if not any(segment.body is Body.PLATE for segment in scene.segments):
        return scene, ()
    names = {d: [spelled(d.label)] for d in scene.dimensions} | {s: [*map(spelled, s.labels)] for s in scene.spots}
    series = [every for every in _alike(names.values()) if len(every) >= _LEAST]
    left_out = [some for every in series for some in every[1:]]
    dimensions = tuple(d for d in scene.dimensions if _own(names[d]) not in left_out)
    spots = tuple(s for s in scene.spots if _own(names[s]) not in left_out)
    words = tuple(f"{every[1][0]} to {every[-1][-1]}" for every in series)
    return replace(scene, dimensions=dimensions, spots=spots), words


def _alike(names: Iterable[Sequence[str]]) -> list[list[list[str]]]:
    """Names that differ in one number alone, from the lowest number on."""
    found: dict[str, list[list[str]]] = {}
    for some in names:
        own = _own(some)
        if len({number for name in own for number in re.findall(r"\d+", name)}) == 1:
            found.setdefault(re.sub(r"\d+", "#", " ".join(some)), []).append(own)
    return [sorted(every, key=_number) for every in found.values()]


def _own(some: Sequence[str]) -> list[str]:
    """The names without a coordinate that is a number."""
    return [name for name in some if not name.isdigit()]


def _number(some: Sequence[str]) -> int:
    return int(re.findall(r"\d+", " ".join(some))[0])
