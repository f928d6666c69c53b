"""What the witness says of programs that are wrong in a way of their own, and of machines beyond its bound of work."""

from collections.abc import Callable
from dataclasses import replace
from math import inf

import pytest
import sympy as sp

from derive import pipeline
from derive.description.mechanism import Branch, Mechanism, Task
from derive.description.remedies import with_remedy
from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.ir.program import Output
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.mechanism import search
from derive.solver.unsolved import Exhausted
from derive.witness import Disagreement, inverse, witness
from derive.work import STEPS, at_most
from tests.mechanisms import kinematics_of, named
from tests.unit.kinematics.inventions import A1, A2, L1, L2, planar_arm
from tests.unit.witness.test_witness import refusing


@pytest.fixture(scope="module")
def arm() -> Kinematics:
    """An arm with two links in a plane, said to be searched along its first joint: its slots are what they were."""
    kinematics = build(validate(planar_arm()))
    return replace(kinematics, mechanism=replace(kinematics.mechanism, search=search(A1, where=L2)))


def said_of(kinematics: Kinematics) -> str:
    with pytest.raises(Disagreement) as refused:
        witness(kinematics, kinematics.mechanism)
    assert "\n" not in str(refused.value)
    return with_remedy(str(refused.value))


@pytest.mark.long
def test_a_search_that_misses_solutions(arm: Kinematics, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inverse, "_round_trip", lambda *_: 0.0)
    monkeypatch.setattr(inverse, "refused_when_planted", lambda *_: (0, 1))
    one_elbow = replace(arm, branch=refusing(arm.branch, sp.Gt(real("sigma_elbow"), 0)))
    assert "the search misses 24 of 48 solutions; leave search= out" in said_of(one_elbow)


@pytest.mark.long
def test_a_search_that_refuses_poses_where_branches_meet(arm: Kinematics, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inverse, "refused_when_planted", lambda *_: (2, 100))
    said = said_of(arm)
    assert "the search refuses 2 of 100 poses next to where branches meet; leave search= out" in said


@pytest.mark.long
def test_a_home_pose_of_several_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    """With its working modes not told apart, the legs at home stand in both assembly modes."""
    kinematics = kinematics_of(named("Softkin_Planar_3RRR"))
    monkeypatch.setattr(Branch, "home_flag", "no parameter")
    said = said_of(kinematics)
    assert "the home pose has 2 assembly modes" in said
    assert "choose a home= at which every rod has a side" in said


def test_an_orientation_that_is_refused() -> None:
    kinematics = kinematics_of(named("Kin_Scara4_ZCcoupled_Type1"))
    assert kinematics.projection is not None
    condition = sp.Gt(kinematics.projection.inputs[0], 0)
    assert "the projection refuses a tilt: at A1=" in said_of(
        replace(kinematics, projection=refusing(kinematics.projection, condition))
    )


def test_a_frame_that_is_elsewhere() -> None:
    kinematics = kinematics_of(named("Kin_Tool"))
    (first, *rest) = kinematics.forward.outputs
    moved = replace(kinematics.forward, outputs=(Output(first.name, sp.Float(1.5) * first.value), *rest))
    said = said_of(replace(kinematics, forward=moved))
    assert "the frame of a mechanism without joints: error 5.0e-01" in said


LONG_ARM = Mechanism(
    name="Arm", parameters=(L1, L2), joints=(A1, A2), chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2), task=Task("xy")
)


def steps(of: Callable[[Mechanism], object]) -> int:
    with at_most(inf, unit=STEPS) as work:
        of(validate(LONG_ARM))
    return work.done


def test_each_stage_is_refused_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    most, again = (steps(pipeline.derive_and_measure) - steps(build) for _ in (1, 2))
    assert most == again < pipeline._MOST_STEPS / 100
    for bound, stage in (
        (0, "the search for an example of its branches"),
        (most // 4, "the measurement against its equations"),
        (most - 1, "the self-test of the machine"),
    ):
        monkeypatch.setattr(pipeline, "_MOST_STEPS", bound)
        with pytest.raises(Exhausted) as refused:
            pipeline.derive_and_measure(validate(LONG_ARM))
        said = with_remedy(str(refused.value))
        assert said.startswith(f"Arm: {stage} was given up after {bound:,} steps; name another joint in search=")
