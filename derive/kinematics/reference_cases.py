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
    """The floating operations of the call, at most; those of a loop as often as the reference ran it."""


@dataclass(frozen=True)
class SelfTest:
    """Machines by their parameters, and cases in the order in which they run: a machine is initialised by its first
    one.
    """

    machines: tuple[Mapping[str, float], ...]
    cases: tuple[Case, ...]
