"""Rails of linear motions, and the arrows beside them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from derive.drawing.scene import Point, Scene, Slide
from derive.emit.picture import style
from derive.emit.picture.ink import Mark, Vector, arrow
from derive.emit.picture.view import View

_TRAVEL = 0.34
"""The length of a rail over the size of the machine."""
FREE = 100.0
"""The size with which a machine without lengths is drawn."""
_BACK = 0.25
"""The part of a rail that lies behind its zero."""
_ASIDE, _ALONE = 15.0, 64.0
"""In pixels: the distance of an arrow from its rail, and the length of an arrow without a rail."""

Ends = tuple[Point, Point]


def rails(scene: Scene) -> dict[Slide, Ends]:
    """The ends of every rail. Rails that begin at one point are drawn one on the other, as slides are mounted."""
    travel = _TRAVEL * (scene.size or FREE)
    above: dict[Point, Vector] = {}
    found = {}
    for slide in scene.slides:
        axis, at = np.array(slide.axis), np.array(slide.at)
        start = above.get(slide.at)
        back = 0.0 if start is not None else _BACK if slide.has_arrow else 1.0
        first = at + (np.zeros(3) if start is None else start)
        found[slide] = (_point(first - back * travel * axis), _point(first + travel * axis))
        if slide.has_rail and slide.has_arrow:
            above[slide.at] = first - at + travel * axis
    return found


def is_stacked(scene: Scene) -> bool:
    """Whether several rails begin at one point."""
    places = [slide.at for slide in scene.slides if slide.has_rail and slide.has_arrow]
    return len(set(places)) < len(places)


def slide_arrow(slide: Slide, ends: Ends, view: View, *, is_beside: bool) -> Iterator[Mark]:
    """The arrow in the positive direction, along the rail if there is one; else `is_beside` moves it off a bar."""
    if not slide.has_arrow:
        return
    along = view.direction(slide.axis)
    unit = along / max(float(np.linalg.norm(along)), 1e-9)
    aside = _ASIDE * np.array([-unit[1], unit[0]])
    if slide.has_rail:
        start, end = view.page(_on_rail(slide.at, ends)), view.page(ends[1])
        yield from arrow([start + 0.2 * (end - start) + aside, start + 0.9 * (end - start) + aside], style.SLIDE, 2.4)
        return
    first = view.page(slide.at) + (aside if is_beside else 0.0)
    yield from arrow([first, first + _ALONE * along / max(float(np.linalg.norm(along)), 0.5)], style.SLIDE, 2.4)


def _on_rail(place: Point, ends: Ends) -> Point:
    """The point of a rail nearest to a place: its zero, or the beginning of a rail that stands on another."""
    begin, end = map(np.array, ends)
    along = end - begin
    return _point(begin + np.clip((np.array(place) - begin) @ along / (along @ along), 0.0, 1.0) * along)


def _point(values: Vector) -> Point:
    x, y, z = (float(v) for v in values)
    return (x, y, z)
