"""The catalogue, loaded once for all tests of a process, and its mechanisms, each built once."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.description import catalogue as description
from derive.description.catalogue import Entry
from derive.description.mechanism import Mechanism, Turning
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from tests.kept import kept

Array = NDArray[Any]


@cache
def catalogue() -> tuple[Entry, ...]:
    """Every mechanism of the catalogue with its file."""
    return description.catalogue()


@cache
def named(name: str) -> Mechanism:
    return next(mechanism for _, mechanism in catalogue() if mechanism.name == name)


def has_struts(mechanism: Mechanism) -> bool:
    """Whether the lengths of its rods are joints: any place is in reach."""
    lengths = {s for rod in mechanism.rods for s in rod.length.free_symbols}
    return bool(lengths & {j.symbol for j in mechanism.joints})


def has_free_twist(mechanism: Mechanism) -> bool:
    """Whether a loop holds the direction of its platform, but no turn about it."""
    return mechanism.is_platform and mechanism.task.turning is Turning.DIRECTION and not mechanism.fixed_guides


def in_the_task(name: str, shifts: Array) -> Array:
    """Shifts along the axes of a machine, without what nobody commands. name: of the machine; others command it all."""
    passive = next((m.task.passive for _, m in catalogue() if m.name == name), "")
    return np.where([c in passive for c in "xyz"], 0.0, shifts)


def limit_names(mechanism: Mechanism) -> set[str]:
    """The parameters that limit an axis, or another quantity; the length of an upper arm is none."""
    keys = (*(joint.key for joint in mechanism.joints), *(quantity.name for quantity in mechanism.limited))
    return {f"{end}_{key}" for key in keys for end in ("lower", "upper")}


@cache
def kinematics_of(mechanism: Mechanism) -> Kinematics:
    """All programs of a mechanism."""
    return kept("kinematics", mechanism, build)
