"""Closed loops of a file: an arm is not imported without one that binds its joints."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from derive.importing.formats.documents import shown
from derive.importing.robot import UnreadableRobot


@dataclass(frozen=True)
class Loop:
    """What closes a loop, and the two links that it joins."""

    closed_by: str
    first: str
    second: str


@dataclass(frozen=True)
class Joints:
    """Names of joints: those that move the chain, those that follow others, and those that have a motor."""

    used: Container[str]
    followers: Container[str | None]
    driven: Container[str | None]
    no_rods: str = ""
    """What keeps the loops that bind the chain from being rods that meet in the tip."""


def loop_notes(path: Path, loops: Iterable[tuple[Loop, Sequence[str]]], joints: Joints) -> Iterator[str]:
    """A note on each loop that may be left out. loops: each with its moving joints.

    Raises `UnreadableRobot` for a loop that binds a joint of the chain: as an open arm it would be another machine.
    """
    for loop, inside in loops:
        closed = f"{loop.closed_by} closes a loop of the joints {', '.join(map(shown, inside))}"
        if is_followed(inside, joints.followers):
            yield f"Not read, because its joints follow each other: {closed}."
        elif any(name in joints.used for name in inside):
            why = f" (no rods that meet in the tip: {joints.no_rods})" if joints.no_rods else ""
            raise UnreadableRobot(f"{path}: {closed}{_passive(inside, joints)}{why}: {_REMEDY}")
        elif inside:
            yield f"Not read, because no joint between base and tip is in it: {closed}."


def is_followed(inside: Sequence[str], followers: Container[str | None]) -> bool:
    """Whether the joints of a loop follow each other, so that one alone moves it."""
    following = [name for name in inside if name in followers]
    return bool(following) and len(following) >= len(inside) - 1


_REMEDY = (
    "as an open arm it would be another machine; describe it with rods (docs/OWN_MACHINE.md, `rod`), whose lengths are "
    "distances of joints in the file"
)


def _passive(inside: Sequence[str], joints: Joints) -> str:
    """Which joints of a loop have no motor, where some have one."""
    names = [name for name in inside if name not in joints.driven]
    if not names or len(names) == len(inside):
        return ""
    return f", of which {', '.join(map(shown, names))} {'is' if len(names) == 1 else 'are'} passive"
