"""The cases of a test on the controller: machines, and calls with their expected answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from derive.ir.program import Status

Reals = tuple[float, ...]
Bytes = tuple[int, ...]


class Called(Enum):
    """The method that a case calls."""

    INITIALIZE = 0
    FORWARD = 1
    INVERSE = 2
    SINGULARITY = 3


@dataclass(frozen=True)
class Case:
    """A call with its expected answer: frame and configuration of forward kinematics, the axes of the inverse."""

    called: Called
    machine: int
    status: Status = Status.OK
    axes: Reals = ()
    reference: Reals = ()
    frame: Reals = ()
    """The position, then the rotation by rows."""
    configuration: Bytes = ()
    is_singular: bool = False
    operations: int = 0
    """The largest number of floating operations of the call; a loop counts as often as the reference ran it."""
    budget: int = 0
    """The operations that a cycle of a controller may need for the case: more than those of the call."""


@dataclass(frozen=True)
class SelfTest:
    """Machines by their parameters, and cases in the order in which they run: the first case of a machine initialises
    it.
    """

    machines: tuple[Mapping[str, float], ...]
    cases: tuple[Case, ...]
