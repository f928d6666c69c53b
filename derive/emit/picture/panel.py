"""The choices of a configuration: small pictures in which both poses are drawn over each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from derive.drawing.drawing import Choice, Drawing, is_turned_round, looks_alike
from derive.drawing.scene import ORIGIN, Body, Scene, Turn
from derive.emit.picture import style
from derive.emit.picture.ink import Mark, Text, Vector, area, arrow, line
from derive.emit.picture.naming import name_axes
from derive.emit.picture.placing import Sheet, around
from derive.emit.picture.symbols import triad
from derive.emit.picture.view import Box, View, fitted

_MOST = 4
"""The most small pictures on a page."""
HEIGHT = 200.0
"""The height of one small picture."""
_FRAME, _AXIS = 20.0, 34.0
"""In pixels: the axes of a frame in a small picture, and the axis of a joint that the choice turns round."""
_FIRST, _SECOND = style.INK, "#d07a1c"


def chosen(drawing: Drawing) -> list[tuple[str, Choice]]:
    """The choices that are shown, as many as have room: the assembly mode, and branches with different poses."""
    shown = [(f"Byte {k}, {c.name}", c) for k, c in enumerate(drawing.choices) if c.scenes is not None]
    assembly = drawing.assembly
    ways = [("Assembly", assembly)] if assembly is not None and assembly.scenes is not None else []
    return [*shown[: _MOST - len(ways)], *ways]


def panels(choices: Sequence[tuple[str, Choice]], boxes: Sequence[Box], *, plane: tuple[int, int] | None) -> list[Mark]:
    """The small pictures, each in its box."""
    pairs = zip(choices, boxes, strict=True)
    return [mark for (heading, choice), box in pairs for mark in _panel(heading, choice, box, plane)]


def _panel(heading: str, choice: Choice, box: Box, plane: tuple[int, int] | None) -> Iterator[Mark]:
    assert choice.scenes is not None
    left = box.left
    yield Text(heading, (left, box.top - 10.0), style.SMALL, style.INK, is_left=True, is_bold=True)
    numbers = ("1 ", "2 ") if heading.startswith("Byte") else ("", "")
    yield line([(left, box.top - 28.0), (left + 16.0, box.top - 28.0)], _FIRST, 3.0)
    yield Text(numbers[0] + choice.names[0], (left + 21.0, box.top - 28.0), style.SMALL, _FIRST, is_left=True)
    half = (box.left + box.right) / 2
    yield line([(half, box.top - 28.0), (half + 16.0, box.top - 28.0)], _SECOND, 2.4, (5.0, 3.0))
    yield Text(numbers[1] + choice.names[1], (half + 21.0, box.top - 28.0), style.SMALL, _SECOND, is_left=True)
    points = [p for scene in choice.scenes for s in scene.segments for p in (s.start, s.end)]
    points += [ORIGIN.position, *(scene.tool.position for scene in choice.scenes)]
    inside = Box(left + 14.0, box.bottom + 18.0, box.right - 24.0, box.top - 60.0)
    view = fitted(points, inside, plane=plane)
    sheet = Sheet(Box(left, box.bottom, box.right, box.top - 38.0))
    for ground in choice.scenes[0].grounds:
        sheet.draw([_foot(view.page(ground), view)])
    sheet.draw(_skeleton(choice.scenes[0], view, _FIRST, 3.6, ()))
    sheet.draw(_skeleton(choice.scenes[1], view, _SECOND, 2.4, (5.0, 3.0)))
    base = triad(ORIGIN, _FRAME, 1.5, view)
    sheet.draw(mark for _, marks in base for mark in marks)
    name_axes(sheet, "XYZ", base, (7.0, 10.0, 14.0))
    for scene, colour in zip(choice.scenes, (_FIRST, _SECOND), strict=True):
        sheet.draw(mark for _, marks in triad(scene.tool, 0.8 * _FRAME, 1.5, view) for mark in marks)
        sheet.draw(mark for turn in _turned(choice.scenes, scene) for mark in _axis(turn, view, colour))
    for turn in _turned(choice.scenes, choice.scenes[0]):
        sheet.label(str(turn.label), style.SMALL, style.TURN, around(view.page(turn.at), (16.0, 24.0, 34.0)))
    yield from sheet.settled()


def _foot(at: Vector, view: View) -> Mark:
    """The base of the machine, small."""
    sides = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    return area([at + 7.0 * (view.axes @ np.array([x, y, 0.0])) for x, y in sides], style.BASE, style.FAINT, 0.8)


def _turned(scenes: tuple[Scene, Scene], scene: Scene) -> list[Turn]:
    """The joints whose axes the choice turns round, where nothing else of the machine moves."""
    first, second = scenes
    if not looks_alike(first, second):
        return []
    pairs = zip(first.turns, second.turns, scene.turns, strict=True)
    return [turn for one, other, turn in pairs if is_turned_round(one, other)]


def _axis(turn: Turn, view: View, colour: str) -> list[Mark]:
    """The axis of a joint, as an arrow about which a positive turn is counter-clockwise."""
    at = view.page(turn.at)
    return arrow([at, at + _AXIS * view.direction(turn.axis)], colour, 2.2)


def _skeleton(scene: Scene, view: View, colour: str, width: float, dashes: Sequence[float]) -> Iterator[Mark]:
    for segment in scene.segments:
        if segment.body is not Body.BASE:
            yield line([view.page(segment.start), view.page(segment.end)], colour, width, tuple(dashes))
