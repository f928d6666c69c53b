"""A machine as a function block and in Python, with the names that `tests.text.comparisons` reads."""

from dataclasses import dataclass
from typing import Any

import softkin

from derive.description.mechanism import Mechanism
from tests.harness.library import Library
from tests.text.controller import Controller


@dataclass(frozen=True)
class Both:
    """A machine and its two implementations."""

    machine: Any
    """With a label, its mechanism, the parameters that are given, and the machine in Python."""
    controller: Controller

    @property
    def mechanism(self) -> Mechanism:
        return self.machine.mechanism

    @property
    def robot(self) -> softkin.Mechanism:
        return self.machine.robot

    @property
    def library(self) -> Library:
        return self.controller.library

    def __str__(self) -> str:
        return f"{self.mechanism.block_name}, {self.machine.label}: {dict(self.machine.given)}"
