"""The choices of a configuration: small pictures in which both poses are drawn over each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from derive.drawing.drawing import Choice, Drawing
from derive.drawing.scene import Body, Scene
from derive.emit.picture import style
from derive.emit.picture.ink import Mark, Text, line
from derive.emit.picture.view import Box, View, fitted

_MOST = 3
"""The most small pictures on a page."""
HEIGHT = 180.0
"""The height of one small picture."""
_FIRST, _SECOND = style.INK, "#d07a1c"


def chosen(drawing: Drawing) -> list[tuple[str, Choice]]:
    """The choices that are shown, as many as have room: the assembly mode, and branches with different poses."""
    shown = [(f"Byte {k}, {c.name}", c) for k, c in enumerate(drawing.choices) if c.scenes is not None]
    assembly = drawing.assembly
    ways = [("Assembly", assembly)] if assembly is not None and assembly.scenes is not None else []
    return [*shown[: _MOST - len(ways)], *ways]


def panels(choices: Sequence[tuple[str, Choice]], box: Box, *, is_planar: bool) -> list[Mark]:
    """The small pictures, one below the other."""
    marks: list[Mark] = []
    if choices:
        marks.append(
            line([(box.left - 8.0, box.top), (box.left - 8.0, box.top - HEIGHT * len(choices))], style.LINK, 0.8)
        )
    for row, (heading, choice) in enumerate(choices):
        top = box.top - row * HEIGHT
        marks += _panel(heading, choice, Box(box.left, top - HEIGHT, box.right, top), is_planar)
    return marks


def _panel(heading: str, choice: Choice, box: Box, is_planar: bool) -> Iterator[Mark]:
    assert choice.scenes is not None
    left = box.left + 4.0
    yield Text(heading, (left, box.top - 10.0), style.SMALL, style.INK, is_left=True, is_bold=True)
    numbers = ("1 ", "2 ") if heading.startswith("Byte") else ("", "")
    yield line([(left, box.top - 26.0), (left + 16.0, box.top - 26.0)], _FIRST, 3.0)
    yield Text(numbers[0] + choice.names[0], (left + 21.0, box.top - 26.0), style.SMALL, _FIRST, is_left=True)
    half = (box.left + box.right) / 2
    yield line([(half, box.top - 26.0), (half + 16.0, box.top - 26.0)], _SECOND, 2.4, (5.0, 3.0))
    yield Text(numbers[1] + choice.names[1], (half + 21.0, box.top - 26.0), style.SMALL, _SECOND, is_left=True)
    points = [p for scene in choice.scenes for s in scene.segments for p in (s.start, s.end)]
    view = fitted(points, Box(left + 8.0, box.bottom + 16.0, box.right - 12.0, box.top - 42.0), is_planar=is_planar)
    yield from _skeleton(choice.scenes[0], view, _FIRST, 3.6, ())
    yield from _skeleton(choice.scenes[1], view, _SECOND, 2.4, (5.0, 3.0))


def _skeleton(scene: Scene, view: View, colour: str, width: float, dashes: Sequence[float]) -> Iterator[Mark]:
    for segment in scene.segments:
        if segment.body is not Body.BASE:
            yield line([view.page(segment.start), view.page(segment.end)], colour, width, tuple(dashes))
