"""Names of axes, parameters and blocks, from the names of a file."""

from __future__ import annotations

import re
from collections.abc import Sequence

from derive.importing.arms.pieces import Piece
from derive.importing.robot import Robot

_SHORT = re.compile(r"[A-Z][0-9]\Z")
_TAKEN = {"X", "Y", "Z", "Rx", "Ry", "Rz", "Tx", "Ty", "Tz", "TURN", "ROTATION", "MECHANISM"}
"""The names that a mechanism file imports or defines."""
LETTERS = "xyz"


def words(name: str) -> list[str]:
    """The words of a name, split at characters that are no letters or digits, and before capitals."""
    return re.findall(r"[A-Z]+(?![a-z])[0-9]*|[A-Z]?[a-z]+[0-9]*|[0-9]+", name)


def axis_names(robot: Robot) -> tuple[str, ...]:
    """The names of the file where they are short (`joint_a1` is A1), else A1 to A9, B1 to B9, in their order."""
    found = [_short(axis.name) for axis in robot.axes]
    names = [name for name in found if name is not None]
    if len(names) == len(found) == len(set(names)):
        return tuple(names)
    return tuple(f"{'ABCDEFGH'[k // 9]}{k % 9 + 1}" for k in range(len(found)))  # A12 is the sum of A1 and A2


def _short(name: str) -> str | None:
    """A letter and a number, where a name consists of them but for "joint" and "axis"; else None."""
    kept = "".join(w for w in words(name) if w.lower() not in ("joint", "axis")).upper()
    kept = f"A{kept}" if kept.isdigit() else kept
    return kept if _SHORT.match(kept) and kept not in _TAKEN else None


def block_name(robot: Robot) -> str:
    """The name of the mechanism: Kin_ and the words of the robot's name."""
    found = words(re.sub(r"[^A-Za-z0-9]+", " ", robot.name))
    joined = "".join(w[:1].upper() + w[1:] for w in found)
    if not joined or len(joined) > 24:
        joined = joined[:24] or "Imported"
    return f"Kin_{joined}" if joined[0].isalpha() else f"Kin_Robot{joined}"


def parameter_name(piece: Piece, places: Sequence[str]) -> str:
    """The name of a fixed shift or turn: the axes between which it stands, and its direction."""
    kind = "turn_" if piece.motion.value == "turn" else ""
    return f"{_between(piece.place, places, '_').lower()}_{kind}{LETTERS[piece.letter]}"


def parameter_meaning(piece: Piece, places: Sequence[str], is_negative: bool) -> str:
    """A phrase that explains such a parameter."""
    place = _where(piece.place, places)
    if piece.motion.value == "turn":
        return f"{place}, turn about {LETTERS[piece.letter]}"
    return f"{place}, along {'-' if is_negative else ''}{LETTERS[piece.letter]}"


def _between(place: int, places: Sequence[str], by: str) -> str:
    if place == 0:
        return "base"
    return "tip" if place == len(places) else f"{places[place - 1]}{by}{places[place]}"


def _where(place: int, places: Sequence[str]) -> str:
    start = "Base" if place == 0 else f"Axis {places[place - 1]}"
    return f"{start} to {'the tip' if place == len(places) else f'axis {places[place]}'}"
