"""Five-axis machines in any order of their turning axes, by hand: the tool through one axis after the other."""

from collections.abc import Mapping

import numpy as np

from tests.catalogue.closure import Array
from tests.orthonormal import rodrigues

AXES = dict(zip("ABC", np.eye(3), strict=True))
X, Y, Z = np.eye(3)


def tool(head: str, table: str, p: Mapping[str, float], q: Array) -> tuple[Array, Array]:
    """Tips (n, 3) and rotations (n, 3, 3) of the tool, seen from the workpiece. q: slides, angles in radians (5, n)."""
    inner, values = (table[::-1] + head)[1], dict(zip(head + table, q[3:], strict=True))

    def stand(letter: str) -> tuple[Array, Array]:
        others = [a for a in "ABC" if a != letter]
        place = sum(p.get(f"e{'xyz'['ABC'.index(a)]}0{letter.lower()}", 0.0) * AXES[a] for a in others)
        first, second = (rodrigues(AXES[a], np.radians(p.get(f"e{a.lower()}0{letter.lower()}", 0.0))) for a in others)
        return np.asarray(place), first @ second

    def turn(letter: str, sense: int) -> Array:
        line = AXES[letter]
        if letter == inner and "nutation" in p:
            line = np.cos(np.radians(p["nutation"])) * Z + np.sin(np.radians(p["nutation"])) * line
        return rodrigues(line, sense * values[letter])

    side = X if head.endswith("B") else Y
    held = p["head_offset"] * side - p["pivot_length"] * Z if head else -p["tool_length"] * Z
    held = held + p.get("tool_x", 0.0) * X + p.get("tool_y", 0.0) * Y
    tip, rotation = np.tile(held, (q.shape[1], 1)), np.tile(np.eye(3), (q.shape[1], 1, 1))
    for k, letter in enumerate(reversed(head)):
        place, lean = stand(letter)
        turned = lean @ turn(letter, 1)
        tip, rotation = place + np.einsum("nij,nj->ni", turned, tip), turned @ rotation
        if len(head) == 2 and k == 0:
            tip = tip + p["fork_offset"] * np.abs(np.cross(AXES[head[0]], AXES[head[1]]))
    across = rodrigues(Z, np.radians(p.get("ec0y", 0.0))) @ Y
    up = rodrigues(Y, np.radians(p.get("eb0z", 0.0))) @ rodrigues(X, np.radians(p.get("ea0z", 0.0))) @ Z
    tip = tip + q[:3].T @ np.stack([X, across, up])
    for k, letter in enumerate(table):
        place, lean = stand(letter)
        back = turn(letter, -1) @ lean.T
        tip, rotation = np.einsum("nij,nj->ni", back, tip - place), back @ rotation
        if len(table) == 2 and k == 0:
            tip = tip - [p.get(f"pivot_{c}", 0.0) for c in "xyz"]
    return tip, rotation
