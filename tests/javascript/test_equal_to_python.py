"""Every mechanism answers in JavaScript as in Python: at every pose of the corpus, singular, beyond limits, garbage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.javascript import comparison
from tests.javascript.modules import module_of
from tests.javascript.node import ask


def compared(module: Path, recording: list[dict[str, Any]]) -> list[comparison.Comparison]:
    """The machines of a recording, each compared."""
    return comparison.compared(recording, lambda machines: ask(module, machines)["answers"], dict)


@pytest.mark.parametrize("name", DIMENSIONS)
def test_answers_are_those_of_python(name: str) -> None:
    """Every answer is that of the package, and enough of them are solutions and refusals with reasons."""
    every = compared(module_of(name), read(name))
    comparison.check(name, every)
    assert sum(one.sentences for one in every) >= 0.9 * sum(one.refused for one in every)
