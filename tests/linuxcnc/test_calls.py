"""What LinuxCNC asks of a module beside numbers: pins, parameters, flags, identity, refusals, garbage."""

from __future__ import annotations

import ctypes
import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from derive.description.mechanism import Turning
from derive.emit.c.description import inputs
from derive.emit.linuxcnc import package
from tests.linuxcnc.machine import NAMES, Machine, differs, machine_of, recorded
from tests.linuxcnc.module import LETTERS, STUBS, Module, Pose, module_of
from tests.mechanisms import kinematics_of, named
from tests.orthonormal import about

pytestmark = pytest.mark.broad

NAN, INFINITY = float("nan"), float("inf")
ODD = (NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e9, 1.0000001e9, 5e-324, -0.0, 1e-160)
SCARA, ARM, TRUNNION = "Kin_Scara4_ZCcoupled_Type1", "Kin_ArticulatedRobot_6DOF", "Softkin_TableTable_AC"
AXES = [30.0, 40.0, -50.0, 60.0]
LENGTHS = {"link_length_1": 325.0, "link_length_2": 225.0}
IN, OUT, BIT, FLOAT, S32 = 16, 32, 1, 2, 3
COUNTED = [name for name in NAMES if named(name).task.turning is Turning.ABOUT_Z and name != "Softkin_Planar_3RRR"]
"""Machines of which C is a sum of joints."""
WRITTEN = {
    "softkin.parameters-refused": BIT, "softkin.parameter-refused": S32, "softkin.is-singular": BIT,
    "softkin.forward-status": S32, "softkin.inverse-status": S32, "softkin.missing": FLOAT,
    "kinstype.is-0": BIT, "kinstype.is-1": BIT,
}  # fmt: skip


def pose_of(machine: Machine, axes: list[float], before: Pose | None = None) -> Pose:
    """The pose of joint values, which must have one."""
    found = machine.module.forward(axes, before)
    assert found is not None
    return found


@pytest.mark.parametrize("stub", STUBS)
@pytest.mark.parametrize("name", [SCARA, ARM, TRUNNION, "Kin_P2C_Type1", "Kin_Hexapod"])
def test_pins(name: str, stub: str) -> None:
    """One a parameter, with its default, made when the module is loaded, and never again."""
    module, kin = module_of(name, stub), kinematics_of(named(name))
    library = module.library
    assert library.stub_component().decode() == f"{package.part(kin)['index']['module']}"
    names = [library.stub_name(i).decode() for i in range(library.stub_count())]
    given = [inputs(kin).names[p.name].replace("_", "-") for p in kin.parameters]
    longer = ["softkin.tool-offset"] if len(kin.mechanism.joints) in (5, 6) and kin.mechanism.chain else []
    assert names == [f"softkin.{one}" for one in given] + longer + list(WRITTEN)
    for i, p in enumerate(kin.parameters):
        assert library.stub_direction(i) == IN
        assert library.stub_type(i) == (BIT if p.role.value == "flag" else FLOAT)
        assert library.stub_get(i) == float(p.default or 0.0)
    for i, kind in enumerate(WRITTEN.values(), len(given) + len(longer)):
        assert (library.stub_direction(i), library.stub_type(i)) == (OUT, kind)
    for _ in range(2):
        assert library.kinematicsType() == 4 and library.kinematicsSwitchable() == 1
    assert library.stub_count() == len(names) and module.get("kinstype.is-0") == 1.0


def test_what_is_exported() -> None:
    """The calls that motion looks up, and a licence that says what the text is under."""
    library = module_of(SCARA).library
    calls = ("Type", "Switchable", "Switch", "Forward", "Inverse", "Jacobian")
    for one in calls:
        assert ctypes.c_char_p.in_dll(library, f"exported_kinematics{one}").value == f"kinematics{one}".encode()
    assert ctypes.c_char_p.in_dll(library, "module_license").value == b"Dual MIT/GPL"
    library.rtapi_app_exit()
    assert library.stub_count() == 0


@pytest.mark.parametrize("stub", STUBS)
def test_parameters(stub: str) -> None:
    """A length that is not set moves nothing; a refused one keeps what was; one that is allowed again is used."""
    module = module_of(SCARA, stub)
    assert module.forward(AXES) is None and module.inverse(dict.fromkeys(LETTERS, 1.0), AXES) is None
    assert module.get("softkin.parameters-refused") == 1.0 and module.get("softkin.parameter-refused") == 1.0
    assert module.get("softkin.forward-status") == module.get("softkin.inverse-status") == 1.0
    assert module.library.stub_messages() == 1  # once, however often it is called
    assert b"link_length_1 must be" in module.library.stub_message()
    module.set(**LENGTHS)
    first = module.forward(AXES)
    assert first is not None and module.get("softkin.parameters-refused") == 0.0
    for number, (name, wrong) in enumerate((("link_length_2", -1.0), ("pitch_zc", NAN), ("lower_a1", 5.0)), 1):
        module.set(**{name: wrong})
        for _ in range(3):
            assert module.forward(AXES) == first
            assert module.inverse(first, AXES) == pytest.approx(AXES, abs=1e-9)
        assert module.get("softkin.parameters-refused") == 1.0
        assert module.library.stub_messages() == 1 + number
        names = [p.name for p in kinematics_of(named(SCARA)).parameters]
        assert module.get("softkin.parameter-refused") == 1.0 + names.index(name)
        module.set(**LENGTHS, pitch_zc=0.0, lower_a1=0.0)
        assert module.forward(AXES) == first
        assert module.get("softkin.parameters-refused") == module.get("softkin.parameter-refused") == 0.0
    module.set(link_length_1=300.0)
    moved = module.forward(AXES)
    assert moved is not None and moved["X"] == pytest.approx(first["X"] - 25.0 * np.cos(np.radians(30.0)))


@pytest.mark.parametrize("stub", STUBS)
@pytest.mark.parametrize("name", [SCARA, ARM, TRUNNION, "Softkin_ScaraOnRail", "Kin_CAxis"])
def test_identity(name: str, stub: str) -> None:
    """Joints are letters, also of a machine that has no dimensions yet; another type is refused and changes nothing."""
    module, letters = module_of(name, stub), machine_of(name, stub).words.of_joints
    axes = [11.0 * (i + 1) for i in range(len(letters))]
    assert module.library.kinematicsSwitch(1) == 0
    assert (module.get("kinstype.is-0"), module.get("kinstype.is-1")) == (0.0, 1.0)
    for wrong in (2, -1, 7):
        assert module.library.kinematicsSwitch(wrong) == -1
    module.flags = 5
    pose = module.forward(axes)
    assert pose == dict.fromkeys(LETTERS, 0.0) | dict(zip(letters, axes, strict=True)) and module.flags == 5
    assert module.inverse(pose, [0.0] * len(axes)) == axes
    assert module.forward([NAN] * len(axes)) is None and module.inverse(pose | {letters[0]: NAN}, axes) is None
    assert module.library.kinematicsSwitch(0) == 0
    assert (module.get("kinstype.is-0"), module.get("kinstype.is-1")) == (1.0, 0.0)


def test_back_from_identity() -> None:
    """Poses of identity are joint values: behind it the last pose of the machine is the one before."""
    machine = machine_of(ARM)
    axes = [350.0, -70.0, 80.0, 20.0, 40.0, 5.0]
    before = pose_of(machine, axes, dict.fromkeys(LETTERS, 0.0) | {"C": 700.0})
    for _ in range(2):
        machine.module.library.kinematicsSwitch(1)
        identity = pose_of(machine, axes)
        machine.module.library.kinematicsSwitch(0)
        for _ in range(2):  # of the pose that is commanded, and of the one that is fed back
            assert pose_of(machine, axes, identity) == pytest.approx(before, abs=1e-9)
    assert pose_of(machine, axes, dict.fromkeys(LETTERS, 0.0))["C"] != pytest.approx(before["C"], abs=1.0)


def test_flags() -> None:
    """Forward kinematics writes the elbow, the inverse takes it; 0 and 3 are the one that is nearer to the joints."""
    machine = machine_of(SCARA)
    pose = pose_of(machine, AXES)
    assert machine.module.flags == 1
    right = machine.module.inverse(pose, [0.0, 0.0, 0.0, 0.0], 1)
    left = machine.module.inverse(pose, AXES, 2)
    assert right == pytest.approx(AXES, abs=1e-9) and left is not None and left[1] == pytest.approx(-40.0)
    for flags in (0, 3, 0xF0, (1 << 40) + 3):  # bits that belong to no branch are not read
        assert machine.module.inverse(pose, AXES, flags) == pytest.approx(AXES, abs=1e-9)
        assert machine.module.inverse(pose, left, flags) == pytest.approx(left, abs=1e-9)
    pose_of(machine, left)
    assert machine.module.flags == 2
    pose_of(machine, [10.0, 0.0, 0.0, 0.0])
    assert machine.module.flags == 3


def test_out_of_reach() -> None:
    """Refused with the status and what is missing, until a pose is in reach again."""
    machine = machine_of(SCARA)
    pose = pose_of(machine, AXES)
    assert machine.module.inverse(pose | {"X": 600.0, "Y": 0.0}, AXES) is None
    assert machine.module.get("softkin.inverse-status") == 3.0
    assert machine.module.get("softkin.missing") == pytest.approx(50.0)
    assert machine.module.inverse(pose, AXES) is not None
    assert machine.module.get("softkin.inverse-status") == machine.module.get("softkin.missing") == 0.0


def test_singular() -> None:
    """A pin says so near a stretched arm, as near as the parameter wants, and where there is no pose."""
    machine = machine_of(SCARA)
    seen = []
    for elbow, distance in ((40.0, 0.001), (0.01, 0.001), (0.5, 0.001), (0.5, 0.1)):
        machine.module.set(warning_distance=distance)
        pose_of(machine, [0.0, elbow, 0.0, 0.0])
        seen.append(machine.module.get("softkin.is-singular"))
    assert seen == [0.0, 1.0, 0.0, 1.0]
    assert machine.module.forward([NAN] * 4) is None and machine.module.get("softkin.is-singular") == 1.0


@pytest.mark.parametrize("offset", [0.0, 180.0, -90.0])
def test_turns_are_counted(offset: float) -> None:
    """C of a SCARA is a sum of joints on any turn, forward and back, and needs no pose before."""
    machine = machine_of(SCARA, offset_a4=offset, pitch_zc=0.0)
    constant = pose_of(machine, [0.0] * 4)["C"]
    assert constant == pytest.approx(-offset) or abs(offset) == 180.0
    for turn in (-700.0, -370.0, -180.0, -10.0, 0.0, 180.0, 350.0, 710.0):
        axes = [30.0, 40.0, 5.0, turn - 70.0]
        pose = pose_of(machine, axes)
        assert pose["C"] == pytest.approx(turn + constant, abs=1e-9)
        for reference in (axes, [0.0] * 4, [300.0, 40.0, 0.0, 5000.0]):
            joints = machine.module.inverse(pose, reference, 1)
            assert joints is not None and pose_of(machine, joints)["C"] == pytest.approx(pose["C"], abs=1e-9)
    machine.module.set(lower_a4=-170.0, upper_a4=170.0)
    assert machine.module.inverse(pose_of(machine, [30.0, 40.0, 5.0, 160.0]), AXES) is not None
    assert machine.module.inverse(pose_of(machine, [30.0, 40.0, 5.0, 200.0]), AXES) is None
    assert machine.module.get("softkin.inverse-status") == 3.0


@pytest.mark.parametrize("name", COUNTED)
def test_every_counted_turn(name: str) -> None:
    """A full turn of C is a full turn of the tool, which stays where it is; the pose says so again."""
    machine = machine_of(name)
    compared = 0
    for axes in recorded(name)[:4]:
        pose = machine.module.forward(axes)
        for turn in (-360.0, 360.0) if pose else ():
            asked = pose | {"C": pose["C"] + turn}
            joints = machine.module.inverse(asked, axes)
            if joints is not None:
                assert differs(joints, axes) > 90.0
                assert pose_of(machine, joints) == pytest.approx(asked, abs=1e-8)
                compared += 1
            else:
                assert machine.module.get("softkin.inverse-status") == 3.0
    assert compared >= 3


def test_a_pitch_follows_the_turn() -> None:
    """A quill that climbs when A4 turns has another height on another turn of C."""
    machine = machine_of(SCARA, pitch_zc=20.0)
    pose = pose_of(machine, AXES)
    joints = machine.module.inverse(pose | {"C": pose["C"] + 360.0}, AXES)
    assert joints is not None and joints[3] == pytest.approx(420.0)
    assert abs(joints[2] - AXES[2]) == pytest.approx(20.0)
    assert pose_of(machine, joints) == pytest.approx(pose | {"C": pose["C"] + 360.0}, abs=1e-9)


def test_angles() -> None:
    """R = Rz(C) Ry(B) Rx(A): turns about one axis, three at once, those near the pose before, and both triples."""
    machine = machine_of("Kin_Ac6_TXTYTZRYRXRZ")
    zero = dict.fromkeys(LETTERS, 0.0)
    home = np.array(machine.robot.forward([0.0] * 6)[0].rotation)
    rng = random.Random(5)
    for case in range(60):
        given = [rng.uniform(-400.0, 400.0) if case % 3 else 90.0 * rng.randint(-5, 5) for _ in range(3)]
        wanted = dict(zip("ABC", given, strict=True))
        joints = machine.module.inverse(zero | wanted, [0.0] * 6, 0)
        assert joints is not None
        turned = np.array(machine.robot.forward(joints)[0].rotation)
        assert np.allclose(turned, about(2, given[2]) @ about(1, given[1]) @ about(0, given[0]), atol=1e-9)
        again = pose_of(machine, joints, zero | wanted)
        assert [again[letter] for letter in "ABC"] == pytest.approx(given, abs=1e-6), given
        for odd in ODD:  # a pose before that is none is as zero
            found = pose_of(machine, joints, zero | dict.fromkeys("ABC", odd))
            turns = [found[letter] for letter in "ABC"]
            assert np.allclose(about(2, turns[2]) @ about(1, turns[1]) @ about(0, turns[0]), turned, atol=1e-6)
    assert np.allclose(home, np.eye(3), atol=1e-12)


def test_angles_go_on() -> None:
    """Along a way on which B passes a right angle the angles move in small steps, and none of them jumps."""
    machine = machine_of("Kin_Ac6_TXTYTZRYRXRZ")
    zero = dict.fromkeys(LETTERS, 0.0)
    way = [zero | {"A": 170.0 + 0.3 * k, "B": 40.0 + 0.9 * k, "C": -175.0 - 0.2 * k} for k in range(300)]
    joints, before, seen = [0.0] * 6, way[0], []
    for pose in way:
        found = machine.module.inverse(pose, joints)
        assert found is not None
        joints, before = found, pose_of(machine, found, before)
        seen.append([before[letter] for letter in "ABC"])
    assert max(differs(one, other) for one, other in pairwise(seen)) < 1.0
    assert seen[-1] == pytest.approx([way[-1][letter] for letter in "ABC"], abs=1e-6)


@pytest.mark.parametrize("name", [TRUNNION, "Softkin_HeadHead_CB", "Softkin_HeadTable_BC", "Kin_5Axes"])
def test_rotary_axes_are_letters(name: str) -> None:
    """Any value of a rotary axis is reached as it is, on any turn, also where the tool is along the other axis."""
    machine = machine_of(name)
    rng = random.Random(7)
    letters = [letter for letter in machine.words.own if letter]
    assert len(letters) == 2 and set(letters) <= set("ABC")
    for case in range(60):
        turns = {one: rng.choice([0.0, 1e-12, 90.0, -180.0, 400.0, rng.uniform(-500.0, 500.0)]) for one in letters}
        pose = dict.fromkeys(LETTERS, 0.0) | {letter: rng.uniform(-200.0, 200.0) for letter in "XYZ"} | turns
        joints = machine.module.inverse(pose, [1.0, 2.0, 3.0, 50.0, 60.0], case)
        assert joints is not None
        assert {letter: joints[machine.words.own.index(letter)] for letter in letters} == turns
        assert pose_of(machine, joints) == pytest.approx(pose, abs=1e-9)
    machine.module.set(**{f"lower_{letters[0].lower()}": -30.0, f"upper_{letters[0].lower()}": 30.0})
    assert machine.module.inverse(pose | {letters[0]: 29.0}, [0.0] * 5) is not None
    assert machine.module.inverse(pose | {letters[0]: 31.0}, [0.0] * 5) is None


def test_a_held_joint_is_a_letter() -> None:
    """The rail of a SCARA goes where U says, and the arm follows from there."""
    machine = machine_of("Softkin_ScaraOnRail")
    pose = pose_of(machine, [100.0, *AXES])
    assert pose["U"] == 100.0
    joints = machine.module.inverse(pose | {"U": 150.0}, [100.0, *AXES])
    assert joints is not None and joints[0] == 150.0
    assert pose_of(machine, joints) == pytest.approx(pose | {"U": 150.0}, abs=1e-9)


@pytest.mark.parametrize("name", ["Kin_Hexapod", "Softkin_Hexaglide", "Softkin_Pentapod", "Softkin_Planar_3RRR"])
def test_a_pose_before_that_is_far(name: str) -> None:
    """Iterations that begin too far away, or at no pose, begin again at home, and find the same pose."""
    machine = machine_of(name)
    compared = 0
    for axes in recorded(name)[:8]:
        pose = machine.module.forward(axes)
        if pose is None:
            continue
        for before in ({"Z": -1e3}, {"X": 1e8, "C": 90.0}, dict.fromkeys(LETTERS, NAN), pose):
            found = machine.module.forward(axes, before)
            assert found is not None
            assert [found[letter] for letter in "XYZ"] == pytest.approx([pose[letter] for letter in "XYZ"], abs=1e-6)
            compared += 1
    assert compared >= 12


@pytest.mark.parametrize("name", NAMES)
def test_garbage(name: str) -> None:
    """Whatever a call is given, it is refused and leaves everything, or its answer is a number (see `Module`)."""
    machine, rng = machine_of(name), random.Random(name)
    letters, count = machine.words.letters, machine.module.joints

    def number() -> float:
        return rng.choice(ODD) if rng.random() < 0.2 else 10.0 ** rng.uniform(-3, 4) * rng.choice((-1.0, 1.0))

    for _ in range(30 if kinematics_of(named(name)).search_given is None else 6):
        axes = [number() for _ in range(count)]
        pose = {letter: number() for letter in LETTERS}
        found = machine.module.forward(axes, pose)
        assert found is None or np.isfinite(list(found.values())).all()
        assert found is None or all(abs(value) <= 1e9 for value in axes)
        joints = machine.module.inverse(pose, [number() for _ in range(count)], rng.choice((0, 1, 2**64 - 1)))
        assert joints is None or np.isfinite(joints).all()
        assert joints is None or all(abs(pose[letter]) <= 1e9 for letter in letters)
        if not named(name).followed_turns:  # docs/LINUXCNC.md: one that follows a pitch has no Jacobian
            rates: Any = machine.module.jacobian(axes, pose)
            assert rates is None or np.isfinite(rates).all()


def test_a_module_by_itself() -> None:
    """Two modules that are loaded share nothing."""
    one, other = machine_of(SCARA), machine_of(SCARA)
    other.module.set(link_length_1=300.0)
    assert pose_of(one, AXES)["X"] != pose_of(other, AXES)["X"]
    assert isinstance(one.module, Module)
