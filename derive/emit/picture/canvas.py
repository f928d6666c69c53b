"""Marks as PNG and SVG, by matplotlib. The same marks give the same bytes: no date, a fixed font, a fixed hash salt."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ft2font import FT2Font
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.text import Text as Letters
from PIL import Image

from derive.emit.picture import style
from derive.emit.picture.ink import Area, Line, Mark, Text

WIDTH = 900
_DOTS = 72
"""Pixels in an inch: a pixel is then a point, and both formats have the same coordinates."""
_FAMILY = b"font-family: 'DejaVu Sans'"
_FAMILIES = _FAMILY + b", Verdana, sans-serif"
"""A viewer that lacks the font takes one of the same width."""
_UNREAD = re.compile(rb' id="(?:line2d|patch|text|figure)_\d+"|<!--.*?-->\n?|(?<=\n) +')
"""What no viewer reads: names of marks that nothing refers to, comments, and spaces at the beginning of lines."""
_COLOURS = 128
_SETTINGS: Any = {
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "softkin",
    "font.family": "DejaVu Sans",
    "path.simplify": False,
    "text.hinting": "none",
}


@dataclass(frozen=True)
class Pictures:
    """One drawing as PNG and as SVG."""

    png: bytes
    svg: bytes


def pictures(marks: Iterable[Mark], height: int) -> Pictures:
    """The pictures of the marks, drawn in their order on a page of WIDTH × height pixels."""
    with matplotlib.rc_context(_SETTINGS):
        figure = Figure(figsize=(WIDTH / _DOTS, height / _DOTS), dpi=_DOTS, facecolor=style.PAPER)
        for order, mark in enumerate(marks):
            figure.add_artist(_artist(mark, order))
        return Pictures(_png(figure), _svg(figure))


def _artist(mark: Mark, order: int) -> Any:
    if isinstance(mark, Line):
        columns = list(zip(*mark.points, strict=True))
        dashes: dict[str, Any] = {"dashes": tuple(d / mark.width for d in mark.dashes)} if mark.dashes else {}
        return Line2D(
            *columns, color=mark.colour, linewidth=mark.width, zorder=order, transform=None,
            solid_capstyle="round", solid_joinstyle="round", dash_capstyle="butt", **dashes,
        )  # fmt: skip
    if isinstance(mark, Area):
        return Polygon(
            mark.points, closed=True, facecolor=mark.fill, edgecolor=mark.edge, linewidth=mark.width, zorder=order,
            transform=None, joinstyle="round",
        )  # fmt: skip
    return _text(mark, order)


def _text(mark: Text, order: int) -> Any:
    ground = {"facecolor": style.PAPER, "edgecolor": "none", "pad": 0.8, "alpha": 0.82} if mark.has_ground else None
    return Letters(
        *mark.at, mark.text, fontsize=mark.size, color=mark.colour, zorder=order, transform=None, parse_math=False,
        horizontalalignment="left" if mark.is_left else "center", verticalalignment="center_baseline",
        fontweight="bold" if mark.is_bold else "normal", bbox=ground,
    )  # fmt: skip


def _png(figure: Figure) -> bytes:
    canvas: Any = FigureCanvasAgg(figure)  # matplotlib types its canvases in part
    canvas.draw()
    image = Image.frombuffer("RGBA", canvas.get_width_height(), canvas.buffer_rgba(), "raw", "RGBA", 0, 1)
    few = image.convert("RGB").quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    file = io.BytesIO()
    few.save(file, format="PNG", compress_level=6)  # the last percent takes ten times as long
    return file.getvalue()


def _svg(figure: Figure) -> bytes:
    file = io.BytesIO()
    nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
    canvas: Any = FigureCanvasSVG(figure)
    canvas.print_svg(file, metadata=nothing)
    return _UNREAD.sub(b"", file.getvalue()).replace(_FAMILY, _FAMILIES)


@cache
def text_width(text: str, size: float, is_bold: bool = False) -> float:
    """The width of a text in pixels."""
    font = _font(is_bold)
    font.set_size(size, _DOTS)
    font.set_text(text, 0.0)
    return float(font.get_width_height()[0]) / 64.0


@cache
def _font(is_bold: bool) -> FT2Font:
    name = "DejaVuSans-Bold.ttf" if is_bold else "DejaVuSans.ttf"
    return FT2Font(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name))
