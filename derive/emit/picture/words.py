"""The sentences of a picture, on what it cannot show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from derive.drawing.drawing import Choice, Drawing
from derive.emit.picture import style
from derive.emit.picture.canvas import text_width
from derive.emit.picture.ink import Mark, Text
from derive.emit.picture.naming import spelled
from derive.emit.picture.symbols import is_stacked

ROW = 18.0
"""The height of a line."""


def of_machine(drawing: Drawing, likewise: Sequence[str], names: Mapping[str, str]) -> Iterator[str]:
    """The sentences below the machine."""
    yield f"{_pose(drawing)}. Arrows: positive directions."
    if any(turn.zero is not None for turn in drawing.scene.turns):
        yield "Dashed: where a rotary axis is 0."
    for _, meeting in drawing.scene.meetings:
        yield f"{', '.join(spelled(label, names) for label in meeting)} meet in one point."
    if any(segment.across is not None for segment in drawing.scene.segments):
        yield "Double rods are parallelograms; their width plays no part."
    if drawing.scene.belt is not None:
        motors = " and ".join(spelled(motor.label, names) for motor in drawing.scene.belt.motors)
        yield f"One belt, held at the dark bar. Arrows at the motors: how positive {motors} turn them (a motor upside"
        yield "down: the other way); at the TCP: where each alone moves it."
    if is_stacked(drawing.scene):
        yield "Rails that begin in one point are drawn end to end."
    if likewise:
        yield f"Likewise at the other legs: {', '.join(likewise)}."
    hidden = ", ".join(spelled(label, names) for label in drawing.scene.hidden)
    if hidden:
        yield f"Zero here: {hidden}."
    loops = [
        f"{spelled(joint, names)} by {', '.join(spelled(length, names) for length in lengths)}"
        for joint, lengths in drawing.scene.loops
    ]
    if loops:
        yield f"Loops move joints, with lengths that are not drawn: {'; '.join(loops)}."


def _pose(drawing: Drawing) -> str:
    """The pose; not its lengths, which hold for the drawn dimensions alone."""
    if drawing.is_zero:
        return "Zero pose"
    if drawing.is_home:
        return "Home pose"
    angles = [f"{joint.name} = {value:.6g}°" for joint, value in drawing.axes if joint.in_degrees]
    return f"Not the zero pose: {', '.join(angles)}" if angles else "Not the zero pose"


def of_choices(drawing: Drawing, shown: Sequence[Choice]) -> Iterator[str]:
    """The sentences on the bytes of the configuration."""
    for k, choice in enumerate(drawing.choices):
        if choice in shown and choice.assemblies is not None:
            pairs = zip((1, 2), choice.names, choice.assemblies, strict=True)
            each = ", ".join(f"{byte} {name} in the assembly {mode}" for byte, name, mode in pairs)
            yield f"Byte {k}, {choice.name}: {each}; no two in one were found."
    others = [
        f"byte {k}, {c.name}: 1 {c.names[0]}, 2 {c.names[1]}" for k, c in enumerate(drawing.choices) if c not in shown
    ]
    if others:
        yield f"Not drawn: {'; '.join(others)}."


def rows(sentences: Sequence[str], width: float) -> list[str]:
    """The sentences as lines that are at most this wide."""
    lines: list[str] = []
    for word in " ".join(sentences).split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and text_width(longer, style.SMALL) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def written(lines: Sequence[str], left: float, top: float) -> list[Mark]:
    """The lines, from a corner of the page down."""
    return [
        Text(text, (left, top - ROW * (row + 0.5)), style.SMALL, style.FAINT, is_left=True)
        for row, text in enumerate(lines)
    ]
