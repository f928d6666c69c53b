"""The pages: one with the machine, its joints and dimensions, and one with the choices of its configuration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from derive.drawing.drawing import Drawing
from derive.emit.picture import style, words
from derive.emit.picture.canvas import text_width
from derive.emit.picture.ink import Mark, Text, moved
from derive.emit.picture.machine import MARGINS, Machine, Margins
from derive.emit.picture.naming import spelled
from derive.emit.picture.panel import HEIGHT, chosen, panels
from derive.emit.picture.placing import extent
from derive.emit.picture.series import without_series
from derive.emit.picture.view import Box

_PAD, _HEAD = 10.0, 30.0
"""The edge of a page, and the height of its heading."""
_HIGHEST, _LOWEST, _NARROWEST = 400.0, 260.0, 180.0
"""The greatest height of a machine, the height to which one that is narrow shrinks, and the least width of a page."""
_ASPECT = 1.1
"""The greatest height of a page, as a share of its width."""
_COLUMN = 160.0
"""The width of a column of text beside a machine that is high and narrow."""
_ROUNDS = 2
"""The number of times that the machine is fitted to the room that its names leave."""
_PANEL = 340.0
"""The width of a page with one choice."""


@dataclass(frozen=True)
class Page:
    """All marks of a picture, and its size."""

    marks: tuple[Mark, ...]
    width: int
    height: int


def page(drawing: Drawing, title: str, names: Mapping[str, str]) -> Page:
    """The picture of a mechanism, as large as it needs to be; `names` holds the spelling of parameters."""
    scene, likewise = without_series(drawing.scene, lambda label: spelled(label, names))
    sentences = list(words.of_machine(drawing, likewise, names))
    sentences += [] if chosen(drawing) else words.of_choices(drawing, ())
    drawing = replace(drawing, scene=scene)
    marks, (wide, high) = _machine(drawing, names, _HIGHEST)
    fitting = max(_ASPECT * (wide + 2 * _PAD) - _HEAD - 2 * _PAD - 2 * words.ROW, _LOWEST)
    if high > fitting:  # names are as wide beside a lower machine, and a narrower page shows them larger
        marks, (wide, high) = _machine(drawing, names, fitting)
    heading = text_width(title, style.TITLE, True) + 2 * _PAD
    below = _below(sentences, max(wide + 2 * _PAD, heading, _NARROWEST), high)
    beside = _beside(sentences, max(wide + 3 * _PAD + _COLUMN, heading), (wide, high))
    width, height, lines = min(below, beside, key=lambda found: found[0])
    if width < below[0]:
        text = words.written(lines, wide + 2 * _PAD, height - _HEAD)
        marks = moved(marks, _PAD, height - _HEAD - high)
    else:
        text = words.written(lines, _PAD, _PAD + words.ROW * len(lines))
        marks = moved(marks, (width - wide) / 2, 2 * _PAD + words.ROW * len(lines))
    return Page((*marks, _heading(title, height), *text), round(width), round(height))


def _below(sentences: Sequence[str], width: float, high: float) -> tuple[float, float, list[str]]:
    """The size of a page with the text below the machine, and the lines of the text."""
    lines = words.rows(sentences, max(width, (_HEAD + high + 2 * _PAD + words.ROW) / _ASPECT) - 2 * _PAD)
    height = _HEAD + high + 2 * _PAD + words.ROW * len(lines)
    return max(width, height / _ASPECT), height, lines


def _beside(sentences: Sequence[str], width: float, machine: tuple[float, float]) -> tuple[float, float, list[str]]:
    """The size of a page with the text beside the machine, and the lines of the text."""
    width = max(width, (_HEAD + machine[1] + _PAD) / _ASPECT)
    lines = words.rows(sentences, width - machine[0] - 3 * _PAD)
    height = _HEAD + max(machine[1], words.ROW * len(lines)) + _PAD
    return max(width, height / _ASPECT), height, lines


def _machine(
    drawing: Drawing, names: Mapping[str, str], highest: float, margins: Margins = MARGINS, rounds: int = _ROUNDS
) -> tuple[list[Mark], tuple[float, float]]:
    """The machine from the corner of the page on, as large as it can be with its names, and its size."""
    machine = Machine(drawing, Box(0.0, 0.0, style.WIDTH - 2 * _PAD, highest), names, margins)
    marks = machine.drawn()
    own, whole = machine.extent, extent(marks)
    if rounds:
        sides = (own.left - whole.left, own.bottom - whole.bottom, whole.right - own.right, whole.top - own.top)
        left, below, right, above = (max(side, 0.0) + 1.0 for side in sides)
        return _machine(drawing, names, highest, (left, below, right, above), rounds - 1)
    return moved(marks, -whole.left, -whole.bottom), (whole.right - whole.left, whole.top - whole.bottom)


def choices_page(drawing: Drawing, title: str) -> Page | None:
    """The picture of the choices; None if there are none that look different."""
    choices = chosen(drawing)
    if not choices:
        return None
    columns = min(2, len(choices))
    width = style.WIDTH if columns == 2 else _PANEL
    sentences = list(words.of_choices(drawing, [choice for _, choice in choices]))
    is_free = len(choices) % 2 == 1 and columns == 2
    cell = (width - 2 * _PAD) / columns
    lines = words.rows(sentences, cell - _PAD if is_free else width - 2 * _PAD)
    below = 0.0 if is_free else words.ROW * len(lines)
    count = -(-len(choices) // columns)
    height = _HEAD + HEIGHT * count + _PAD + below
    top = height - _HEAD
    boxes = [
        Box(
            _PAD + cell * (k % 2),
            top - HEIGHT * (k // 2 + 1),
            _PAD + cell * (k % 2 + 1) - _PAD,
            top - HEIGHT * (k // 2),
        )
        for k in range(len(choices) + 1)
    ]
    text = (
        words.written(lines, boxes[-1].left, boxes[-1].top) if is_free else words.written(lines, _PAD, _PAD / 2 + below)
    )
    shown = panels(choices, boxes[:-1], plane=drawing.plane)
    return Page((*shown, _heading(title, height), *text), round(width), round(height))


def pages(drawing: Drawing, title: str, names: Mapping[str, str]) -> tuple[Page, ...]:
    """All pictures of a mechanism."""
    second = choices_page(drawing, title)
    return (page(drawing, title, names), *(() if second is None else (second,)))


def _heading(title: str, height: float) -> Mark:
    return Text(title, (_PAD, height - _HEAD / 2), style.TITLE, style.INK, is_left=True, is_bold=True)
