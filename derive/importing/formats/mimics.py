"""Joints that follow others: `value = multiplier * leader + offset`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from derive.importing.robot import UnreadableRobot


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
