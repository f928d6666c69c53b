"""Recordings: a file for a mechanism, compressed, with every real as the shortest text that gives it back."""

import json
import lzma
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.corpus.answers import Answer, Question, answer, facts
from tests.corpus.batches import batches_differ
from tests.corpus.comparison import Ask, differences
from tests.corpus.dimensions import COUPLED, DIMENSIONS
from tests.corpus.questions import questions
from tests.corpus.robots import Recipe, robot

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
