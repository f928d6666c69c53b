"""Machines with limits: one of the catalogue that is given them, one whose description states them, an imported one."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import softkin

from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.emit.language import Part
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import Built, derive_and_measure, languages
from tests.importing.kinematics import described, imported
from tests.importing.robots import joint, urdf
from tests.machines.made import imported_class
from tests.mechanisms import named
from tests.outside import temporary

BESIDE = 1e-3
"""How far inside a limit, and beyond it, axes are asked for: degrees, lengths."""
_LANGUAGES = ("python", "st", "c", "javascript")
GIVEN, OWN, IMPORTED = "a machine of the catalogue", "a machine of one's own", "an imported machine"
_OWN = '''"""A SCARA with limits."""
from sympy import sin
from derive.frames import Rz, Tx, Tz
from derive.mechanism import Mechanism, Task, Turning, branch, length, linear, rotary

UPPER = length("upper", "first link", nominal=250.0, default=310.0)
LOWER = length("lower", "second link", nominal=240.0)
A1 = rotary("A1", "first turn", limits=(-150, 140))
A2 = rotary("A2", "second turn", limits=(25, 145))
A3 = linear("A3", "quill", limits=(-180, -15))
A4 = rotary("A4", "turn of the tool", limits=(-220, 230))
MECHANISM = Mechanism(
    name="LimitedScara", parameters=(UPPER, LOWER), joints=(A1, A2, A3, A4),
    chain=Rz(A1) * Tx(UPPER) * Rz(A2) * Tx(LOWER) * Tz(A3) * Rz(A4), task=Task("xyz", Turning.ABOUT_Z),
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
)
'''
_FILE = urdf(
    "small_scara",
    joint("one", "revolute", "0 0 0.3", limits=(-2.6, 2.4)),
    joint("two", "revolute", "0.3 0 0", limits=(0.4, 2.5)),
    joint("three", "prismatic", "0.25 0 0", limits=(-0.2, -0.01)),
    joint("four", "revolute", limits=(-3.0, 2.9)),
)


@dataclass(frozen=True)
class Limited:
    """A machine, what must be given for it, and axis values inside its limits."""

    mechanism: Mechanism
    kinematics: Kinematics
    parts: Mapping[str, Part]
    """What is written, by language."""
    robot: softkin.Mechanism
    given: Mapping[str, Any]
    """The parameters that are given: all limits of the others are those of the description."""
    ends: tuple[tuple[float, float], ...]
    base: tuple[float, ...]
    path: Path | None

    def poses(self) -> Iterator[tuple[tuple[float, ...], str]]:
        """Axis values, and the axis that is beyond a limit there; nothing if none is."""
        for k, (axis, pair) in enumerate(zip(self.robot.AXES, self.ends, strict=True)):
            for end, sign in zip(pair, (-1.0, 1.0), strict=True):
                for beside in (-BESIDE, BESIDE):
                    axes = (*self.base[:k], end + sign * beside, *self.base[k + 1 :])
                    yield axes, "" if beside < 0.0 else axis.name


def _made(mechanism: Mechanism, given: dict[str, Any], base: tuple[float, ...], path: Path | None) -> Limited:
    kinematics = derive_and_measure(mechanism)
    parts = {one.name: part for one in languages(wanted=_LANGUAGES) if (part := one.part(kinematics)) is not None}
    robot = imported_class(mechanism, Built("", "", None, parts, {}, kinematics.evidence))(**given)
    ends = tuple((given[f"lower_{j.key}"], given[f"upper_{j.key}"]) if path is None else j.limits
                 for j in mechanism.joints)  # fmt: skip
    return Limited(mechanism, kinematics, parts, robot, given, ends, base, path)


@cache
def limited_machine(kind: str) -> Limited:
    """One of the three kinds, derived, measured and written."""
    folder = temporary("limited")
    if kind == GIVEN:
        lengths: dict[str, Any] = {"link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0}
        ends = {"a1": (-100.0, 90.0), "a2": (20.0, 150.0), "a3": (-50.0, 60.0), "a4": (-300.0, 250.0)}
        limits = {f"{end}_{k}": v for k, pair in ends.items() for end, v in zip(("lower", "upper"), pair, strict=True)}
        return _made(named("Kin_Scara4_ZCcoupled_Type1"), lengths | limits, (20.0, 60.0, 5.0, 30.0), None)
    if kind == OWN:
        path = folder / "limited_scara.py"
        path.write_text(_OWN, encoding="utf-8")
        return _made(load(path), {"lower": 240.0}, (20.0, 60.0, -50.0, 30.0), path)
    file = folder / "small_scara.urdf"
    file.write_text(_FILE, encoding="utf-8")
    found = imported(file)
    mechanism = described(found, folder)
    return _made(mechanism, {}, (20.0, 60.0, -50.0, 30.0), folder / f"{found.name.lower()}.py")
