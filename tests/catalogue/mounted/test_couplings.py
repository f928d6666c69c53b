"""Couplings with tools and on bases: which are possible, and that they go round."""

import math

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status

from tests.catalogue.mounted.machines import BASE, TOOL, couplings, matrices
from tests.text.samples import tilted

EVERY_COUPLING = pytest.mark.parametrize("name", couplings())
ASIDE = Frame((25.0, 0.0, 0.0))


@EVERY_COUPLING
def test_couplings_carry_tools_and_stand_on_bases(name: str) -> None:
    """The frames of a coupling, with a base and with a tool where one is determined; batches and single calls."""
    coupled = couplings()[name]
    rng = np.random.default_rng(11)
    axes = rng.uniform(20.0, 80.0, (8, len(coupled.AXES)))
    positions, rotations, _, _ = coupled.forward_batch(axes)
    flange = matrices(positions, rotations)
    straight = Frame.from_euler(50.0, 0.0, 0.0, (0.0, 0.0, 44.0))
    robot = coupled.with_tool(straight if name == "gantry, wrist" else TOOL).with_base(BASE)
    expected = BASE.matrix @ flange @ robot.tool.matrix
    found = robot.forward_batch(axes)
    assert np.abs(matrices(found[0], found[1]) - expected).max() < 1e-9
    back, statuses = robot.inverse_batch(expected, None, found[2], axes)
    assert (statuses == Status.OK).all() and np.abs(back - axes).max() < 1e-7
    for row, matrix, data in zip(axes.tolist(), expected, found[2], strict=True):
        assert robot.inverse(matrix, data, row) == pytest.approx(tuple(row), abs=1e-7)
        free = (matrix[:3, 3], tilted(rng))
        for slot in robot.inverse_all(free, row):
            if slot.axes is not None:
                assert np.abs(robot.forward(slot.axes)[0].position - matrix[:3, 3]).max() < 1e-9
    if name == "gantry, wrist":
        with pytest.raises(KinematicsError, match="along z only"):
            coupled.with_tool(ASIDE)


def test_couplings_whose_flange_is_not_determined() -> None:
    """A C axis behind an arm that turns its flange, a wrist that follows a direction there, a tool on a SCARA."""
    arm = softkin.PosRRR(d1=350.0, a1=80.0, a2=310.0, d3=50.0, a3=30.0, d4=290.0)
    scara = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    along = Frame((0.0, 0.0, 44.0))
    cases = (
        (softkin.Coupled(arm, softkin.CAxis()), (ASIDE, along), ()),
        (softkin.Coupled(arm, softkin.Wrist2(tool_length=90.0)), (ASIDE,), (along,)),
        (softkin.Coupled(scara, softkin.Wrist2(tool_length=90.0)), (ASIDE,), (along,)),
        (softkin.Coupled(scara, softkin.Tool(tool_z=-60.0)), (ASIDE,), (along,)),
        (softkin.Coupled(arm, softkin.Tool()), (ASIDE, along), ()),
    )
    for coupled, refused, carried in cases:
        for tool in refused:
            with pytest.raises(KinematicsError, match="does not determine the flange"):
                coupled.with_tool(tool)
        for tool in (Frame((0.0, 0.0, 0.0)), *carried):
            robot = coupled.with_tool(tool).with_base(BASE)
            axes = tuple(np.random.default_rng(6).uniform(20.0, 60.0, len(robot.AXES)).tolist())
            frame, configuration = robot.forward(axes)
            assert robot.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-8)
            back, statuses = robot.inverse_batch([frame], None, configuration, axes)
            assert statuses.tolist() == [Status.OK] and back[0] == pytest.approx(axes, abs=1e-8)


def test_a_turn_that_is_commanded_carries_any_tool() -> None:
    """The example of the user: a tool to the side of a SCARA with four axes, and of no other SCARA."""
    scara = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0)
    coupled, mounted = softkin.Coupled(scara, softkin.Tool(tool_x=30.0)), scara.with_tool(Frame((30.0, 0.0, 0.0)))
    axes = (10.0, 20.0, 5.0, 60.0)
    for robot in (coupled, mounted):
        frame, configuration = robot.forward(axes)
        at, _ = scara.forward(axes)
        assert frame.position == pytest.approx(at.position[:1] + (at.position[1] + 30.0,) + at.position[2:], abs=1e-9)
        assert robot.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-9)
        assert robot.inverse_batch([frame], None, configuration, axes)[0][0] == pytest.approx(axes, abs=1e-9)
    opposite = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))
    for robot in (coupled, mounted):
        found = robot.diagnose((frame.position, opposite))
        assert found.status is Status.UNREACHABLE and "exactly the opposite way" in found.reason
        assert robot.inverse_batch([frame.position], [opposite])[1].tolist() == [Status.UNREACHABLE]
        far = robot.diagnose(((900.0, 0.0, 0.0), frame.rotation))
        assert "out of reach" in far.reason and far.missing == pytest.approx(math.hypot(900.0, 30.0) - 550.0, abs=1e-9)
