"""Transmissions of a URDF, between motors and joints: a description is in joint values, so they are only reported.

Those of `transmission_interface` are read, as a child of the robot or of its `ros2_control`, and the older forms.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from derive.importing.formats.documents import shown
from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element
_REDUCTIONS = ("mechanicalReduction", "mechanical_reduction")


def transmission_notes(root: Element, axes: Container[str]) -> Iterator[str]:
    """The notes on transmissions that move axes: the reductions, and a line for motors that share joints."""
    reductions: list[str] = []
    found = False
    for element in root.iter("transmission"):
        joints = [j.get("name", "") for j in element.findall("joint")]
        if not any(name in axes for name in joints):
            continue
        found = True
        reductions += _reductions(element, joints)
        if len(joints) > 1:
            yield (
                f"The {_kind(element)} {element.get('name')!r} couples {' and '.join(joints)}: a motor moves both. "
                "Axis values are joint values; where the controller commands the motors, add `coupling=` to "
                f"{joints[-1]}."
            )
    if found:
        further = f" Reductions, for the drives: {', '.join(reductions)}." if reductions else ""
        yield f"Transmissions are not part of a description: axis values are the joint values of the file.{further}"


def _kind(element: Element) -> str:
    """The type of a transmission, without the package it is from: DifferentialTransmission."""
    stated = element.get("type") or element.findtext("type") or element.findtext("plugin") or "transmission"
    return stated.strip().rpartition("/")[2]


def _reductions(element: Element, joints: list[str]) -> Iterator[str]:
    """Joint and reduction, of those that are not 1, wherever the file states them."""
    owners = [element, *element.findall("actuator"), *element.findall("joint")]
    for owner in owners:
        for text in (owner.findtext(tag) for tag in _REDUCTIONS):
            name = joints[0] if len(joints) == 1 else owner.get("name")
            if text is not None and (value := _number(text)) != 1.0:
                yield f"{name} {value:g}" if value else f"{name} {shown(text.strip())} (no number)"


def _number(text: str) -> float | None:
    """The number of a text; None if it is none: kinematics needs no reduction."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


@dataclass(frozen=True)
class Follower:
    """A joint that follows another."""

    leader: str
    multiplier: float
    offset: float
    rounding: float = 0.0
    """The largest distance of the offset from the exact one that the file has rounded (radians)."""


@dataclass(frozen=True)
class Driven:
    """The axis that moves a joint with its multiplier (none if that is 0), and the joint's offset."""

    drives: tuple[tuple[str, float], ...]
    offset: float
    rounding: float


def driven(path: Path, name: str, followers: Mapping[str, Follower]) -> Driven:
    """The axis that moves a joint, directly or through other followers."""
    multiplier, offset, rounding, seen = 1.0, 0.0, 0.0, [name]
    while name in followers:
        follower = followers[name]
        offset += multiplier * follower.offset
        rounding += abs(multiplier) * follower.rounding
        multiplier *= follower.multiplier
        name = follower.leader
        if name in seen:
            raise UnreadableRobot(f"{path}: joints mimic each other in a circle: {', '.join([*seen, name])}")
        seen.append(name)
    return Driven(((name, multiplier),) if multiplier != 0.0 else (), offset, rounding)
