"""Names on the page: of joints, frames and points, and dimensions with their lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from derive.drawing.scene import Dimension, Slide, Turn
from derive.emit.picture import style
from derive.emit.picture.canvas import text_width
from derive.emit.picture.ink import Mark, Vector, head, line
from derive.emit.picture.placing import Place, Sheet, around
from derive.emit.picture.symbols import BESIDE, STEPS, arc
from derive.emit.picture.view import View

_SECOND = 45.0
"""The cost of a leader where a dimension line has room."""
_FREE = 12.0
"""How far the ends of a dimension line must be from its text, in pixels."""
_SHORT = 26.0
"""A dimension shorter than this on the page has a leader instead of a dimension line."""


def name_turn(sheet: Sheet, view: View, turn: Turn, text: str, at: Vector, radius: float) -> None:
    """The name of a rotary axis, at its arrow."""
    if view.is_planar:
        middle = arc(turn, at, radius, view)[2 * STEPS // 3]
        places = around(middle, (12.0, 18.0, 26.0), toward=(middle - at) / radius)
    else:
        places = around(at + BESIDE * view.direction(turn.axis), (radius + 10.0, radius + 18.0, radius + 30.0))
    sheet.label(text, style.NAME, style.TURN, places, is_bold=True)


def name_slide(sheet: Sheet, view: View, slide: Slide, text: str, tip: Vector) -> None:
    """The name of a linear axis at the tip of its arrow; on a rail that drives share, their motion at its end."""
    along = view.direction(slide.axis)
    toward = along / max(float(np.linalg.norm(along)), 1e-9)
    reach = 14.0 + abs(float(toward[0])) * max(0.0, 3.8 * len(text) - 8.0)
    size, colour = (style.NAME, style.SLIDE) if slide.has_arrow else (style.LABEL, style.FAINT)
    if not slide.has_arrow and max(slide.axis) > 0.999:
        text = f"{'XYZ'[int(np.argmax(slide.axis))]} = {text}"
    places = around(tip, (reach, reach + 10.0, reach + 24.0), toward=toward)
    half = 0.5 * text_width(text, size, slide.has_arrow)
    sides = [Place(p.at + [side * half, 0.0], p.cost + 15.0) for side in (-1.0, 1.0) for p in places]
    sheet.label(text, size, colour, [*places, *sides], is_bold=slide.has_arrow)


def name_axes(
    sheet: Sheet, letters: str, tips: Sequence[tuple[Vector, list[Mark]]], distances: Sequence[float] = (10.0, 15.0)
) -> None:
    """The letters of a frame at the tips of its axes; an axis that points to the viewer has no letter."""
    for letter, colour, (tip, marks) in zip(letters, style.AXES, tips, strict=True):
        if marks:
            sheet.label(letter, style.LABEL, colour, around(tip, distances), is_bold=True)


def name_point(sheet: Sheet, text: str, at: Vector) -> None:
    """The coordinates of a point, with a leader where they do not stand beside it."""
    places = []
    for place in around(at, (16.0, 26.0, 40.0, 56.0, 76.0, 100.0)):
        is_far = bool(np.linalg.norm(place.at - at) > 30.0)
        leader = (line([at, place.at], style.FAINT, 0.8),) if is_far else ()
        places.append(Place(place.at + _aside(place.at, at, 3.2 * len(text)), place.cost, leader))
    sheet.label(text, style.LABEL, style.INK, places)


def name_angle(sheet: Sheet, text: str, at: Vector, points: Sequence[Vector]) -> None:
    """The name of an angle, outside of its arc."""
    middle = points[len(points) // 2]
    toward = (middle - at) / max(float(np.linalg.norm(middle - at)), 1e-9)
    places = around(middle, (12.0, 20.0, 32.0), toward=toward)
    aside = []
    for place in [*places, *around(middle, (46.0, 62.0), toward=toward)]:
        is_far = float(np.linalg.norm(place.at - middle)) > 24.0
        leader = (line([middle, place.at], style.FAINT, 0.9),) if is_far else ()
        aside.append(Place(place.at + _aside(place.at, middle, 3.2 * len(text)), place.cost, leader))
    sheet.label(text, style.LABEL, style.INK, aside)


def name_length(sheet: Sheet, view: View, dimension: Dimension, text: str) -> None:
    """A dimension line beside the length that it measures; a leader to the middle of a length that is too short."""
    start, end = view.page(dimension.start), view.page(dimension.end)
    length = float(np.linalg.norm(end - start))
    sheet.label(
        text,
        style.LABEL,
        style.INK,
        [
            *(_lines(start, end, text_width(text, style.LABEL)) if length > _SHORT else ()),
            *_leaders(start, end, text_width(text, style.LABEL), length > _SHORT),
        ],
    )


def _lines(start: Vector, end: Vector, wide: float) -> list[Place]:
    """Places on a dimension line; a text that covers most of its line stands better elsewhere."""
    along = (end - start) / float(np.linalg.norm(end - start))
    across = np.array([-along[1], along[0]])
    covering = _SECOND if abs(along[0]) * np.linalg.norm(end - start) < wide and abs(along[0]) > 0.5 else 0.0
    found, ends = [], np.array([start, end])
    for distance in (24.0, -24.0, 38.0, -38.0, 54.0, -54.0, 72.0, -72.0):
        aside = distance * across
        for part in (0.5, 0.35, 0.65, 0.2, 0.8):
            at = start + part * (end - start) + aside
            if part != 0.5 and _gap(at, ends + aside, wide) < _FREE:
                continue  # the text would hide an end of its line
            cost = 0.35 * abs(distance) + 40.0 * abs(part - 0.5) + covering
            found.append(Place(at, cost, _measured(start, end, aside)))
    return found


def _gap(at: Vector, points: Vector, wide: float) -> float:
    """How far the nearest of some points is outside of a text that stands at a place; negative inside of it."""
    return float(np.min(np.max(np.abs(points - at) - np.array([wide / 2, 0.7 * style.LABEL]), axis=1)))


def _leaders(start: Vector, end: Vector, wide: float, is_second: bool) -> list[Place]:
    """Places with a leader: the only ones of a short length, the second choice of another."""
    middle = (start + end) / 2
    line_of_length, dot = line([start, end], style.INK, 2.0), line([middle, middle + 0.1], style.INK, 5.0)
    points = start + np.linspace(0, 1, 9)[:, None] * (end - start)
    found = []
    for place in around(middle, (26.0, 40.0, 58.0, 80.0, 104.0)):
        marks = (line_of_length, line([middle, place.at], style.FAINT, 0.9), dot)
        at = place.at + _aside(place.at, middle, 0.45 * wide)
        covering = _SECOND * (_gap(at, points, wide) < 2.0)
        found.append(Place(at, 0.3 * place.cost + _SECOND * is_second + covering, marks))
    return found


def _aside(place: Vector, at: Vector, shift: float) -> Vector:
    return np.array([float(np.sign(np.round(place[0] - at[0], 3))) * shift, 0.0])


def _measured(start: Vector, end: Vector, aside: Vector) -> tuple[Mark, ...]:
    """A dimension line with two heads, and its extension lines."""
    first, last = start + aside, end + aside
    over = aside / float(np.linalg.norm(aside)) * 4.0
    return (
        line([start, first + over], style.FAINT, 0.8),
        line([end, last + over], style.FAINT, 0.8),
        line([first, last], style.FAINT, 1.1),
        head(first, start - end, style.FAINT, 0.8),
        head(last, end - start, style.FAINT, 0.8),
    )


def name_motor(sheet: Sheet, text: str, at: Vector, radius: float) -> None:
    """The name of a motor, beside its arrow."""
    sheet.label(
        text,
        style.NAME,
        style.TURN,
        [
            Place(place.at + _aside(place.at, at, 3.0 * len(text)), place.cost)
            for place in around(at, (radius + 10.0, radius + 18.0, radius + 30.0))
        ],
        is_bold=True,
    )


def spelled(label: sp.Expr, names: Mapping[str, str]) -> str:
    """`A3 - A4*pitch_zc/360` → `A3 − A4·dPitchZC/360°`."""
    terms = sorted(sp.Add.make_args(label), key=lambda t: (t.could_extract_minus_sign(), sp.count_ops(t), str(t)))
    sizes = {abs(term.as_coeff_Mul()[0]) for term in terms}
    if len(terms) > 1 and sizes != {1} and len(sizes) == 1:
        (common,) = sizes
        return _over(f"({spelled(sp.expand(label / common), names)})", common)
    text = ""
    for term in terms:
        minus = term.could_extract_minus_sign()
        text += (" − " if minus else " + ") if text else ("−" if minus else "")
        text += _product(-term if minus else term, names)
    return text


def _product(term: sp.Expr, names: Mapping[str, str]) -> str:
    coefficient, rest = term.as_coeff_Mul()
    if rest == 1:
        return f"{float(coefficient):g}"
    factors = sorted(str(f) for f in sp.Mul.make_args(rest))
    return _over("·".join(names.get(f, f) for f in factors), coefficient)


def _over(text: str, coefficient: sp.Rational) -> str:
    if coefficient.q != 1:
        text += f"/{coefficient.q}" + ("°" if coefficient.q == 360 else "")
    return text if coefficient.p == 1 else f"{coefficient.p}·{text}"


def in_short(names: Sequence[str]) -> str:
    """Names that differ in their last letter, as one of them and the letters of the others."""
    begins = {name[:-1] for name in names}
    if len(names) > 1 and len(begins) == 1 and all(name[-1:].isalpha() for name in names):
        return ", ".join([names[0], *(name[-1] for name in names[1:])])
    return ", ".join(names)
