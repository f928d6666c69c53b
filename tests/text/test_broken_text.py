"""Broken units: the harness refuses them, they fault while they run, or a comparison fails.

Without this, all other tests of the folder could pass for the wrong reason.
"""

import math
import re

import pytest

from tests.harness.library import Library, StError, StFault, compile_st
from tests.text.breakage import FAULTS, MECHANISM, REFUSED, WRONG, texts
from tests.text.comparisons import COMPARISONS
from tests.text.controller import OK, Controller
from tests.text.serial_pairs import SerialPair, serial_pairs_of


def with_text_of(library: Library, label: str) -> SerialPair:
    """A machine, with another text for its block."""
    (one,) = (t for t in serial_pairs_of(MECHANISM) if t.machine.label == label)
    controller = Controller(library, MECHANISM)
    assert controller.initialise(one.robot.parameters) == OK
    return SerialPair(one.machine, controller)


def compare(library: Library, *methods: str) -> None:
    """The comparisons of some methods."""
    for label in ("random 1", "limited"):
        one = with_text_of(library, label)
        for sample in one.regular[::2]:
            for method in methods:
                COMPARISONS[method](one, sample)


def test_unbroken_it_compiles_and_agrees() -> None:
    """The changes below are made to a text that is right."""
    compare(compile_st(texts()), *COMPARISONS)


@pytest.mark.parametrize("name", REFUSED)
def test_a_broken_text_is_refused(name: str) -> None:
    """A text with a mistake is refused with the message for that mistake."""
    with pytest.raises(StError, match=re.escape(REFUSED[name].said)):
        compile_st(texts(REFUSED[name]))


def test_a_missing_object_is_refused() -> None:
    """A text that uses a missing function is refused."""
    found = {file: text for file, text in texts().items() if file != "Softkin_Root.st"}
    with pytest.raises(StError, match="undeclared function Softkin_Root"):
        compile_st(found)


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_stops_the_text(name: str) -> None:
    """A text with a run-time fault stops with the message for that fault."""
    library = compile_st(texts(FAULTS[name]))
    one = with_text_of(library, "random 1")
    with pytest.raises(StFault, match=FAULTS[name].said):
        compare(library, "AxesToCartesian", "CartesianToAxes")
        one.controller.forward((math.inf, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_text_is_noticed(name: str) -> None:
    """The comparison with Python notices a text that compiles and computes something else."""
    library = compile_st(texts(WRONG[name]))
    with pytest.raises(AssertionError):
        compare(library, name.split(":")[0])
