"""A machine at the prompt and in a notebook: what it has is in the tables, and every `repr` is one line."""

import re
import xml.etree.ElementTree as ET

import pytest
import softkin

from tests.catalogue.calls.mountings import BASE, EVERY, machines, tool_of

pytestmark = pytest.mark.broad


@pytest.mark.parametrize("name", EVERY)
def test_all_that_a_machine_has_is_in_its_tables(name: str) -> None:
    """Axes, given parameters, branches, base and tool: as text and as well-formed HTML, in degrees and in radians."""
    for bare, _, _ in machines(name):
        mounted = bare.with_base(BASE).with_tool(tool_of(bare))
        for robot in (bare, bare.in_radians(), mounted, mounted.in_radians()):
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
            assert frames == ["base", "tool"] * (robot.in_degrees() is mounted)


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
        mounted = robot.with_base(BASE)
        for one in (robot, mounted):
            assert words in next(line for line in str(one).splitlines() if line.startswith("elbow"))


def test_a_path_is_one_line() -> None:
    """The number of samples, and where and why it stops."""
    robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
    frame, _ = robot.forward((10.0, 20.0, 5.0, 30.0))
    line = robot.in_radians().line(frame, frame.shifted(x=300.0), samples=50)
    assert line.stop is not None
    assert repr(line).startswith(f"<Path of Kin_Scara4_ZCcoupled_Type1: {len(line.axes)} samples, stops at 0.0")
    assert "A2: out of reach" in repr(line) and len(repr(line)) < 120
