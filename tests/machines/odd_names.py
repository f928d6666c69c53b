"""Machines whose parameters, joints and branches have names that programs, Python and Structured Text use themselves.

Each has a twin: the same machine with names that nothing else has.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sympy import cos, sin

from derive.description.mechanism import Mechanism
from derive.frames import Rz, Tx, Txyz, Ty, Tz
from derive.mechanism import (
    Task,
    Turning,
    Vendor,
    angle,
    assembly,
    branch,
    distance,
    length,
    linear,
    radians,
    rod,
    rotary,
    sign,
)
from derive.mechanism import X as POSITION_X
from derive.mechanism import Y as POSITION_Y
from derive.vectors import cross, minus, vector

Name = Callable[[str], str]


def _machine(name: str, **stated: object) -> Mechanism:
    common = {"vendor": Vendor.TEXTBOOK, "family": "odd", "source": "the tests", "summary": "A machine of the tests."}
    return Mechanism(name=f"Kin_{name}", **{**common, **stated})  # type: ignore[arg-type]


def _scara(title: str, name: Name) -> Mechanism:
    """A SCARA on a base, with a tool beside its quill."""
    first, second, quill = rotary(name("J1"), "arm 1"), rotary(name("J2"), "arm 2"), linear(name("J3"), "quill")
    turn = rotary(name("J4"), "turn of the quill")
    arms = [length(name(f"arm_{k}"), f"arm {k}", nominal=v) for k, v in ((1, 300.0), (2, 250.0))]
    base = [distance(name(f"base_{k}"), f"base, part {k}", nominal=7.0 * k) for k in range(1, 10)]
    lean, tool = angle(name("lean"), "turn of the base", nominal=20.0), distance(name("tip"), "tool", nominal=40.0)
    up = base[3] + base[4] + base[5] + base[6] + base[7] + base[8]
    return _machine(
        title,
        joints=(first, second, quill, turn),
        parameters=(*arms, *base, lean, tool),
        chain=Rz(radians(lean))
        * Txyz(base[0] - base[1], base[2], up)
        * Rz(first)
        * Tx(arms[0])
        * Rz(second)
        * Tx(arms[1])
        * Tz(quill)
        * Rz(turn)
        * Tx(tool),
        task=Task("xyz", Turning.ABOUT_Z),
        branches=(branch(name("elbow"), sin(second), **{name("right"): 1, name("left"): -1}),),
        notes=(f"The parameter {name('tip')} is measured from the quill, {name('base_9')} from the floor.",),
    )


def _plane_arm(title: str, name: Name) -> Mechanism:
    """An arm in a plane whose lengths are sums of many."""
    first, second, last = (rotary(name(f"J{k}"), f"turn {k}") for k in (1, 2, 3))
    parts = [length(name(f"part_{k}"), f"part {k}", nominal=60.0 + k) for k in range(1, 7)]
    further = [distance(name(f"more_{k}"), f"more of the arm, {k}", nominal=11.0 * k) for k in range(1, 6)]
    way = sign(name("way"), "sense of the last axis")
    return _machine(
        title,
        joints=(first, second, last),
        parameters=(*parts, *further, way),
        chain=Tx(further[0] + further[1])
        * Ty(further[2] - further[3] + further[4])
        * Rz(first)
        * Tx(parts[0] + parts[1] + parts[2])
        * Rz(second)
        * Tx(parts[3] + parts[4] + parts[5])
        * Rz(way * last),
        task=Task("xy", Turning.ABOUT_Z),
        branches=(branch(name("elbow"), sin(second), **{name("right"): 1, name("left"): -1}),),
    )


def _five_bar(title: str, name: Name) -> Mechanism:
    """A five-bar linkage whose feet have coordinates: equations of a loop read the coordinates of the pose, too."""
    first, second = rotary(name("J1"), "left arm"), rotary(name("J2"), "right arm")
    arms = [length(name(f"arm_{k}"), f"arm {k}", nominal=200.0 + k) for k in (1, 2)]
    rods = [length(name(f"rod_{k}"), f"rod {k}", nominal=300.0 + k) for k in (1, 2)]
    foot = [distance(name(f"foot_{k}"), f"foot {k}", nominal=v) for k, v in ((1, -150.0), (2, 10.0), (3, 150.0))]
    knees = [
        (foot[0] + arms[0] * cos(first), foot[1] + arms[0] * sin(first)),
        (foot[2] + arms[1] * cos(second), foot[1] + arms[1] * sin(second)),
    ]
    lines = [minus(vector(POSITION_X, POSITION_Y), vector(*knee)) for knee in knees]
    return _machine(
        title,
        joints=(first, second),
        parameters=(*arms, *rods, *foot),
        rods=tuple(rod(str(k + 1), knees[k], (POSITION_X, POSITION_Y), rods[k]) for k in (0, 1)),
        task=Task("xy"),
        assembly=assembly("tcp", cross(*lines), margin="aligned", below=-1, above=+1),
    )


@dataclass(frozen=True)
class Odd:
    """A machine with odd names, its twin, and what the languages call what they cannot call as it is called."""

    make: Callable[[str, Name], Mechanism]
    names: Mapping[str, str]
    """Of the twin → of the machine."""
    python: Mapping[str, str]
    """Of the machine → the keyword of its class, where these differ."""
    text: Mapping[str, str]
    """Of the machine → the input of its block, where it is not the usual one."""

    title: str

    def mechanism(self) -> Mechanism:
        return self.make(f"Odd{self.title}", lambda name: self.names.get(name, name))

    def twin(self) -> Mechanism:
        """The same with plain names."""
        return self.make(f"Plain{self.title}", lambda name: name)


def _named(own: str, odd: str) -> dict[str, str]:
    return dict(zip(own.split(), odd.split(), strict=True))


ODD: Mapping[str, Odd] = {
    "words of the languages": Odd(
        _scara,
        _named(
            "J1 J2 J3 J4 arm_1 arm_2 base_1 base_2 base_3 base_4 base_5 base_6 base_7 base_8 base_9 lean tip elbow",
            "R S X Y int single x given_x r11 configuration frame math np machine point_x self tool_x lambda",
        )
        | {"right": "automatic", "left": "class"},
        {"self": "self_", "configuration": "configuration_"},
        {"int": "dIntLength"},
        "Words",
    ),
    "constants called as words": Odd(
        _scara, _named("arm_1 arm_2 tip", "lambda np del"), {"lambda": "lambda_", "del": "del_"}, {}, "Constants"
    ),
    "names of the derivation": Odd(
        _plane_arm,
        _named(
            "J1 J2 J3 part_1 part_2 part_3 part_4 part_5 part_6 more_1 more_2 more_3 more_4 more_5 way",
            "A1 A2 A3 upper_a1 upper_a1_length reach cos_a2 lambda lambda_ tool_x toolx x axis_a1 r11 sigma_elbow",
        ),
        {"upper_a1": "upper_a1_length_2", "lambda": "lambda_length"},
        {"upper_a1": "dUpperA1Length2", "lambda_": "dLambdaLength", "toolx": "dToolxDistance"},
        "Derivation",
    ),
    "joints called Arm and Offset": Odd(
        _plane_arm,
        _named(
            "J1 J2 J3 part_1 part_2 part_3 part_4 part_5 part_6 more_1 more_2 more_3 more_4 more_5 way elbow",
            "Arm Offset Reach upper_arm lower_arm offset_arm axis_offset offset_offset int "
            "int_length L1 a__b heading point_x sin_offset tried",
        ),
        {
            "upper_arm": "upper_arm_length",
            "lower_arm": "lower_arm_length",
            "offset_arm": "offset_arm_length",
            "offset_offset": "offset_offset_length",
        },
        {
            "upper_arm": "dUpperArmLength",
            "lower_arm": "dLowerArmLength",
            "offset_arm": "dOffsetArmLength",
            "offset_offset": "dOffsetOffsetLength",
            "int": "dIntLength2",
        },
        "Arm",
    ),
    "coordinates of a loop": Odd(
        _five_bar,
        _named("J1 J2 arm_1 arm_2 rod_1 rod_2 foot_1 foot_2 foot_3", "X Y check_limits min_type2_margin reach r x y z"),
        {"check_limits": "check_limits_length", "min_type2_margin": "min_type2_margin_length"},
        {"min_type2_margin": "dMinType2MarginLength"},
        "Loop",
    ),
}
"""The machines, by what their names are."""
