"""The same machine in a file with other frames of its links: the description is the same."""

from collections.abc import Iterator, Mapping
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, arm_of
from derive.importing.formats.urdf import read_urdf
from tests.importing.kinematics import imported_text
from tests.importing.robots import COLLECTION, WRITTEN, File, joint, urdf, written

pytestmark = pytest.mark.slow

Array = NDArray[np.float64]
SEEDS = 8
ROWS: Mapping[str, tuple[tuple[str, str], ...]] = {
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
    "an inclined wrist": (
        ("0 0 0.3", "0 0 1"),
        ("0.1 0 0", "0 1 0"),
        ("0 0 0.4", "0 1 0"),
        ("0.35 0 0.05", "1 0 0"),
        ("0 0 0", f"{cos(1.0)!r} 0 {sin(1.0)!r}"),
        ("0 0 0", "1 0 0"),
    ),
}
"""The way to each axis, and its direction, at zero."""
FILES = tuple(name for name in (*COLLECTION, *WRITTEN) if name != "Fanuc")
"""In the file of the Fanuc a joint follows another, which is no matter of frames."""


def _file(name: str, folder: Path) -> File:
    if name in COLLECTION:
        return COLLECTION[name]
    if name in WRITTEN:
        return written(name, 17, folder)
    path = folder / "rows.urdf"
    joints = (joint(f"a{k}", "revolute", xyz, axis=axis) for k, (xyz, axis) in enumerate(ROWS[name], 1))
    path.write_text(urdf("rows", *joints, joint("flange", "fixed", "0 0.05 0")), encoding="utf-8")
    return File(path, "link0", f"link{len(ROWS[name]) + 1}")


def _turned(rng: np.random.Generator) -> Array:
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(rotation * np.sign(np.linalg.det(rotation)))


def _joints(arm: Arm, seed: int) -> Iterator[tuple[str, ...]]:
    """The joints of an arm, each at any place on its axis, in a frame that is turned anyhow."""
    rng = np.random.default_rng(seed)
    before = np.eye(4)
    for k, line in enumerate(arm.lines, 1):
        here = np.eye(4)
        here[:3, :3], here[:3, 3] = _turned(rng), line.point + rng.uniform(-0.1, 0.1) * line.direction
        axis = here[:3, :3].T @ line.direction
        kind = "prismatic" if line.kind is Kind.LINEAR else "revolute"
        yield joint(f"a{k}", kind, *_origin(before, here), axis=" ".join(map(repr, axis.tolist())))
        before = here
    yield joint("flange", "fixed", *_origin(before, arm.tip))


def _origin(before: Array, here: Array) -> tuple[str, str]:
    """The place of a frame in the one before: xyz, and turns about fixed x, y, z."""
    way = np.linalg.inv(before) @ here
    r = way[:3, :3]
    across = np.hypot(r[0, 0], r[1, 0])
    turns = np.arctan2(r[2, 1], r[2, 2]), np.arctan2(-r[2, 0], across), np.arctan2(r[1, 0], r[0, 0])
    return " ".join(map(repr, way[:3, 3].tolist())), " ".join(repr(float(t)) for t in turns)


@pytest.mark.parametrize("name", [*ROWS, *FILES])
def test_a_description_does_not_depend_on_the_frames_of_the_file(name: str, tmp_path: Path) -> None:
    file = _file(name, tmp_path)
    arm = arm_of(read_urdf(file.path, file.base, file.tip, 1.0))
    assert all(len(line.drives) == 1 and line.drives[0][1] == 1.0 for line in arm.lines)
    texts = set()
    for seed in range(SEEDS):
        found = imported_text(tmp_path / "arm.urdf", urdf("arm", *_joints(arm, seed)))
        texts.add(found.text.split('"""', 2)[2])
    assert len(texts) == 1
