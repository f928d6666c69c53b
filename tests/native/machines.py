"""Machines on the native core, and the same ones whose calls are Python's."""

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import softkin
from softkin import Frame, KinematicsError, Mechanism

from tests.corpus.dimensions import DIMENSIONS
from tests.random_axes import random_axes

NAMES = tuple(DIMENSIONS)
SOME = ("Kin_ArticulatedRobot_6DOF", "Kin_Scara4_ZCcoupled_Type1", "Kin_Delta_P3C_Type3", "Kin_Hexapod", "Kin_Wrist2",
        "Kin_Ac6_RZRYRYRXRYRZ_J6Offset", "Kin_Pos_RRR", "Kin_Crane")  # fmt: skip
"""One of each kind: with branches and without, closed, with held axes, searched."""
PLATFORMS = ("Kin_Hexapod", "Softkin_Hexaglide", "Softkin_Pentapod", "Softkin_Planar_3RRR")
"""Those whose axes fit together in few places."""


@cache
def native(name: str, **changes: float) -> Mechanism:
    """A machine on the native core."""
    found = softkin.catalogue()[name](**{**DIMENSIONS[name], **changes})
    assert found._machine.answers
    return found


@cache
def in_python(name: str, **changes: float) -> Mechanism:
    """The same machine: it has a program of its own, which says the same, so that all its calls are Python's."""
    own = softkin.catalogue()[name]

    def _limits(self: Any, axes: Any) -> Any:
        return own._limits(self, axes)

    found = type(own.__name__, (own,), {"_limits": _limits})(**{**DIMENSIONS[name], **changes})
    assert not found._machine.answers
    return found


@cache
def poses(name: str, count: int, seed: int = 3) -> list[tuple[tuple[float, ...], Frame]]:
    """Axis values and their frames, of a machine that reaches them; the axes are plain numbers."""
    robot, random = native(name), np.random.default_rng(seed)
    found = []
    for _ in range(40 * count):
        try:
            axes = _drawn(robot, name, random)
            frame, configuration = robot.forward(axes)
            robot.inverse(frame, configuration, axes)
        except KinematicsError:
            continue
        found.append((axes, frame))
        if len(found) == count:
            break
    assert found
    return found


def _drawn(robot: Mechanism, name: str, random: np.random.Generator) -> tuple[float, ...]:
    """Any axes; of a machine with a platform those of a frame near its home."""
    given = DIMENSIONS[name]
    if robot.NAME in PLATFORMS:
        place = random.uniform(-20.0, 20.0, 3) * (1.0, 1.0, robot.FREEDOM == "three") + (
            0.0,
            0.0,
            given.get("home_z", 0.0),
        )
        tilt = 5.0 if robot.FREEDOM == "three" else 0.0
        return tuple(robot.inverse(Frame.from_euler(random.uniform(-5.0, 5.0), tilt, 0.0, place)))
    size = sum(abs(v) for k, v in given.items() if not k.startswith(("offset", "lower", "upper"))) or 500.0
    return tuple(random_axes(robot, 1, random, 170.0, 0.4 * size)[0].tolist())


def outcome(call: Callable[..., Any], *given: Any) -> Any:
    """What a call gives, or how it fails: the class, the text, the status and the reason."""
    try:
        return call(*given)
    except KinematicsError as error:
        return KinematicsError, _without_places(str(error)), error.status, error.refusal
    except Exception as error:
        return type(error), _without_places(str(error))


def _without_places(text: str) -> str:
    return re.sub("0x[0-9a-f]+", "…", text)
