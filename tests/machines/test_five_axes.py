"""The family of five-axis machines: every order of the turning axes, against a chain of its own in NumPy."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest
import softkin
from numpy.typing import NDArray
from softkin import Frame, KinematicsError, Status

from derive import compile_mechanism
from derive.five_axes import ORDERS, five_axes
from derive.mechanism import DescriptionError
from tests.catalogue.five_axes import AXES
from tests.catalogue.five_axes import tool as by_hand
from tests.mechanisms import catalogue

Array = NDArray[np.float64]
LENGTHS = {"pivot_x": 30.0, "pivot_y": -40.0, "pivot_z": 55.0, "tool_length": 120.0, "fork_offset": 25.0,
           "head_offset": -15.0, "pivot_length": 200.0, "tool_x": 7.0, "tool_y": -11.0}  # fmt: skip
NUTATION = 52.0
VARIANTS = [
    *((order, is_nutating, False) for order in ORDERS for is_nutating in (False, True)),
    ("TableTable_AC", False, True), ("TableTable_BA", True, True), ("HeadTable_BA", True, True),
    ("HeadHead_CB", True, True), ("HeadHead_AB", False, True),
]  # fmt: skip
PRESENT = (12.0, -7.0, 33.0)


@cache
def machine(order: str, nutating: bool, further: bool) -> softkin.Mechanism:
    """If there is `further`, axes have errors of their location, and the tip is beside the axis of the spindle."""
    head, table = ORDERS[order]
    more = {"location_errors": further, "tool_vector": further}
    described = five_axes("FiveAxes", head=head, table=table, nutating=nutating, **more)
    names = [p.name for p in described.parameters]
    given = {name: LENGTHS[name] for name in names if name in LENGTHS} | ({"nutation": NUTATION} if nutating else {})
    given |= {name: 0.3 + 0.1 * k for k, name in enumerate(names) if name not in given}
    made: softkin.Mechanism = compile_mechanism(described)(**given)
    return made


def tool(robot: softkin.Mechanism, order: str, axes: Array) -> tuple[Array, Array]:
    """The tip and the direction of the tool, seen from the workpiece."""
    row = np.array([*axes[:3], *np.radians(axes[3:])])
    tips, rotations = by_hand(*ORDERS[order], robot.parameters, row[:, None])
    return tips[0], rotations[0, :, 2]


def values(solutions: Sequence[softkin.Solution]) -> Array:
    assert [s.status for s in solutions] == [Status.OK] * 2
    return np.array([s.axes for s in solutions])


@pytest.mark.parametrize(("order", "nutating", "further"), VARIANTS)
def test_both_solutions_bring_the_tool_there(order: str, nutating: bool, further: bool) -> None:
    """Forward kinematics is the chain; the inverse has the pose itself and another one, on the nearest turns."""
    robot = machine(order, nutating, further)
    for axes in np.random.default_rng(3).uniform((-80,) * 3 + (-500,) * 2, (80,) * 3 + (500,) * 2, (25, 5)):
        tip, direction = tool(robot, order, axes)
        frame, configuration = robot.forward(axes)
        assert np.abs(tip - frame.position).max() < 1e-10
        assert np.abs(direction - frame.matrix[:3, 2]).max() < 1e-12
        assert robot.inverse(frame, configuration, axes) == pytest.approx(tuple(axes), abs=1e-7)
        solutions = values(robot.inverse_all(frame, axes))
        assert len(solutions) == 2 and min(np.abs(np.subtract(s, axes)).max() for s in solutions) < 1e-7
        assert np.abs(solutions[0] - solutions[1]).max() > 1e-3
        for found in solutions:
            assert np.abs(np.subtract(found, axes))[3:].max() <= 180.0 + 1e-9
            there, along = tool(robot, order, found)
            assert np.abs(there - tip).max() < 1e-8 and np.abs(along - direction).max() < 1e-10


@pytest.mark.parametrize("order", ORDERS)
def test_at_the_pole_the_last_axis_stays(order: str) -> None:
    """Where the tool is along the axis next to the workpiece, or that of the fork, that axis is free."""
    robot = machine(order, False, False)
    head, table = ORDERS[order]
    outer = (table[::-1] + head)[0]
    place, other = 3 + (head + table).index(outer), 3 + (head + table).index((table[::-1] + head)[1])
    axes = np.array([*PRESENT, 0.0, 0.0])
    axes[place], axes[other] = 310.0, 0.0 if outer == "C" else 90.0
    assert abs(tool(robot, order, axes)[1] @ AXES[outer]) == pytest.approx(1.0)
    assert robot.singularity(axes).is_singular
    for solution in robot.inverse_all(robot.forward(axes)[0], axes):
        assert solution.axes is not None and solution.axes[place] == pytest.approx(310.0)


@pytest.mark.parametrize(("order", "nutating", "further"), VARIANTS)
def test_a_tilted_plane_turns_the_tool_alone(order: str, nutating: bool, further: bool) -> None:
    """Both solutions have the normal along the tool; slides stay, in radians as in degrees, with a base, too."""
    robot = machine(order, nutating, further)
    base = Frame.from_euler(20.0, 70.0, -40.0, (5.0, 6.0, 7.0))
    for turned in np.random.default_rng(4).uniform(-200.0, 200.0, (10, 2)):
        present = np.array([*PRESENT, *turned])
        normal = tool(robot, order, present)[1]
        x = np.cross(normal, (0.3, 0.5, 0.8))
        x /= np.linalg.norm(x)
        plane = Frame.from_rotation(np.stack([x, np.cross(normal, x), normal], axis=1), (1e5, 0.0, 0.0))
        found = robot.tilted_plane(plane, (*PRESENT, 0.0, 700.0))
        for axes in values(found):
            assert tuple(axes[:3]) == PRESENT and np.abs(tool(robot, order, axes)[1] - normal).max() < 1e-10
            assert abs(axes[3]) <= 180.0 + 1e-9 and abs(axes[4] - 700.0) <= 180.0 + 1e-9
        moved = robot.with_base(base).tilted_plane(base @ plane, (*PRESENT, 0.0, 700.0))
        assert np.allclose(values(moved), values(found), rtol=0.0, atol=1e-7)
        radians = robot.in_radians().tilted_plane(plane, (*PRESENT, 0.0, np.radians(700.0)))
        assert np.allclose(np.degrees(values(radians)[:, 3:]), values(found)[:, 3:], rtol=0.0, atol=1e-7)


def test_a_machine_without_a_direction_has_no_tilted_plane() -> None:
    scara = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    with pytest.raises(KinematicsError, match="tilted_plane: its task is not the direction of a tool: ask inverse_all"):
        scara.tilted_plane(Frame((0.0, 0.0, 0.0)), (0.0, 0.0, 0.0))
    with pytest.raises(KinematicsError, match="a rotation must be one"):
        machine("TableTable_AB", False, False).tilted_plane(((0, 0, 0), np.zeros((3, 3))), (0.0,) * 5)


def test_an_order_that_tilts_no_tool_is_refused() -> None:
    with pytest.raises(DescriptionError, match=r"head='C' table='A' is no order of five axes: take one of"):
        five_axes("Wrong", head="C", table="A")


def test_the_catalogue_has_the_eight_that_shops_have_most() -> None:
    found = {m.name for _, m in catalogue() if m.family == "five_axis"}
    straight = {"TableTable_AC", "TableTable_BC", "HeadTable_AC", "HeadTable_BC", "HeadHead_CA", "HeadHead_CB"}
    assert found >= {f"Softkin_{name}" for name in (*straight, "NutatingTable_BC", "NutatingHead_CB")}
