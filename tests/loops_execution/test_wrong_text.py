"""These tests would notice: a text with one statement slightly wrong answers differently from Python."""

from __future__ import annotations

import re

import pytest

from derive.mechanism import Mechanism
from tests.execution.controller import OK, Controller
from tests.execution.units import compiled_text, file_of, text_of
from tests.loops_execution.answers import COMPARISONS
from tests.loops_execution.machines import Loop, loops_of

PUBLIC = {"AxesToCartesian": "AxesToCartesian", "SolveBranch": "CartesianToAxes", "Jacobian": "Jacobian"}
"""The methods that are spoiled, and those that must answer differently."""
SAMPLES = 6


OUTPUTS = {
    "AxesToCartesian": r"^(  |)(f\.vT\.dX := )(.+?);",
    "SolveBranch": r"^(  |)(\w+\.a0 := )(.+?);",
    "Jacobian": r"^(  |)(J\[0, 0\] := )(.+?);",
}


def spoiled(text: str, method: str) -> str:
    """The text with the first output of a method made a little larger."""
    start = text.index(f"METHOD {'PRIVATE' if method == 'SolveBranch' else 'PUBLIC'} {method} ")
    end = text.index("END_METHOD", start)
    pattern = re.compile(OUTPUTS[method], re.MULTILINE | re.DOTALL)
    wrong, count = pattern.subn(r"\g<1>\g<2>1.0000001*(\g<3>);", text[start:end], count=1)
    assert count == 1, f"nothing to spoil in {method}"
    return text[:start] + wrong + text[end:]


@pytest.mark.parametrize("method", PUBLIC)
def test_a_wrong_statement_is_noticed(mechanism: Mechanism, method: str) -> None:
    loop = loops_of(mechanism)[1]
    library = compiled_text(file_of(mechanism), spoiled(text_of(mechanism), method))
    controller = Controller(library, mechanism)
    assert controller.initialise(loop.robot.parameters) == OK
    wrong = Loop(loop.machine, controller, loop.regular, loop.any)
    with pytest.raises(AssertionError):
        for sample in loop.regular[:SAMPLES]:
            COMPARISONS[PUBLIC[method]](wrong, sample)
