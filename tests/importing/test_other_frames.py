"""The same machine in a file with other frames of its links: the description is the same."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from tests.importing.kinematics import imported
from tests.importing.robots import joint, urdf

Rows = tuple[tuple[str, str], ...]
ARMS: dict[str, Rows] = {
    "three parallel axes, beside each other": (
        ("0 0 0.15", "0 0 1"),
        ("0 0.11 0", "0 1 0"),
        ("-0.25 0 0", "0 1 0"),
        ("-0.21 0 0.02", "0 1 0"),
        ("0 0.08 -0.085", "0 0 1"),
        ("0 0.08 0", "0 1 0"),
    ),
    "forearm beside its axis by more than what is snapped": (
        ("0 0 0.22", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.38", "0 1 0"),
        ("0 0.0000028 0.4", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.1", "0 0 1"),
    ),
}
"""The way to each axis, and its direction; frames of the links are not turned."""


def _reworded(rows: Rows, seed: int) -> Iterator[tuple[str, ...]]:
    """The joints, each at another place on its axis (seed 0: where it is); between them frames that are turned, and
    turned back.
    """
    rng = Random(seed)
    for k, (xyz, axis) in enumerate(rows, 1):
        slide, turn = seed * rng.uniform(-0.1, 0.1), rng.uniform(-3.0, 3.0)
        along, back = (" ".join(f"{side * slide * int(a):.9f}" for a in axis.split()) for side in (1, -1))
        yield joint(f"turned_{k}", "fixed", xyz, f"{turn!r} 0 0")
        yield joint(f"turned_back_{k}", "fixed", rpy=f"{-turn!r} 0 0")
        yield joint(f"a{k}", "revolute", along, axis=axis)
        yield joint(f"back_{k}", "fixed", back)
    yield joint("flange", "fixed", "0 0.05 0")


def _described(rows: Rows, seed: int, folder: Path) -> str:
    """The description of a machine, without the text that names the file's links."""
    path = folder / "arm.urdf"
    path.write_text(urdf("arm", *_reworded(rows, seed)))
    return imported(path).text.split('"""', 2)[2]


@pytest.mark.parametrize("name", ARMS)
def test_a_description_does_not_depend_on_the_frames_of_the_file(name: str, tmp_path: Path) -> None:
    texts = {_described(ARMS[name], seed, tmp_path) for seed in range(8)}
    assert len(texts) == 1
