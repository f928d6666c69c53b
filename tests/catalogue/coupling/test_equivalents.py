"""Couplings against mechanisms of their own that are the same machine."""

import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from tests.catalogue.coupling.parts import EVERYTHING
from tests.catalogue.refusals import refusal

ARM = {"d1": 350.0, "a1": 80.0, "a2": 310.0, "d3": 50.0, "a3": 30.0, "d4": 290.0}


def drawn(robot: softkin.Mechanism, count: int, size: float) -> list[tuple[float, ...]]:
    """Random axis values."""
    rng = np.random.default_rng(23)
    ranges = [size if a.unit == "u" else 170.0 for a in robot.AXES]
    return [tuple(row) for row in (rng.uniform(-1.0, 1.0, (count, len(ranges))) * ranges).tolist()]


def agree(
    coupled: softkin.Coupled, whole: softkin.Mechanism, of_axes: tuple[int, ...], of_bytes: tuple[int, ...], size: float
) -> None:
    """The same answers: `of_axes[i]` is the axis of the whole that is axis i of the coupling, `of_bytes` likewise."""
    answered = 0
    for axes in drawn(whole, 60, size):
        mine = tuple(axes[k] for k in of_axes)
        frame, configuration = whole.forward(axes)
        found, bytes_ = coupled.forward(mine)
        assert np.abs(np.subtract(found.position, frame.position)).max() < 1e-9
        assert np.abs(np.subtract(found.rotation, frame.rotation)).max() < 1e-12
        assert bytes_ == tuple(configuration[k] for k in of_bytes)
        expected = {s.configuration: s.axes for s in whole.inverse_all(frame, axes)}
        slots = {s.configuration: s.axes for s in coupled.inverse_all(frame, mine)}
        for key, value in expected.items():
            own = slots[tuple(key[k] for k in of_bytes)]
            assert (own is None) == (value is None)
            if value is not None:
                assert own == pytest.approx(tuple(value[k] for k in of_axes), abs=1e-8)
                answered += 1
        rng = np.random.default_rng(int(abs(sum(axes))))
        far = tuple((np.array(axes) + rng.uniform(-90.0, 90.0, len(axes))).tolist())
        opened = (0,) * len(configuration)
        chosen = whole.inverse(frame, opened, far)
        found = coupled.inverse(frame, opened, tuple(far[k] for k in of_axes))
        assert found == pytest.approx(tuple(chosen[k] for k in of_axes), abs=1e-8)
        assert coupled.singularity(mine).is_singular == whole.singularity(axes).is_singular
    assert answered >= 120


def test_a_gantry_with_a_wrist_of_two_axes() -> None:
    for side in (1, -1):
        wrist = softkin.Wrist2(tool_length=90.0, tool_side=side)
        coupled = softkin.Coupled(softkin.Gantry3(), wrist)
        agree(coupled, softkin.Kin5Axes(tool_length=90.0, tool_side=side), (0, 1, 2, 3, 4), (0, 1, 2), 400.0)


def test_an_arm_with_a_wrist_of_three_axes() -> None:
    coupled = softkin.Coupled(softkin.PosRRR(**ARM), softkin.Wrist3(tool_offset_z=75.0))
    whole = softkin.ArticulatedRobot6DOF(**ARM, d6=75.0)
    agree(coupled, whole, (0, 1, 2, 3, 4, 5), (0, 1, 3, 4, 5, 2, 6, 7, 8), 0.0)
    axes = (10.0, -20.0, 30.0, 40.0, 50.0, 60.0)
    rows = dict(zip(coupled.JACOBIAN_ROWS, coupled.jacobian(axes), strict=True))
    for name, row in zip(whole.JACOBIAN_ROWS, whole.jacobian(axes), strict=True):
        assert rows[name] == pytest.approx(row, abs=1e-9)


def test_the_documented_refusal() -> None:
    """A C axis whose tool has an X or Y offset, on a flange that turns; along Z it may be anything."""
    scara, arm = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0), softkin.PosRRR(**ARM)
    for tool in ({"tool_x": 1.0}, {"tool_y": -1.0}, {"tool_x": 2e-9}):
        for carrier in (scara, arm):
            status = refusal(softkin.Coupled, carrier, softkin.CAxisTool(**tool), says="does not determine")
            assert status is softkin.Status.INVALID_COUPLING
    softkin.Coupled(scara, softkin.CAxisTool(tool_z=-60.0, tool_x=5e-10))
    with pytest.raises(KinematicsError):
        softkin.Coupled(arm, softkin.CAxisTool(tool_z=-60.0))
    assert set(EVERYTHING) >= {"Kin_5Axes", "Kin_Scara3_Z", "Kin_ArticulatedRobot_6DOF"}
