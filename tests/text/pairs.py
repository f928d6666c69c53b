"""Every machine as a function block and in Python, whatever its kind."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from derive.description.mechanism import Mechanism
from tests.catalogue.driven_machines import DRIVEN, driven_machines_of
from tests.text.comparisons import COMPARISONS, Comparison
from tests.text.limits import limited
from tests.text.loops.machines import COMPARISONS as OF_LOOPS
from tests.text.loops.machines import LOOPS, Loop, loops_of
from tests.text.serial_pairs import MECHANISMS, SerialPair, serial_pair, serial_pairs_of

Pair = SerialPair | Loop
POSITION_KINEMATICS = (*MECHANISMS, *DRIVEN, *LOOPS)
"""Serial mechanisms, with loops in their chains or without, and those with rods. Orientation kinematics have methods,
and a folder, of their own."""


@cache
def pairs_of(mechanism: Mechanism) -> tuple[Pair, ...]:
    if mechanism.drives:
        machines = driven_machines_of(mechanism)
        return tuple(map(serial_pair, (*machines, limited(machines[-1], "limited"))))
    return loops_of(mechanism) if mechanism.rods else serial_pairs_of(mechanism)


def comparisons_of(mechanism: Mechanism) -> Mapping[str, Comparison]:
    """The expected answers of all methods of its block."""
    return OF_LOOPS if mechanism.rods else COMPARISONS
