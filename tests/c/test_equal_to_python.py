"""Every mechanism answers in C as in Python: at every pose of the corpus, singular, beyond limits, garbage."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.c.machine import ask, described, said
from tests.c.programs import program_of
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.javascript import comparison


def compared(program: Path, recording: list[dict[str, Any]]) -> list[comparison.Comparison]:
    """The machines of a recording, each compared."""
    known = described(program)
    return comparison.compared(recording, lambda machines: ask(program, machines), lambda q: said(q, known))


@pytest.mark.parametrize("name", DIMENSIONS)
def test_answers_are_those_of_python(name: str) -> None:
    """Every answer is that of the package, and enough of them are solutions and refusals with reasons."""
    comparison.check(name, compared(program_of(name), read(name)))
