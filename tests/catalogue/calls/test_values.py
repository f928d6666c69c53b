"""A machine is a value: written down and read again, equal, hashed, copied, never changed; and shown as a table."""

import copy
import pickle
import re
import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Mechanism, Status

from tests.catalogue.calls.mountings import (
    BASE,
    EVERY,
    NAMES,
    confirm_copies,
    limited,
    machines,
    mounted,
    radian,
    robots,
)
from tests.catalogue.refusals import refusal

UNCHANGED = (
    "bare", "base", "tool", "checks_limits", "parameters", "_constants", "_shift", "forward", "AXES", "limits", "part",
    "new",
)  # fmt: skip
SCARA = {"link_length_1": 325.0, "link_length_2": 225.0}


class Own(softkin.Scara2Z):
    """A user's machine, whose dimensions nobody gives, with an attribute of its own."""

    def __init__(self, label: str) -> None:
        super().__init__(arm_length_1=300.0, arm_length_2=200.0)
        self.label = label


class Slotted(softkin.Gantry2):
    """A user's machine with a slot."""

    __slots__ = ("label",)

    def __init__(self) -> None:
        super().__init__()
        self.label = "mine"


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_every_machine_is_a_value(name: str) -> None:
    """Copies of every kind are equal, with base and tool and in radians, too; another parameter or tool makes another
    machine, and nothing of one changes.
    """
    for robot, axes, _ in limited(name, np.random.default_rng(6)):
        made = mounted(robot)
        radians = made.in_radians()
        assert mounted(robot.in_radians()) == radians and radians.in_degrees() is made
        for one, at in ((robot, axes), (made, axes), (radians, radian(robot, axes))):
            own = type(robot) if one is robot else softkin.Mounted
            confirm_copies(one, at, own.from_json(one.to_json()))
            for parameter in one.PARAMETERS:
                assert getattr(one, parameter.name) == one.parameters[parameter.name]
            before = (repr(one), one.checks_limits, one.forward(at))
            for attribute in UNCHANGED:
                with pytest.raises(AttributeError):
                    setattr(one, attribute, {})
            for attribute in ("checks_limits", "parameters"):
                with pytest.raises(AttributeError):
                    delattr(one, attribute)
            with pytest.raises(TypeError):
                one.parameters["check_limits"] = False  # type: ignore[index]
            assert (repr(one), one.checks_limits, one.forward(at)) == before
            if one.PARAMETERS:
                other = one.changed(check_limits=False)
                assert other != one and not other.check_limits and other.changed(check_limits=True) == one
        for one in (made, radians):
            assert one.changed(base=BASE.matrix) == one != one.changed(tool=softkin.Frame((0.0, 0.0, 0.0)))
            assert one.changed(tool=softkin.Frame((0.0, 0.0, 0.0))) == one.changed(tool=np.eye(4))
        assert made != radians and made != robot and made.limits == robot.limits


@pytest.mark.parametrize("name", NAMES)
def test_one_mapping_is_the_single_limits(name: str) -> None:
    """Both ends by a mapping or by themselves: the same machine; one end alone limits one side."""
    made = robots(name)[0].made
    if isinstance(made, softkin.Coupled):
        return
    for axis in made.AXES:
        key = axis.name.lower()
        both = made.changed(limits={axis.name: (-3.0, 5.0)})
        assert both == made.changed(**{f"lower_{key}": -3.0, f"upper_{key}": 5.0})
        assert both.limits[axis.name] == (-3.0, 5.0)
        assert both.changed(limits={axis.name: None}).limits[axis.name] is None
        for ends, inside, outside in (((-3.0, None), (0.0, 100.0), -4.0), ((None, 5.0), (0.0, -100.0), 6.0)):
            sided = made.changed(limits={axis.name: ends})
            assert sided.limits[axis.name] == ends
            low, high = sided._ranges()[made.AXES.index(axis)]
            least, most = made._ranges()[made.AXES.index(axis)]  # a radius is not negative, whatever the limits
            assert all(low <= value <= high for value in inside if least <= value <= most)
            assert not low <= outside <= high


def test_one_sided_limits_refuse() -> None:
    """In a scalar call and in a batch, at the end and with its tolerance; the other side is free."""
    robot = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0, limits={"Z": (None, 10.0), "A1": (0.0, None)})
    for axes, expected in (
        ((5.0, 30.0, -1e6), Status.OK),
        ((5.0, 30.0, 10.0 + 1e-9), Status.OK),
        ((5.0, 30.0, 10.1), Status.UNREACHABLE),
        ((-1.0, 30.0, 0.0), Status.UNREACHABLE),
        ((1000.0, 30.0, 0.0), Status.OK),
    ):
        frame, configuration = robot.forward(axes)
        assert robot.diagnose(frame, configuration, axes).status is expected
        _, status = robot.inverse_batch([frame.position], [frame.rotation], configuration, axes)
        assert status[0] == expected
    climbing = softkin.Scara4ZCcoupledType1(**SCARA, pitch_zc=20.0, limits={"A4": (None, 100.0)})
    assert climbing._ranges()[3] == pytest.approx((-720.0, 100.0), abs=1e-5)  # a climbing axis always has limits


def test_what_limits_may_be() -> None:
    """Unknown axes, wrong pairs, limits given twice."""
    for limits in (
        {"A9": (0.0, 1.0)},
        {"A1": (1.0,)},
        {"A1": (2.0, 1.0)},
        {"A1": (0.0, 0.0)},
        {"A1": (float("nan"), 1.0)},
        {"A1": (0.0, float("inf"))},
        {"A1": (0.0, 1e300)},
        {"A1": "12"},
        {"A1": {0.0, 1.0}},
        {"A1": 5.0},
        [("A1", (0.0, 1.0))],
    ):
        assert refusal(softkin.Scara4ZCcoupledType1, **SCARA, limits=limits) is Status.NOT_INITIALIZED
    with pytest.raises(KinematicsError, match="A1, A2, A3, A4"):
        softkin.Scara4ZCcoupledType1(**SCARA, limits={"A9": None})
    with pytest.raises(KinematicsError, match="given once"):
        softkin.Scara4ZCcoupledType1(**SCARA, lower_a1=-5.0, upper_a1=5.0, limits={"A1": (-5.0, 5.0)})
    assert set(softkin.PCC(link_length_1=300.0, link_length_2=200.0, limits={"elbow": (0.0, 170.0)}).limits) == {
        "A1", "A2", "elbow",
    }  # fmt: skip


def test_what_a_dictionary_may_be() -> None:
    """A class reads its own, `Mechanism` any; other names are told."""
    plain = {"mechanism": "Kin_Scara4_ZCcoupled_Type1", **SCARA}
    robot = softkin.Scara4ZCcoupledType1(**SCARA)
    assert Mechanism.from_dict(plain) == softkin.Scara4ZCcoupledType1.from_dict(SCARA) == robot
    for given, words in (
        ({**plain, "link_length_3": 1.0}, "link_length_3.*link_length_1"),
        ({"mechanism": "Kin_Scara4_ZCcoupled_Type1"}, "link_length_1, link_length_2"),
        ({"mechanism": "Kin_Nothing"}, "Kin_Scara4"),
        (SCARA, "mechanism"),
    ):
        with pytest.raises(KinematicsError, match=words):
            Mechanism.from_dict(given)
    with pytest.raises(KinematicsError):
        softkin.Gantry2.from_dict(plain)
    for text in ("{", "[]", "3"):
        with pytest.raises(KinematicsError):
            Mechanism.from_json(text)


def test_subclasses() -> None:
    """A subclass pickles whatever its arguments are, keeps its own attributes, and cannot change the machine."""
    for robot in (Own("left"), Slotted()):
        axes = (1.0,) * len(robot.AXES)
        for other in (copy.copy(robot), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))):
            assert type(other) is type(robot) and other == robot and other.label == robot.label
            assert other.forward(axes) == robot.forward(axes)
        with pytest.raises(AttributeError):
            robot.checks_limits = False
        assert type(robot.changed(check_limits=False)) is type(robot)
    own = Own("left")
    own.label = "right"
    assert own.label == "right" and own.in_radians().forward((0.1, 0.2, 3.0))
    assert own != softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0)


def test_machines_are_keys() -> None:
    first, second = softkin.Gantry2(), softkin.Gantry2(offset_x=0)
    assert len({first, second, softkin.Gantry2(offset_x=1.0), softkin.Gantry3()}) == 3
    wrist: Any = softkin.Wrist2()
    pair = softkin.Coupled(softkin.Gantry3(), wrist)
    assert {pair: 1}[softkin.Coupled(softkin.Gantry3(), softkin.Wrist2())] == 1
    assert pair.changed(orientation=softkin.Wrist3()) == softkin.Coupled(softkin.Gantry3(), softkin.Wrist3())
    with pytest.raises(KinematicsError, match="must be an orientation kinematics"):
        softkin.Coupled(softkin.Gantry3(), softkin.Gantry3())  # type: ignore[arg-type]
    with pytest.raises(KinematicsError, match="is an orientation kinematics"):
        softkin.Coupled(softkin.Wrist3(), softkin.Wrist3())


@pytest.mark.parametrize("part", ["position", "orientation"])
@pytest.mark.parametrize("wrong", [5, None, "Kin_Gantry3", ["Kin_Gantry3"]])
def test_a_coupling_says_which_part_is_wrong(part: str, wrong: object) -> None:
    """Data of another program, or a file that someone has edited."""
    data = softkin.Coupled(softkin.Gantry3(), softkin.Wrist2()).to_dict()
    with pytest.raises(KinematicsError, match=f"Coupled: {part} must be the dictionary of a machine"):
        softkin.Coupled.from_dict({**data, part: wrong})


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_all_that_a_machine_has_is_in_its_tables(name: str) -> None:
    """Axes, given parameters, branches, base and tool: as text and as well-formed HTML, in degrees and in radians."""
    for bare, _, _ in machines(name):
        made = mounted(bare)
        for robot in (bare, bare.in_radians(), made, made.in_radians()):
            text = str(robot)
            page = ET.fromstring(robot._repr_html_())
            cells = ["".join(cell.itertext()) for cell in page.iter("td")]
            drawings = ["".join(drawing.itertext()) for drawing in page.iter("{http://www.w3.org/2000/svg}svg")]
            assert len(drawings) == (2 if isinstance(bare, softkin.Coupled) else 1)
            assert all(axis.name.removeprefix("orientation ") in "".join(drawings) for axis in robot.AXES)
            lines = text.splitlines()
            assert lines[0] == robot.NAME and "\n" not in repr(robot)
            expected = [name for axis in robot.AXES for name in (axis.name, axis.meaning)]
            expected += [part for byte in robot.CONFIGURATION for part in (byte.name, ", ".join(byte.branches))]
            expected += [p.meaning for p in bare.PARAMETERS if p.default is None]
            assert all(word in text and (word in cells or not word) for word in expected)
            frames = [line.split()[0] for line in lines if line[:5] in ("base ", "tool ")]
            assert frames == ["base", "tool"] * (robot.in_degrees() is made)


@pytest.mark.broad
def test_limits_are_in_the_unit_of_the_axis() -> None:
    """Both ends, one end, none; those of a quantity beside the axes; flags that differ from the default."""
    robot = softkin.Scara4ZCcoupledType1(
        link_length_1=325.0, link_length_2=225.0, limits={"A1": (-180.0, 90.0), "A2": (-10.0, None), "A3": (None, 5.0)}
    )
    lines = str(robot.in_radians()).splitlines()[3:7]
    found = [re.split(r" {2,}", line)[2] for line in lines]
    assert found == ["-3.14159 to 1.5708 rad", "from -0.174533 rad", "to 5 u", "none"]
    arm = softkin.PCC(link_length_1=300.0, link_length_2=200.0, lower_elbow=10.0, upper_elbow=170.0)
    for robot, words in ((arm, "10 to 170 deg"), (arm.in_radians(), "0.174533 to 2.96706 rad")):
        for one in (robot, robot.with_base(BASE)):
            assert words in next(line for line in str(one).splitlines() if line.startswith("elbow"))


@pytest.mark.broad
def test_a_path_is_one_line() -> None:
    """The number of samples, and where and why it stops."""
    robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
    frame, _ = robot.forward((10.0, 20.0, 5.0, 30.0))
    line = robot.in_radians().line(frame, frame.shifted(x=300.0), samples=50)
    assert line.stop is not None
    assert repr(line).startswith(f"<Path of Kin_Scara4_ZCcoupled_Type1: {len(line.axes)} samples, stops at 0.0")
    assert "A2: out of reach" in repr(line) and len(repr(line)) < 120
