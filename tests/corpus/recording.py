"""Recordings: a file for a mechanism, compressed, with every real as the shortest text that gives it back."""

import json
import lzma
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tests.corpus.answers import Answer, Question, answer, facts
from tests.corpus.comparison import FRAME, SINGULAR, Ask, axes_differ, differences
from tests.corpus.dimensions import COUPLED, DIMENSIONS
from tests.corpus.questions import questions
from tests.corpus.robots import Recipe, Robot, robot

Row = tuple[Question, Answer]


def batches_differ(one: Robot, asked: list[Question], recorded: list[Answer]) -> Iterator[str]:
    """Every difference between batch calls and recorded answers, in words."""
    pairs = list(zip(asked, recorded, strict=True))
    yield from _forward(
        one, [p for p in pairs if p[0]["call"] == "forward" and "start" not in p[0] and _fits(one, p[0]["axes"])]
    )
    rows = [p for p in pairs if p[0]["call"] == "inverse" and _is_table(one, p[0])]
    if hasattr(one.made, "SIDES") and len(rows) < 3:
        return  # a search of few rows takes as long as of many
    yield from _slots(one, rows) if rows else ()
    yield from _named(one, rows) if rows else ()


def _forward(one: Robot, rows: list[Row]) -> Iterator[str]:
    if not rows:
        return
    positions, rotations, configurations, statuses = one.made.forward_batch([question["axes"] for question, _ in rows])
    for i, (question, old) in enumerate(rows):
        place = f"forward_batch of {one.made!r}: asked {question}"
        if statuses[i] != old.get("status", 0):
            yield f"{place}: status {statuses[i]} was {old.get('status', 0)}"
        elif "position" in old:
            allowed = FRAME / max(old["margin"], SINGULAR)
            if not np.allclose(positions[i], old["position"], rtol=allowed, atol=allowed * one.reach):
                yield f"{place}: position {positions[i]} was {old['position']}"
            if not np.allclose(rotations[i], old["rotation"], rtol=0.0, atol=allowed):
                yield f"{place}: rotation {rotations[i]} was {old['rotation']}"
            if old["margin"] > 1e-9 and configurations[i].tolist() != old["configuration"]:
                yield f"{place}: configuration {configurations[i]} was {old['configuration']}"


def _slots(one: Robot, rows: list[Row]) -> Iterator[str]:
    # A search sorts its roots by side; a batch solves each slot, and meets a double root on both sides.
    if hasattr(one.made, "SIDES"):
        rows = [row for row in rows if row[0]["kind"] == "regular"]
        if not rows:
            return
    axes, statuses = one.made.inverse_all_batch(*_tables(one, rows))
    for i, (question, old) in enumerate(rows):
        for slot, was in enumerate(old["slots"]):
            place = f"inverse_all_batch of {one.made!r}, slot {slot}: asked {question}"
            yield from _one(one, place, was, axes[i, slot], statuses[i, slot])


def _named(one: Robot, rows: list[Row]) -> Iterator[str]:
    bytes_ = len(one.made.CONFIGURATION)
    named = [(row, c, was) for row in rows for c, was in zip(row[0]["configurations"], row[1]["named"], strict=True)]
    named = [(row, c, was) for row, c, was in named if len(c) == bytes_ and all(-128 <= b <= 127 for b in c)]
    if not named:
        return
    positions, rotations, references = _tables(one, [row for row, _, _ in named])
    configurations = np.array([c for _, c, _ in named]).reshape(len(named), bytes_)
    axes, statuses = one.made.inverse_batch(positions, rotations, configurations, references)
    for i, (row, configuration, was) in enumerate(named):
        yield from _one(one, f"inverse_batch of {one.made!r}, {configuration}: {row[0]}", was, axes[i], statuses[i])


def _one(one: Robot, place: str, old: Answer, axes: Any, status: Any) -> Iterator[str]:
    if status != old["status"]:
        yield f"{place}: status {status} was {old['status']}"
    elif "axes" in old:
        yield from axes_differ(one, place, old["axes"], axes.tolist(), old["margin"])


def _tables(one: Robot, rows: list[Row]) -> tuple[Any, Any, Any]:
    frames = [question["frame"] for question, _ in rows]
    references = [question["reference"] or [0.0] * len(one.made.AXES) for question, _ in rows]
    return (
        np.array([f[0] for f in frames]),
        np.array([f[1] for f in frames]),
        np.array(references).reshape(len(rows), -1),
    )


def _is_table(one: Robot, question: Question) -> bool:
    """Whether a frame and a reference have the form of a row."""
    (place, rows), reference = question["frame"], question["reference"]
    numbers = len(place) == 3 and len(rows) == 3 and not isinstance(place[0], str)
    if reference is None:  # a machine that holds joints refuses: zeros of a table are another question
        return numbers and not getattr(one.made, "HELD", ())
    return numbers and _fits(one, reference)


def _fits(one: Robot, axes: list[float]) -> bool:
    return len(axes) == len(one.made.AXES)


RECORDED = Path(__file__).parent / "recorded"
NAMES = (*DIMENSIONS, *COUPLED)
Recording = list[dict[str, Any]]
"""Of every robot: its `recipe`, its `facts`, the questions `asked` and the `answers`."""


def read(name: str, folder: Path = RECORDED) -> Recording:
    found: Recording = json.loads(lzma.decompress((folder / f"{name}.json.xz").read_bytes()))
    return found


def write(name: str, recording: Recording, folder: Path = RECORDED) -> int:
    """Keep a recording; the size of the file."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(recording, separators=(",", ":"))
    data = lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME)
    (folder / f"{name}.json.xz").write_bytes(data)
    return len(data)


def drawn(name: str) -> Recording:
    """New questions about a mechanism, with the answers of the package."""
    return [_answered(recipe, asked) for recipe, asked in questions(name)]


def asked_again(recording: Recording) -> Recording:
    """The questions of a recording with the answers of the package."""
    return [_answered(part["recipe"], part["asked"]) for part in recording]


def compared(recording: Recording, ask: Ask = answer) -> Iterator[str]:
    """Every difference between what is recorded and what the package answers."""
    for part in recording:
        one = robot(part["recipe"])
        if facts(one) != part["facts"]:
            yield f"facts: {part['facts']} were {facts(one)}"
        yield from differences(one, part["asked"], part["answers"], ask)
        yield from batches_differ(one, part["asked"], part["answers"])


def _answered(recipe: Recipe, asked: list[Question]) -> dict[str, Any]:
    plain: list[Question] = json.loads(json.dumps(asked))
    one = robot(recipe)
    answers: list[Answer] = [answer(one, question) for question in plain]
    return {"recipe": recipe, "facts": facts(one), "asked": plain, "answers": answers}
