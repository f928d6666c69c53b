"""Legal files of an odd look, as tools write them: tabs, exponents, any order, classes in classes, includes.

Forward kinematics of the description is that of a reader that shares nothing with ours, and the description is derived.
"""

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.importing.kinematics import UNSNAPPED, assert_is, by_yourdfpy, described, imported
from tests.importing.test_mjcf import by_mujoco
from tests.machines.made import built_of

pytestmark = pytest.mark.slow

FILES = Path(__file__).parent / "files"
SOLUTIONS = {
    "namespace_and_tabs.urdf": 4, "axis_left_out.urdf": 2, "same_names.urdf": 2, "mixed_decimals.urdf": 8,
    "inclined_wrist.urdf": 8, "degrees_and_classes.xml": 4, "short_quaternions.xml": 12, "frames.xml": 2,
    "includes.xml": 2, "three_slides.xml": 2, "directions.xml": 4,
}  # fmt: skip
TIPS = {"degrees_and_classes.xml": "tcp", "frames.xml": "t", "short_quaternions.xml": "tip"}
SLOW = ("mixed_decimals.urdf", "inclined_wrist.urdf", "short_quaternions.xml")
FOR_THE_OTHER_READER: Mapping[str, tuple[tuple[str, str], ...]] = {
    "namespace_and_tabs.urdf": ((' xmlns="http://www.ros.org"', ""),),
    "degrees_and_classes.xml": (("<joint/>", '<joint name="l2.0"/>'), ('class="B" ', 'class="B" name="l3.0" ')),
}
"""What the other reader does not know: it reads no namespace, and ours names a joint without a name."""


@pytest.mark.parametrize("name", SOLUTIONS)
@pytest.mark.parametrize("snap", [0.0, 1e-6])
def test_it_is_what_the_other_reader_says(name: str, snap: float, tmp_path: Path) -> None:
    found = imported(FILES / name, tip=TIPS.get(name), snap=snap)
    shutil.copytree(FILES, tmp_path / "files")
    plain = tmp_path / "files" / name
    text = plain.read_text(encoding="utf-8")
    for ours, theirs in FOR_THE_OTHER_READER.get(name, ()):
        assert ours in text
        text = text.replace(ours, theirs)
    plain.write_text(text, encoding="utf-8")
    reader = by_yourdfpy if plain.suffix == ".urdf" else by_mujoco
    pose = reader(plain, found.robot.base, found.robot.tip)
    assert_is(found, tmp_path, pose)
    assert snap > 0.0 or found.bounds.rotation <= UNSNAPPED


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in SOLUTIONS])
def test_it_is_derived(name: str, tmp_path: Path) -> None:
    evidence = built_of(described(imported(FILES / name, tip=TIPS.get(name)), tmp_path)).evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.inverted.solutions == SOLUTIONS[name]
