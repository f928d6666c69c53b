"""Branches that no description names: derived, called something, and told in words that are true."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.description.mechanism import Branch, Mechanism
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import derive_and_measure
from derive.report.branch_meanings import pair_at_one_frame
from derive.report.reference_calls import branches, forward, machine_with
from tests.mechanisms import kinematics_of, named

pytestmark = pytest.mark.slow

NAMES = {
    "Kin_Scara4_ZCcoupled_Type1": ["elbow_1"],
    "Kin_SCCC": ["elbow_1"],
    "Kin_PCC": ["elbow_1"],
    "Kin_Pos_RRR": ["shoulder_1", "elbow_1"],
    "Kin_Ac6_ThreeParallel": ["shoulder_1", "wrist_1", "elbow_1"],
    "Kin_Wrist2": ["wrist_1"],
    "Kin_P2X_Type1": ["slide_1", "slide_2"],
    "Kin_P2C_Type2": ["elbow_1", "elbow_2"],
    "Softkin_TableTable_AC": ["wrist_1"],
}


def nameless(name: str) -> Mechanism:
    return replace(named(name), branches=())


def joints_at(mechanism: Mechanism, axes: Sequence[float]) -> list[float]:
    """Joint values of the nominal machine."""
    values = {p.symbol: p.nominal for p in mechanism.parameters}
    values |= {j.motor: a * (np.pi / 180 if j.is_angle else 1.0) for j, a in zip(mechanism.joints, axes, strict=True)}
    return [float(values[j.motor] + sp.sympify(j.coupling).subs(values)) for j in mechanism.joints]


def signs(mechanism: Mechanism, branch: Branch, poses: np.ndarray) -> np.ndarray:
    """The signs of an indicator at joint values and positions, for the nominal machine."""
    given = {p.symbol: p.nominal for p in mechanism.parameters} | {sp.Symbol("DEGREE", positive=True): np.pi / 180}
    position = sp.symbols("x y z", real=True)
    free = [*(j.symbol for j in mechanism.joints), *position]
    indicator = sp.sympify(branch.indicator).subs(given)
    own = {s: next(f for f in free if f.name == s.name) for s in indicator.free_symbols}
    return np.asarray(np.sign(sp.lambdify(free, indicator.xreplace(own))(*poses.T)))


@pytest.mark.parametrize("name", NAMES)
def test_every_step_is_named_once_and_is_a_branch_of_the_description(name: str) -> None:
    """At poses of the machine each derived indicator has the sign, or the opposite one, of one that is described."""
    described, derived = kinematics_of(named(name)), kinematics_of(nameless(name))
    assert [b.name for b in derived.branches] == NAMES[name]
    mechanism = described.mechanism
    machine = machine_with(described, {p.name: p.nominal for p in described.parameters})
    rng = np.random.default_rng(8)
    start = np.array([j.nominal for j in mechanism.joints])
    rows = []
    for _ in range(30):
        axes = start + rng.uniform(-1.0, 1.0, len(start)) * [70.0 if j.is_angle else 60.0 for j in mechanism.joints]
        status, frame, configuration = forward(machine, tuple(axes.tolist()))
        if status is Status.OK:
            every = branches(machine, frame, (0,) * len(configuration), tuple(axes.tolist()))
            solved = [one for one, answer in zip(*every[1:], strict=True) if answer is Status.OK]
            rows += [[*joints_at(mechanism, one), *frame[:3]] for one in (tuple(axes.tolist()), *solved)]
    poses = np.array(rows)
    assert len(poses) >= 20
    own = [signs(mechanism, b, poses) for b in described.branches]
    found = [[abs(np.sum(signs(mechanism, b, poses) * o)) == len(poses) for o in own] for b in derived.branches]
    assert sorted(map(sum, found)) == [1] * len(own)
    assert sorted(map(sum, zip(*found, strict=True))) == [1] * len(own)


@pytest.mark.parametrize("name", ["Kin_Scara4_ZCcoupled_Type1", "Kin_P2C_Type1", "Softkin_Planar_3RRR"])
def test_the_witness_agrees_with_what_is_derived(name: str) -> None:
    """The branches are measured as those of a description are, and the notes say what they mean."""
    whole = derive_and_measure(nameless(name))
    assert whole.evidence is not None and whole.evidence.inverted is not None
    described = derive_and_measure(named(name))
    assert described.evidence is not None and described.evidence.inverted == whole.evidence.inverted
    notes = [n for n in whole.mechanism.notes if n.startswith("The description does not name the branch ")]
    assert len(notes) == len(whole.branches) == len(described.branches)
    assert not [n for n in described.mechanism.notes if "does not name" in n]
    assert all(re.search("For one (frame|position) of the nominal machine positive has", note) for note in notes)


def test_the_meaning_in_words_is_true() -> None:
    """Two axis vectors of one frame, in both ways of a branch: each is where the words say."""
    whole = derive_and_measure(nameless("Kin_Scara4_ZCcoupled_Type1"))
    (note,) = (n for n in whole.mechanism.notes if "elbow_1" in n)
    assert "In positive A2 is between 0 and 180 degrees; in negative A2 is between -180 and 0 degrees. " in note
    one, other = (float(v) for v in re.findall(r"A2 (-?[\d.]+)", note)[-2:])
    assert 0 < one < 180 and one == -other
    _agree_with_meanings(whole)
    _agree_with_meanings(kinematics_of(nameless("Kin_Pos_RRR")))


def _agree_with_meanings(whole: Kinematics) -> None:
    """The pair that the note shows is in the branches that it says, and at one frame."""
    machine = machine_with(whole, {p.name: p.nominal for p in whole.parameters})
    for index in range(len(whole.branches)):
        pair = pair_at_one_frame(whole, index)
        assert pair is not None
        (_, first, bytes_1), (_, second, bytes_2) = (forward(machine, axes) for axes in pair)
        size = len(first) if whole.reads_rotation else 3
        assert np.allclose(first[:size], second[:size], rtol=0.0, atol=1e-4)
        assert (bytes_1[index], bytes_2[index]) == (1, 2)


def test_names_of_the_description_come_first_and_are_never_taken_again() -> None:
    """What is named keeps its name and its byte; the rest follows."""
    arm = named("Kin_Pos_RRR")
    (elbow,) = (b for b in arm.branches if b.name == "elbow")
    partly = replace(arm, branches=(replace(elbow, name="shoulder_1"),))
    built = kinematics_of(partly)
    assert [b.name for b in built.branches] == ["shoulder_1", "shoulder_2"]
    assert built.branches[0].names == elbow.names and built.branches[1].meanings[0]
