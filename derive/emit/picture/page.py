"""The page: the machine with its joints and dimensions, the choices of its configuration beside it, text below."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from textwrap import wrap

from derive.drawing.drawing import Choice, Drawing
from derive.emit.picture import style
from derive.emit.picture.canvas import WIDTH
from derive.emit.picture.ink import Mark, Text
from derive.emit.picture.machine import Machine
from derive.emit.picture.naming import spelled
from derive.emit.picture.panel import HEIGHT, chosen, panels
from derive.emit.picture.symbols import is_stacked
from derive.emit.picture.view import Box

_PANEL = 214.0
_LOWEST, _HIGHEST = 250.0, 560.0
"""The least and the greatest height of the part of the page with the machine."""
_ROW, _LETTERS = 18.0, 112
"""The text below: the height of a line, and its number of letters."""


@dataclass(frozen=True)
class Page:
    """All marks of a picture, and its height."""

    marks: tuple[Mark, ...]
    height: int


def page(drawing: Drawing, title: str, names: Mapping[str, str]) -> Page:
    """The picture of a mechanism, as high as it needs to be; `names` holds the spelling of parameters."""
    choices = chosen(drawing)
    words = list(_words(drawing, [choice for _, choice in choices], names))
    bottom = 20.0 + _ROW * len(words)
    right = WIDTH - _PANEL - 14.0 if choices else WIDTH - 10.0
    highest = Machine(drawing, Box(10.0, bottom, right, bottom + _HIGHEST), names)
    needed = max(highest.needed, HEIGHT * len(choices) - 26.0, _LOWEST)
    height = round(bottom + needed + 40.0)
    machine = Machine(drawing, Box(10.0, bottom, right, height - 40.0), names).drawn()
    shown = panels(choices, Box(WIDTH - _PANEL, bottom, WIDTH - 12.0, height - 14.0), plane=drawing.plane)
    heading = Text(title, (16.0, height - 22.0), style.TITLE, style.INK, is_left=True, is_bold=True)
    lines = [(16.0, bottom - 14.0 - _ROW * row) for row in range(len(words))]
    below = [Text(text, at, style.SMALL, style.FAINT, is_left=True) for text, at in zip(words, lines, strict=True)]
    return Page((*machine, heading, *shown, *below), height)


def _words(drawing: Drawing, shown: Sequence[Choice], names: Mapping[str, str]) -> Iterator[str]:
    """The sentences on what the picture cannot show."""
    if drawing.is_zero:
        yield "Zero pose: all axes at their offsets. Arrows show the positive direction of every axis."
    else:
        values = ", ".join(
            f"{joint.name} = {value:.6g}{'°' if joint.in_degrees else ''}" for joint, value in drawing.axes
        )
        where = "Home pose, where" if drawing.is_home else "Drawn where"
        yield from wrap(f"{where} {values}. Arrows show the positive direction of every axis.", _LETTERS)
    if any(turn.zero is not None for turn in drawing.scene.turns):
        yield "Dashed: where a rotary axis is 0."
    for _, meeting in drawing.scene.meetings:
        yield f"Ring: the axes {', '.join(spelled(label, names) for label in meeting)} meet in one point."
    if any(segment.across is not None for segment in drawing.scene.segments):
        yield "Two rods side by side are a parallelogram: it keeps the plate's orientation; its width plays no part."
    if drawing.scene.belt is not None:
        motors = " and ".join(spelled(motor.label, names) for motor in drawing.scene.belt.motors)
        yield f"One belt, held at the dark bar. Arrows at the motors: how positive {motors} turn them for such a belt;"
        yield "arrows at the TCP: where each of them alone moves it. A motor mounted upside down turns the other way."
    if is_stacked(drawing.scene):
        yield "Rails of linear axes that begin in one point are drawn one on the end of the other."
    hidden = ", ".join(spelled(label, names) for label in drawing.scene.hidden)
    if hidden:
        yield f"Zero here: {hidden}."
    loops = [
        f"{spelled(joint, names)} by {', '.join(spelled(length, names) for length in lengths)}"
        for joint, lengths in drawing.scene.loops
    ]
    if loops:
        yield from wrap(f"Loops move joints, with lengths that are not drawn: {'; '.join(loops)}.", _LETTERS)
    for k, choice in enumerate(drawing.choices):
        if choice in shown and choice.assemblies is not None:
            pairs = zip((1, 2), choice.names, choice.assemblies, strict=True)
            each = ", ".join(f"{byte} {name} in the assembly {mode}" for byte, name, mode in pairs)
            yield f"Byte {k}, {choice.name}: {each}; no two in one were found."
    others = [
        f"byte {k}, {c.name}: 1 {c.names[0]}, 2 {c.names[1]}" for k, c in enumerate(drawing.choices) if c not in shown
    ]
    if others:
        yield from wrap(f"Bytes of the configuration without a picture: {'; '.join(others)}.", _LETTERS)
