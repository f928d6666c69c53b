"""Every machine as a function block and in Python, whatever its kind."""

from __future__ import annotations

from collections.abc import Mapping

from derive.description.mechanism import Mechanism
from tests.text import comparisons
from tests.text.comparisons import Comparison
from tests.text.loops import answers
from tests.text.loops.machines import LOOPS, Loop, loops_of
from tests.text.serial_pairs import MECHANISMS, SerialPair, serial_pairs_of

Pair = SerialPair | Loop
POSITION_KINEMATICS = (*MECHANISMS, *LOOPS)
"""Serial mechanisms and those with rods. Orientation kinematics have methods, and a folder, of their own."""


def pairs_of(mechanism: Mechanism) -> tuple[Pair, ...]:
    """Its machines."""
    return loops_of(mechanism) if mechanism.rods else serial_pairs_of(mechanism)


def comparisons_of(mechanism: Mechanism) -> Mapping[str, Comparison]:
    """The expected answers of all methods of its block."""
    return answers.COMPARISONS if mechanism.rods else comparisons.COMPARISONS
