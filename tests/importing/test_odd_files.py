"""Files as nobody would write them: axes of every direction, rounded turns, joints in any order, followers."""

import re
from pathlib import Path

import numpy as np
import pytest

from tests.importing.kinematics import UNSNAPPED, assert_is, by_yourdfpy, imported_text
from tests.importing.robots import joint, urdf

pytestmark = pytest.mark.slow

AXES = (
    "1 0 0", "-1 0 0", "0 -1 0", "0 0 1", "0 0 -2", "0 0.70710678 0.70710678", "-0.5 0.5 0", "0.2 0.3 0.9",
    "1e-9 0 1",
)  # fmt: skip
TURNS = ("0", "0", "0", "1.5708", "3.14159", "-1.570796325", "3.141592653589793", "0.7853982", "0.3", "-2.5", "1e-7")
SHIFTS = ("0", "0", "0", "0.1", "-0.25", "0.3333333", "1e-6", "0.00043624", "0.5")
KINDS = ("revolute", "revolute", "revolute", "continuous", "prismatic", "fixed")
SEEDS = 10


def odd(seed: int) -> str:
    """A chain of eight or nine moving joints and some fixed ones; every third robot has joints that follow others."""
    rng = np.random.default_rng(seed)
    kinds = ["revolute"] * 6 + [str(rng.choice(KINDS)) for _ in range(6)]
    rng.shuffle(kinds)
    joints, moving = [], []
    for k, kind in enumerate(kinds):
        xyz, rpy = (" ".join(map(str, rng.choice(values, 3))) for values in (SHIFTS, TURNS))
        mimic = ""
        if kind != "fixed" and moving and seed % 3 == 0 and rng.random() < 0.3:
            leader = str(rng.choice(moving))
            mimic = f'<mimic joint="{leader}" multiplier="{rng.choice([-1, 0.5, 3])}" offset="{rng.choice([0, 0.2])}"/>'
        elif kind != "fixed":
            moving.append(f"odd_joint-{k}")
        limits = None if kind == "continuous" else (-2.5, float(rng.choice([-0.5, 1.0])))
        axis = str(
            rng.choice(AXES[:4] if kind == "prismatic" else AXES)
        )  # the other reader takes the length of a slide's
        joints.append(joint(f"odd_joint-{k}", kind, xyz, rpy, axis, limits, mimic))
    return urdf("odd robot", *joints)


def shuffled(text: str, seed: int) -> str:
    """The same file with its joints in another order."""
    parts = re.findall(r"<joint name.*?</joint>\n", text, re.S)
    order = np.random.default_rng(seed).permutation(len(parts))
    head = text.split("<joint name", 1)[0]
    return head + "".join(parts[k] for k in order) + "</robot>\n"


@pytest.mark.parametrize("seed", range(SEEDS))
def test_an_odd_file_is_what_it_says(seed: int, tmp_path: Path) -> None:
    path = tmp_path / "odd.urdf"
    text = shuffled(odd(seed), seed)
    tip = f"link{text.count('<joint name')}"
    for snap in (0.0, 1e-4):
        found = imported_text(path, text, "link0", tip, snap=snap)
        assert_is(found, tmp_path, by_yourdfpy(path, "link0", tip), 1e-8, 1e-11)
        assert snap > 0.0 or found.bounds.rotation <= UNSNAPPED
        assert sum(len(name) > 3 for name in found.axes) == 0


def test_a_small_arm_far_from_its_base(tmp_path: Path) -> None:
    path = tmp_path / "far.urdf"
    arm = [joint("a", "revolute", "40 0 3"), joint("b", "revolute", "0.1 0 0"), joint("tip", "fixed", "0.1 0 0")]
    found = imported_text(path, urdf("far", *arm))
    assert_is(found, tmp_path, by_yourdfpy(path, "link0", "link3"), 1e-8, 1e-11)
