"""Every mechanism answers in JavaScript as in Python: at every pose of the corpus, singular, beyond limits, garbage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.corpus.robots import robot
from tests.javascript.comparison import Comparison, calls_of
from tests.javascript.modules import module_of
from tests.javascript.node import ask

SHOWN = 5


def compared(module: Path, recording: list[dict[str, Any]]) -> list[Comparison]:
    """The machines of a recording, each compared."""
    machines = [
        {"parameters": part["recipe"][0]["parameters"], "calls": [c for q in part["asked"] for c in calls_of(q)]}
        for part in recording
    ]
    found = []
    for part, answer in zip(recording, ask(module, machines)["answers"], strict=True):
        one = Comparison(robot(part["recipe"]))
        assert answer["made"] == {"status": 0}
        answers = iter(answer["found"])
        for question in part["asked"]:
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
    every = compared(module_of(name), read(name))
    found = differences(every)
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])
    assert sum(one.regular for one in every) >= (0 if name == "Kin_Tool" else 10)
    assert sum(one.refused for one in every) >= (0 if name == "Kin_Tool" else 10)
    assert sum(one.sentences for one in every) >= 0.9 * sum(one.refused for one in every)
