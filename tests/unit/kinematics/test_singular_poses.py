"""Where two branches meet and where a joint is free: both slots hold the same solution, the rest is solved with it."""

import numpy as np
import pytest

from derive.ir.program import Status
from tests.unit.kinematics.inventions import INVENTIONS
from tests.unit.kinematics.machine import Machine, Values, machine
from tests.unit.solver.execution import distance

REFERENCES = (-400.0, -37.0, 0.0, 200.0)


def built(name: str, **settings: float) -> Machine:
    return machine(INVENTIONS[name], **settings)


def turn_between(first: np.ndarray, second: np.ndarray | float) -> float:
    """The difference of two angles in degrees, modulo a turn."""
    return float(np.degrees(distance(np.radians(first), np.radians(second))))


def slots_at(own: Machine, axes: Values, reference: Values) -> list[Values]:
    """The solutions in all slots for the pose at these axes; every one must lead back to it."""
    pose = own.forward(axes)
    found = []
    for slot in own.slots:
        solution, status = own.inverse(pose, slot, reference)
        assert set(status.flat) == {Status.OK}
        again = own.forward(solution)
        assert max(np.abs(again[c] - pose[c]).max() for c in "xyz") <= 1e-5
        found.append(solution)
    return found


def values(own: Machine, **axes: float) -> Values:
    return {j.axis.name: np.asarray(axes[j.name]) for j in own.kinematics.mechanism.joints}


@pytest.mark.long
@pytest.mark.parametrize("elbow", [0.0, 180.0])
@pytest.mark.parametrize("name", ["all turns clockwise", "a motor of either sense", "a lift between the joints"])
def test_a_stretched_or_folded_arm_is_one_solution(name: str, elbow: float) -> None:
    own = built(name)
    axes = values(own, A1=20.0, A2=elbow, A3=-50.0, P1=5.0)
    margins = own.forward(axes)
    assert abs(margins["branch_elbow"]) <= 1e-11
    first, second = slots_at(own, axes, axes)
    for axis, value in axes.items():
        assert abs(first[axis] - second[axis]) <= 1e-4
        assert abs(first[axis] - value) <= 1e-4


@pytest.mark.parametrize("reference", REFERENCES)
def test_equal_links_folded_turn_freely(reference: float) -> None:
    """Where equal links are folded the first axis keeps its reference, and the pose is reached."""
    own = built("a lift between the joints", link_1=250.0, link_2=250.0)
    axes = values(own, A1=20.0, A2=180.0, A3=-50.0, P1=5.0)
    at_reference = values(own, A1=reference, A2=150.0, A3=0.0, P1=0.0)
    for solution in slots_at(own, axes, at_reference):
        assert solution["axis_a1"] == pytest.approx(reference, abs=1e-9)
        assert solution["axis_a2"] == pytest.approx(180.0, abs=1e-9)
        assert turn_between(solution["axis_a1"] + solution["axis_a3"], -30.0) <= 1e-9


@pytest.mark.parametrize("reference", REFERENCES)
def test_a_telescope_of_no_length_keeps_its_direction(reference: float) -> None:
    own = built("a telescope with a wrist")
    axes = values(own, A1=20.0, P1=0.0, A2=-50.0)
    assert abs(own.forward(axes)["branch_reach"]) <= 1e-11
    for solution in slots_at(own, axes, values(own, A1=reference, P1=0.0, A2=0.0)):
        assert solution["axis_a1"] == pytest.approx(reference, abs=1e-9)
        assert abs(solution["axis_p1"]) <= 1e-9
        assert turn_between(solution["axis_a1"] + solution["axis_a2"], -30.0) <= 1e-9


@pytest.mark.parametrize("reference", REFERENCES)
def test_a_wrist_above_the_shoulder_leaves_the_column_free(reference: float) -> None:
    """The shoulder's slots meet there; the elbow's do not."""
    own = built("a palletiser")
    upper = np.degrees(np.arctan2(float(own.constants["link_1"]), float(own.constants["link_2"])))
    axes = values(own, A1=20.0, A2=upper, A3=90.0)
    assert abs(own.forward(axes)["branch_shoulder"]) <= 1e-11
    found = slots_at(own, axes, values(own, A1=reference, A2=0.0, A3=0.0))
    assert all(s["axis_a1"] == pytest.approx(reference, abs=1e-9) for s in found)
    assert sorted(float(s["axis_a3"]) for s in found) == pytest.approx([-90.0, -90.0, 90.0, 90.0], abs=1e-9)


@pytest.mark.long
def test_a_boom_that_stands_up_is_on_both_sides() -> None:
    own = built("a boom that tips over")
    axes = values(own, A1=20.0, A2=90.0, P1=100.0)
    first, second = slots_at(own, axes, values(own, A1=-70.0, A2=0.0, P1=0.0))
    assert first["axis_a1"] == second["axis_a1"] == pytest.approx(-70.0, abs=1e-9)
    assert first["axis_a2"] == pytest.approx(90.0, abs=1e-9)


def test_what_is_free_does_not_depend_on_the_reference_elsewhere() -> None:
    own = built("a lift between the joints")
    axes = values(own, A1=20.0, A2=60.0, A3=-50.0, P1=5.0)
    near = [slots_at(own, axes, values(own, A1=r, A2=r, A3=r, P1=r)) for r in (-100.0, 0.0, 100.0)]
    for first, second in zip(near, near[1:], strict=False):
        for one, other in zip(first, second, strict=True):
            assert all(turn_between(one[a], other[a]) <= 1e-9 for a in ("axis_a1", "axis_a2", "axis_a3"))
            assert one["axis_p1"] == other["axis_p1"]
