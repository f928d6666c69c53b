"""The marks of a drawing as SVG inside a page, and maps of a workspace as pictures that a page carries in itself."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Iterable
from html import escape
from typing import Any

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure

from derive.emit.picture import style
from derive.emit.picture.ink import Mark
from derive.emit.picture.vector import ALIKE, elements
from derive.report.workspace_map import Slice

_SETTINGS: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "softkin",
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": style.FAINT,
    "image.interpolation": "nearest",
}
_COUNTS = ("#ffffff", "#c6dbef", "#9ecae1", "#6baed6", "#4292c6", "#2171b5", "#08519c", "#08306b", "#041c40")
"""The colours of no solution, one, two, and so on."""
_LEAST = 1e-3
"""Margins below this have the darkest colour: there a pose is singular."""


def drawn(marks: Iterable[Mark], width: float, height: float, title: str) -> Markup:
    """Marks as one element, in their order."""
    inside = "".join(elements(marks, height))
    return Markup(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" role="img" '
        f"{ALIKE}><title>{escape(title)}</title>{inside}</svg>"
    )


def mapped(found: Slice, title: str) -> Markup:
    """A slice as a picture: the number of solutions, and the margin of the best."""
    with matplotlib.rc_context(_SETTINGS):
        figure = Figure(figsize=(8.6, 4.1), dpi=100, layout="constrained", facecolor=style.PAPER)
        left, right = figure.subplots(1, 2)
        _counted(figure, left, found)
        _measured(figure, right, found)
        for axes in (left, right):
            axes.set_xlabel(f"{found.along[0]} [u]")
            axes.set_ylabel(f"{found.along[1]} [u]")
            axes.plot(*found.tool, marker="o", markersize=5, markerfacecolor="#ffffff", markeredgecolor="#c23b30")
            axes.plot(0.0, 0.0, marker="+", markersize=9, color="#c23b30")
            axes.set_xlim(*found.ends[0])
            axes.set_ylim(*found.ends[1])
        file = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(file, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    data = b64encode(file.getvalue()).decode()
    return Markup(f'<img alt="{escape(title)}" src="data:image/svg+xml;base64,{data}"/>')


def _counted(figure: Figure, axes: Any, found: Slice) -> None:
    most = max(int(found.solutions.max()), 1)
    colours = [_COUNTS[min(k, len(_COUNTS) - 1)] for k in range(most + 1)]
    norm = BoundaryNorm(np.arange(-0.5, most + 1), most + 1)
    image = _image(axes, found, found.solutions, cmap=ListedColormap(colours), norm=norm)
    axes.set_title("Number of solutions")
    figure.colorbar(image, ax=axes, ticks=sorted({*range(0, most + 1, max(1, most // 8)), most}), shrink=0.85)


def _measured(figure: Figure, axes: Any, found: Slice) -> None:
    values = np.where(np.isnan(found.margin), np.nan, np.maximum(found.margin, _LEAST))
    top = float(np.nanmax(values)) if np.isfinite(values).any() else 1.0
    image = _image(axes, found, values, cmap="viridis", norm=LogNorm(_LEAST, max(top, 10.0 * _LEAST)))
    axes.set_title("Smallest margin, of the best solution")
    figure.colorbar(image, ax=axes, shrink=0.85)


def _image(axes: Any, found: Slice, values: Any, **colours: Any) -> Any:
    (left, right), (low, high) = found.ends
    return axes.imshow(values, origin="lower", extent=(left, right, low, high), aspect="equal", **colours)
