"""Machines of a user's own, in C as in Python: held joints, gears, natural names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from derive.emit.c import package
from tests.c.machine import ask, described
from tests.c.programs import compiled
from tests.machines.made import made
from tests.machines.spoken import BASE, HELD, confirm_natural_names, spoken
from tests.mechanisms import kinematics_of

WORDS = {"self": "self", "configuration": "configuration", "int": "int_length"}
"""Names that Python cannot give, and one that C cannot."""


@pytest.mark.parametrize("name", (HELD, BASE))
def test_a_machine_of_the_user(name: str) -> None:
    """Every slot of random poses is that of Python, and its own axes are among them."""
    machine = spoken(name)
    (answer,) = ask(compiled(package.part(kinematics_of(machine.machine.mechanism))), machine.asked)
    machine.confirm(answer)


def test_a_reference_that_is_needed() -> None:
    """A held joint has no value without a reference: that is said, and not guessed."""
    machine = made(HELD)
    frame = {"position": [0.0] * 3, "rotation": np.eye(3).tolist()}
    calls = [["inverse", frame, None, None], ["inverseAll", frame, None]]
    given = {"parameters": dict(machine.robot.parameters), "calls": calls}
    (answer,) = ask(compiled(package.part(kinematics_of(machine.mechanism))), [given])
    one, every = answer["found"]
    assert one["status"] == every["status"] == 2
    assert one["reason"].startswith("a reference is needed: it holds the value of ")


@pytest.mark.parametrize("name", ("words of the languages", "coordinates of a loop"))
def test_natural_names(name: str) -> None:
    """A machine whose inputs are called as no variable can be moves as its twin with plain names."""
    confirm_natural_names(name, _forward, WORDS)


def _forward(mechanism: Mechanism, axes: Sequence[list[float]]) -> tuple[list[str], list[dict[str, Any]]]:
    part = package.part(kinematics_of(mechanism))
    assert part is not None
    program = compiled(part)
    given = {p["name"]: p["nominal"] for p in described(program).parameters}
    calls = [["forward", row[: len(mechanism.joints)]] for row in axes]
    return list(given), ask(program, [{"parameters": given, "calls": calls}])[0]["found"]
