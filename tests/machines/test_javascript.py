"""Machines of a user's own, in JavaScript as in Python: numbers for lengths, held joints, gears, natural names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from derive.description.mechanism import Mechanism
from derive.emit.javascript import package
from tests.javascript.modules import written
from tests.javascript.node import ask
from tests.machines.odd_names import ODD
from tests.machines.spoken import BASE, HELD, confirm_natural_names, spoken
from tests.mechanisms import kinematics_of

WORDS = {word: word for word in ("self", "configuration", "lambda", "del")}
"""Names that Python cannot give."""


@pytest.mark.parametrize("name", ("numbers for lengths", HELD, BASE))
def test_a_machine_of_the_user(name: str) -> None:
    """Every slot of random poses is that of Python, and its own axes are among them."""
    machine = spoken(name)
    module = written(package.part(kinematics_of(machine.machine.mechanism)))
    machine.confirm(ask(module, machine.asked)["answers"][0])


@pytest.mark.parametrize("name", ODD)
def test_natural_names(name: str) -> None:
    """A machine whose inputs are called as no variable can be moves as its twin with plain names."""
    confirm_natural_names(name, _forward, WORDS)


def _forward(mechanism: Mechanism, axes: Sequence[list[float]]) -> tuple[list[str], list[dict[str, Any]]]:
    module = written(package.part(kinematics_of(mechanism)))
    parameters = ask(module, [])["description"]["parameters"]
    calls = [["forward", row[: len(mechanism.joints)]] for row in axes]
    given = {p["name"]: p["nominal"] for p in parameters}
    return list(given), ask(module, [{"parameters": given, "calls": calls}])["answers"][0]["found"]
