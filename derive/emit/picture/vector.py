"""Marks as SVG, in their order. Text stays text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import escape

from derive.emit.picture import style
from derive.emit.picture.ink import Area, Line, Mark, Spot, Text

_FAMILY = "DejaVu Sans, Verdana, sans-serif"
"""A viewer that lacks the font takes one of the same width."""
ALIKE = f'font-family="{_FAMILY}" stroke-linejoin="round" stroke-linecap="round"'
"""Attributes that all elements have in common; their parent element has them."""
MIDDLE = 0.35
"""The height of the middle of small letters above their line, as a share of their size."""


def svg(marks: Iterable[Mark], width: float, height: float) -> bytes:
    """The marks as a file, on paper."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
        f'viewBox="0 0 {width:g} {height:g}" {ALIKE}>'
    )
    paper = f'<rect width="{width:g}" height="{height:g}" fill="{style.PAPER}"/>'
    return "\n".join([head, paper, *elements(marks, height), "</svg>", ""]).encode()


def elements(marks: Iterable[Mark], height: float) -> Iterator[str]:
    """An element for each mark; y is downward in SVG."""
    for mark in marks:
        yield _letters(mark, height) if isinstance(mark, Text) else _shape(mark, height)


def _shape(mark: Line | Area, height: float) -> str:
    points = " ".join(_point(spot, height) for spot in mark.points)
    if isinstance(mark, Area):
        return f'<polygon points="{points}" fill="{mark.fill}" stroke="{mark.edge}" stroke-width="{mark.width:g}"/>'
    lengths = " ".join(f"{length:g}" for length in mark.dashes)
    dashes = f' stroke-dasharray="{lengths}" stroke-linecap="butt"' if mark.dashes else ""
    return f'<polyline points="{points}" fill="none" stroke="{mark.colour}" stroke-width="{mark.width:g}"{dashes}/>'


def _point(spot: Spot, height: float) -> str:
    return f"{spot[0]:g},{round(height - spot[1], 1):g}"


def _letters(mark: Text, height: float) -> str:
    x, y = mark.at
    anchor = "" if mark.is_left else ' text-anchor="middle"'
    weight = ' font-weight="bold"' if mark.is_bold else ""
    halo = f' paint-order="stroke" stroke="{style.PAPER}" stroke-width="3"' if mark.has_ground else ""
    down = height - y + MIDDLE * mark.size  # not every viewer knows dominant-baseline
    return (
        f'<text x="{x:g}" y="{down:.5g}" font-size="{mark.size:g}" fill="{mark.colour}"{anchor}{weight}{halo}>'
        f"{escape(mark.text)}</text>"
    )
