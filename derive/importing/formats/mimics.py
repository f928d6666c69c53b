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


def driven(path: Path, name: str, followers: Mapping[str, Follower]) -> tuple[tuple[tuple[str, float], ...], float]:
    """The axis that moves a joint with its multiplier, and the offset: a follower may follow a follower."""
    multiplier, offset, seen = 1.0, 0.0, [name]
    while name in followers:
        follower = followers[name]
        offset += multiplier * follower.offset
        multiplier *= follower.multiplier
        name = follower.leader
        if name in seen:
            raise UnreadableRobot(f"{path}: joints mimic each other in a circle: {', '.join([*seen, name])}")
        seen.append(name)
    return ((name, multiplier),) if multiplier != 0.0 else (), offset
