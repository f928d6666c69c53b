"""Every mechanism answers in C as in Python: at every pose of the corpus, singular, beyond limits, garbage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.c.machine import ask, described, said
from tests.c.programs import program_of
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.corpus.robots import robot
from tests.javascript.comparison import Comparison, calls_of

SHOWN = 5


def compared(program: Path, recording: list[dict[str, Any]]) -> list[Comparison]:
    """The machines of a recording, each compared."""
    known = described(program)
    asked = [[q for q in (said(q, known) for q in part["asked"]) if q is not None] for part in recording]
    machines = [
        {"parameters": part["recipe"][0]["parameters"], "calls": [call for q in own for call in calls_of(q)]}
        for part, own in zip(recording, asked, strict=True)
    ]
    found = []
    for part, own, answer in zip(recording, asked, ask(program, machines), strict=True):
        one = Comparison(robot(part["recipe"]))
        assert answer["made"] == {"status": 0}
        answers = iter(answer["found"])
        for question in own:
            one.compare(question, answers)
        assert next(answers, None) is None
        found.append(one)
    return found


def differences(every: list[Comparison]) -> list[str]:
    """All differences, in words."""
    return [text for one in every for text in one.found]


@pytest.mark.parametrize("name", DIMENSIONS)
def test_answers_are_those_of_python(name: str) -> None:
    """Every answer is that of the package, and enough of them are solutions and refusals with reasons."""
    every = compared(program_of(name), read(name))
    found = differences(every)
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])
    assert sum(one.regular for one in every) >= (0 if name == "Kin_Tool" else 10)
    assert sum(one.refused for one in every) >= (0 if name == "Kin_Tool" else 10)
