"""Marks as PNG, by the renderer of matplotlib, and as SVG. The same marks give the same bytes."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backend_bases import GraphicsContextBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgb
from matplotlib.ft2font import FT2Font, LoadFlags
from matplotlib.path import Path as Outline
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray
from PIL import Image

from derive.emit.picture import style
from derive.emit.picture.ink import Area, Line, Mark, Spot, Text

_FINE = 2
"""Pixels of a PNG for each of them, for windows with small pixels."""
_DOTS = 72.0
"""Units of the page in an inch: a unit is then a point, and both formats have the same coordinates."""
_PART = 64
"""A pixel in the units of a font."""
_GROUND = 0.82
"""The opacity of the ground behind a text."""
_SHADES = 8
"""Steps from the colour of a mark to that of the paper, for the pixels that the mark covers in part."""
Bytes = NDArray[np.uint8]
_RENDERER: Any = RendererAgg
"""matplotlib types it in part."""


@dataclass(frozen=True)
class Pictures:
    """One drawing as PNG and as SVG."""

    png: bytes
    svg: bytes


def pictures(marks: Sequence[Mark], width: int, height: int) -> Pictures:
    """The pictures of the marks, drawn in their order on a page of this size."""
    return Pictures(_png(marks, width, height), svg(marks, width, height))


def _png(marks: Sequence[Mark], width: int, height: int) -> bytes:
    page = _Page(width, height)
    for mark in marks:
        page.draw(mark)
    picture = _in_colours(page.pixels, _palette(marks))
    file = io.BytesIO()
    picture.save(file, format="PNG", compress_level=6)  # the last percent takes ten times as long
    return file.getvalue()


class _Page:
    """A page on which matplotlib draws. Its renderer is used without figures and artists, which would take most of the
    time of a drawing.
    """

    def __init__(self, width: int, height: int) -> None:
        self._scale = _FINE * style.SHOWN / width
        self._renderer = _RENDERER(_FINE * style.SHOWN, round(self._scale * height), self._scale * _DOTS)
        self._fill(((0.0, 0.0), (width, 0.0), (width, height + 1.0), (0.0, height + 1.0)))

    @property
    def pixels(self) -> Bytes:
        """Its pixels: rows from above, columns, and four bytes, red first."""
        return np.asarray(self._renderer.buffer_rgba())

    def draw(self, mark: Mark) -> None:
        """Draw a mark over those before."""
        if isinstance(mark, Text):
            self._write(mark)
            return
        pen: Any = GraphicsContextBase()
        pen.set_linewidth(mark.width)
        pen.set_joinstyle("round")
        if isinstance(mark, Area):
            pen.set_foreground(mark.edge)
            self._outline(pen, (*mark.points, mark.points[0]), to_rgb(mark.fill))
            return
        pen.set_foreground(mark.colour)
        pen.set_capstyle("butt" if mark.dashes else "round")
        if mark.dashes:
            pen.set_dashes(0.0, mark.dashes)
        self._outline(pen, mark.points)

    def _write(self, text: Text) -> None:
        letters, size = _letters(text.text, text.size, text.is_bold, self._scale), text.size
        left, base = text.at[0] - (0.0 if text.is_left else letters.width / 2), text.at[1] - MIDDLE * size
        if text.has_ground:
            right, low, high = left + letters.width + 1.0, base - 0.25 * size, base + 0.8 * size
            self._fill(((left - 1.0, low), (right, low), (right, high), (left - 1.0, high)), _GROUND)
        image = np.empty((*letters.covered.shape, 4), dtype=np.uint8)
        image[:, :, :3], image[:, :, 3] = _bytes_of(text.colour), letters.covered
        x, y = round(self._scale * left + letters.aside), round(self._scale * base) + letters.up
        self._renderer.draw_image(GraphicsContextBase(), x, y, image)

    def _fill(self, corners: Sequence[Spot], share: float = 1.0) -> None:
        """Cover an area with paper."""
        pen: Any = GraphicsContextBase()
        pen.set_linewidth(0.0)
        pen.set_alpha(share)
        self._outline(pen, (*corners, corners[0]), to_rgb(style.PAPER))

    def _outline(self, pen: Any, points: Sequence[Spot], fill: tuple[float, float, float] | None = None) -> None:
        self._renderer.draw_path(pen, Outline(points, closed=fill is not None), Affine2D().scale(self._scale), fill)


def _palette(marks: Iterable[Mark]) -> Bytes:
    """The colours of a picture: that of the paper, and those of the marks in steps to it."""
    found = (c for m in marks for c in ((m.fill, m.edge) if isinstance(m, Area) else (m.colour,)))
    colours = np.array([_bytes_of(colour) for colour in dict.fromkeys(found)])
    paper = np.array(_bytes_of(style.PAPER))
    steps = [paper + (colours - paper) * (step / _SHADES) for step in range(1, _SHADES + 1)]
    return np.round(np.vstack([paper[None], *steps])).astype(np.uint8)


def _in_colours(pixels: Bytes, palette: Bytes) -> Image.Image:
    """The picture with every pixel in the nearest of these colours, the first of which is that of most pixels."""
    whole = np.ascontiguousarray(pixels).view(np.uint32)[:, :, 0]
    is_drawn = whole != whole[0, 0]
    found, places = np.unique(whole[is_drawn], return_inverse=True)
    colours, known = (table[:, :3].astype(float) for table in (found.view(np.uint8).reshape(-1, 4), palette))
    nearest = np.argmin(np.sum(known**2, axis=1) - 2.0 * colours @ known.T, axis=1)
    numbers = np.zeros(whole.shape, dtype=np.uint8)
    numbers[is_drawn] = nearest[places]
    picture = Image.fromarray(numbers, "P")
    picture.putpalette(palette.tobytes())
    return picture


@cache
def _bytes_of(colour: str) -> tuple[int, int, int]:
    """`#22272e` as numbers up to 255."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def text_width(text: str, size: float, is_bold: bool = False) -> float:
    """The width of a text."""
    return _letters(text, size, is_bold, 1.0).width


@dataclass(frozen=True)
class _Letters:
    """A text as pixels."""

    width: float
    """Its width on the page."""
    covered: Bytes
    """How much of each pixel it covers, in rows from below."""
    aside: float
    """The position of the first column, from the begin of its line; `up` is the position of the first row."""
    up: int


@cache
def _letters(text: str, size: float, is_bold: bool, scale: float) -> _Letters:
    """A text as pixels. Cached: machines share texts."""
    font = _font(is_bold)
    font.set_size(size, scale * _DOTS)
    font.set_text(text, 0.0, flags=LoadFlags.NO_HINTING)
    font.draw_glyphs_to_bitmap(antialiased=True)
    width, height = font.get_width_height()
    covered = np.array(font.get_image())[::-1]
    top = math.ceil((height - font.get_descent()) / _PART)
    return _Letters(width / _PART / scale, covered, font.get_bitmap_offset()[0] / _PART, top - len(covered))


@cache
def _font(is_bold: bool) -> FT2Font:
    """From memory: letters are read when they are drawn, and processes that share an open file read each other's."""
    name = "DejaVuSans-Bold.ttf" if is_bold else "DejaVuSans.ttf"
    return FT2Font(io.BytesIO((Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name).read_bytes()))


_FAMILY = "DejaVu Sans, Verdana, sans-serif"
"""A viewer that lacks the font takes one of the same width."""
ALIKE = f'font-family="{_FAMILY}" stroke-linejoin="round" stroke-linecap="round"'
"""Attributes that all elements have in common; their parent element has them."""
MIDDLE = 0.35
"""The height of the middle of small letters above their line, as a share of their size."""


def svg(marks: Iterable[Mark], width: float, height: float) -> bytes:
    """The marks as a file, on paper, as wide as it is shown."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{style.SHOWN}" height="{style.SHOWN * height / width:.5g}" '
        f'viewBox="0 0 {width:g} {height:g}" {ALIKE}>'
    )
    paper = f'<rect width="{width:g}" height="{height:g}" fill="{style.PAPER}"/>'
    return "\n".join([head, paper, *elements(marks, height), "</svg>", ""]).encode()


def elements(marks: Iterable[Mark], height: float) -> Iterator[str]:
    """An element for each mark; y is downward in SVG."""
    for mark in marks:
        yield _text_element(mark, height) if isinstance(mark, Text) else _shape(mark, height)


def _shape(mark: Line | Area, height: float) -> str:
    points = " ".join(_point(spot, height) for spot in mark.points)
    if isinstance(mark, Area):
        return f'<polygon points="{points}" fill="{mark.fill}" stroke="{mark.edge}" stroke-width="{mark.width:g}"/>'
    lengths = " ".join(f"{length:g}" for length in mark.dashes)
    dashes = f' stroke-dasharray="{lengths}" stroke-linecap="butt"' if mark.dashes else ""
    return f'<polyline points="{points}" fill="none" stroke="{mark.colour}" stroke-width="{mark.width:g}"{dashes}/>'


def _point(spot: Spot, height: float) -> str:
    return f"{spot[0]:g},{round(height - spot[1], 1):g}"


def _text_element(mark: Text, height: float) -> str:
    x, y = mark.at
    anchor = "" if mark.is_left else ' text-anchor="middle"'
    weight = ' font-weight="bold"' if mark.is_bold else ""
    halo = f' paint-order="stroke" stroke="{style.PAPER}" stroke-width="3"' if mark.has_ground else ""
    down = height - y + MIDDLE * mark.size  # not every viewer knows dominant-baseline
    return (
        f'<text x="{x:g}" y="{down:.5g}" font-size="{mark.size:g}" fill="{mark.colour}"{anchor}{weight}{halo}>'
        f"{escape(mark.text)}</text>"
    )
