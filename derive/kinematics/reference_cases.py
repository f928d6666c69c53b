"""What a test on the controller consists of: machines, and calls with what they must answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from derive.ir.program import Status

Reals = tuple[float, ...]
Bytes = tuple[int, ...]


class Called(Enum):
    """What a case calls."""

    INITIALIZE = 0
    FORWARD = 1
    INVERSE = 2
    SINGULARITY = 3


@dataclass(frozen=True)
class Case:
    """A call, and what it must answer. Of forward kinematics frame and configuration are answers, of the inverse the axes."""

    called: Called
    machine: int
    status: Status = Status.OK
    axes: Reals = ()
    reference: Reals = ()
    frame: Reals = ()
    """The position, then the rotation by rows."""
    configuration: Bytes = ()
    is_singular: bool = False


@dataclass(frozen=True)
class SelfTest:
    """Machines by their parameters, and cases in the order in which they run: a machine is initialised by its first one."""

    machines: tuple[Mapping[str, float], ...]
    cases: tuple[Case, ...]
