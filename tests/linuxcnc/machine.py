"""A machine of the catalogue in both: its module with dimensions, the Python class with the same, and its poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import atan2, degrees
from typing import Any

import numpy as np
import softkin

from derive.emit.c.description import inputs
from derive.emit.linuxcnc.words import Orientation, Words, words_of
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.linuxcnc.module import Module, Pose, module_of
from tests.mechanisms import kinematics_of, named
from tests.orthonormal import about

NAMES = [name for name in DIMENSIONS if name != "Kin_Tool"]
REGULAR, MOST_POSES = 12, 24
"""How many recorded poses are taken of those at the begin, which are regular, and about how many of the others."""
Axes = list[float]
Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Machine:
    """One machine in LinuxCNC and in Python."""

    name: str
    module: Module
    robot: softkin.Mechanism
    words: Words

    @property
    def size(self) -> float:
        """The scale of lengths."""
        return 1.0 + max((abs(value) for value in DIMENSIONS[self.name].values()), default=0.0)

    def frame_of(self, pose: Pose, axes: Axes) -> softkin.Frame:
        """The frame that a pose means, made here, independently of the module."""
        a, b, c = (pose[letter] for letter in "ABC")
        commanded = self.words.position
        position = [pose[letter] if letter in commanded else 0.0 for letter in "XYZ"]
        if self.words.orientation is Orientation.AXES:
            rotation: Any = self.robot.forward(axes)[0].rotation
        elif self.words.orientation is Orientation.ANGLES:
            rotation = about(2, c) @ about(1, b) @ about(0, a)
        else:
            is_down = self.robot.forward(axes)[0].rotation[2][2] < 0.0
            turned = about(2, c) if "C" in self.words.letters else np.eye(3)
            rotation = turned @ about(0, 180.0) if is_down else turned
        return softkin.Frame(tuple(position), np.asarray(rotation).tolist())


def heading(rotation: Any) -> float:
    """The angle about Z of a rotation, degrees."""
    return degrees(atan2(rotation[1][0], rotation[0][0]))


def machine_of(name: str, stub: str = "2_9", **further: float) -> Machine:
    """A machine with the dimensions of the corpus."""
    kin = kinematics_of(named(name))
    words, module = words_of(kin), module_of(name, stub)
    assert words is not None
    names = inputs(kin).names
    given = DIMENSIONS[name] | further
    module.set(**{names.get(key, key): value for key, value in given.items()})
    return Machine(name, module, softkin.catalogue()[name](**given), words)


@cache
def recorded(name: str) -> tuple[Axes, ...]:
    """Axis values of the corpus: regular, at right angles, singular, where no pose is, and numbers that are none."""
    found: list[Axes] = []
    for question in read(name)[0]["asked"]:
        axes = question.get("axes")
        if isinstance(axes, list) and len(axes) == len(named(name).joints) and all(_is_real(v) for v in axes):
            found.append([float(v) for v in axes])
    step = max(1, len(found) // MOST_POSES)
    return (*found[:REGULAR], *found[REGULAR::step])


def _is_real(value: Any) -> bool:
    return type(value) in (int, float)


def answered(machine: Machine) -> Iterator[tuple[Axes, softkin.Frame, tuple[int, ...]]]:
    """The recorded axis values that have a pose in Python."""
    for axes in recorded(machine.name):
        try:
            frame, configuration = machine.robot.forward(axes)
        except softkin.KinematicsError:
            continue
        yield axes, frame, configuration


def regular(machine: Machine, least: float = 0.05) -> Iterator[tuple[Axes, Pose]]:
    """Those whose margins are not small, with the pose that the module has for them."""
    for axes, _, _ in answered(machine):
        margins = machine.robot.singularity(axes).margins.values()
        if min((abs(m) for m in margins), default=1.0) >= least:
            pose = machine.module.forward(axes)
            assert pose is not None
            yield axes, pose


def differs(one: Axes, other: Axes) -> float:
    """The largest difference."""
    return max(abs(a - b) for a, b in zip(one, other, strict=True))
