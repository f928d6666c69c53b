"""Machines of a user's own, in C and in JavaScript as in Python: numbers for lengths, held joints, natural names."""

from collections.abc import Sequence

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from tests.languages.language import LANGUAGES, Answer, C, Language
from tests.machines.made import made
from tests.machines.odd_names import ODD
from tests.machines.spoken import BASE, HELD, confirm_natural_names, spoken

pytestmark = pytest.mark.slow

OTHER_INT = "joints called Arm and Offset"
"""It has an `int_length` beside `int`, which C calls so elsewhere."""
EVERY = pytest.mark.parametrize("language", LANGUAGES, ids=str)


@EVERY
@pytest.mark.parametrize("name", ("numbers for lengths", HELD, BASE))
def test_a_machine_of_the_user(language: Language, name: str) -> None:
    """Every slot of random poses is that of Python, and its own axes are among them."""
    machine = spoken(name)
    (answer,) = language.ask(language.of(machine.machine.mechanism), machine.asked)
    machine.confirm(answer)


@EVERY
@pytest.mark.parametrize("name", (HELD,))
def test_a_reference_that_is_needed(language: Language, name: str) -> None:
    """A held joint has no value without a reference: that is said, and not guessed."""
    machine = made(name)
    frame = {"position": [0.0] * 3, "rotation": np.eye(3).tolist()}
    calls = [["inverse", frame, None, None], ["inverseAll", frame, None]]
    given = {"parameters": dict(machine.robot.parameters), "calls": calls}
    (answer,) = language.ask(language.of(machine.mechanism), [given])
    one, every = answer["found"]
    assert one["status"] == every["status"] == 2
    assert one["reason"].startswith("a reference is needed: it holds the value of ")


@EVERY
@pytest.mark.parametrize("name", ODD)
def test_natural_names(language: Language, name: str) -> None:
    """A machine whose inputs are called as no variable can be moves as its twin with plain names."""

    def forward(mechanism: Mechanism, axes: Sequence[list[float]]) -> tuple[list[str], list[Answer]]:
        program = language.of(mechanism)
        given = {p["name"]: p["nominal"] for p in language.parameters(program)}
        calls = [["forward", row[: len(mechanism.joints)]] for row in axes]
        return list(given), language.ask(program, [{"parameters": given, "calls": calls}])[0]["found"]

    own = {"int": "int_length_2"} if language is C and name == OTHER_INT else {}
    confirm_natural_names(name, forward, {**language.words, **own})
