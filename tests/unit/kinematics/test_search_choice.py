"""The joint that is searched where no subproblem solves a chain, and the branches of its trial."""

from dataclasses import replace

import numpy as np
import pytest
from sympy import Integer, cos, false, pi, sin

from derive.description.mechanism import Mechanism, Parameter, Task, Turning, branch, distance, length
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Call, Let, Program, Status
from derive.ir.symbols import Flag, is_count
from derive.kinematics.build import build
from derive.kinematics.sampling import sample_axes, sample_machine
from derive.kinematics.search.choice import with_search
from derive.solver.unsolved import Undetermined
from derive.witness import witness
from tests.machines.chain_machines import OF_DEGREE_FOUR
from tests.machines.made import made
from tests.machines.searched_machines import POINTING
from tests.mechanisms import kinematics_of
from tests.unit.kinematics.inventions import described
from tests.unit.solver.test_fast_refusals import JOINTS, LENGTHS, L

pytestmark = pytest.mark.slow

A1, A2, A3, A4, A5, A6 = JOINTS[:6]
ELBOW = Rz(A1) * Tx(L[6]) * Ry(A2) * Tz(L[1]) * Ry(A3) * Tx(L[2])
ARM = Rz(A1) * Ry(A2) * Tz(L[1]) * Ry(A3) * Tx(L[2]) * Rx(A4)
ELBOW_ACROSS = Ry(A2) * Tz(L[1]) * Ry(A3) * Tx(L[2]) * Rx(A4) * Ty(L[3]) * Ry(A5) * Rx(A6) * Tx(L[4])
THREE_PARALLEL = Rz(A1) * Tx(L[6]) * Rx(A2) * Tz(L[1]) * Rx(A3) * Tz(L[2]) * Rx(A4) * Tz(L[3]) * Ry(A5) * Tx(L[4])
SIDEWAYS = ARM * Ty(L[3]) * Ry(A5) * Rx(A6) * Tx(L[4])


def arm(chain: Chain, *branches: object, parameters: tuple[Parameter, ...] = LENGTHS) -> Mechanism:
    read = {s for factor in chain.factors for s in factor.amount.free_symbols}
    return described(
        parameters=tuple(p for p in parameters if p.symbol in read),
        joints=JOINTS[:6],
        chain=chain,
        task=Task("xyz", Turning.FULL),
        branches=branches,
        offset_interface=False,
    )


def chosen(mechanism: Mechanism) -> str | None:
    search = with_search(mechanism).search
    return None if search is None else search.joint.name


@pytest.mark.parametrize(
    ("chain", "joint"),
    [
        (SIDEWAYS, "A6"),
        (ARM * Ry(A5) * Tz(L[3]) * Rx(A6) * Tx(L[4]), "A6"),
        (ARM * Ry(A5) * Rx(A6) * Tx(L[4]), None),
        (ELBOW * Tz(L[3]) * Rx(A4) * Tz(L[5]) * Ry(A5) * Rx(A6) * Tx(L[4]), "A1"),
        (Rz(A6) * Tx(L[4]) * Rx(A5) * Tz(L[3]) * Rz(A4) * Tx(L[2]) * Ry(A3) * Tz(L[1]) * Ry(A2) * Rz(A1), "A6"),
    ],
)  # fmt: skip
def test_the_joint(chain: Chain, joint: str | None) -> None:
    """Of the arm that stands on its flange the first joint, for the same reason. A forearm that A4 makes longer and
    shorter across has its length along at least: no condition is left that a search could not follow.
    """
    assert chosen(arm(chain)) == joint


def test_an_arm_that_may_have_no_length_is_refused_with_its_machine() -> None:
    """A forearm that is a distance may be zero: no trial is refused for it, but the machine is."""
    forearm = distance("forearm", "a forearm", nominal=300.0)
    chain = Rz(A1) * Ry(A2) * Tz(L[1]) * Ry(A3) * Tx(forearm) * Rx(A4) * Ty(L[3]) * Ry(A5) * Rx(A6) * Tx(L[4])
    machine = with_search(arm(chain, parameters=(*LENGTHS, forearm)))
    assert machine.search is not None and machine.search.joint.name == "A6"
    (check,) = (c for c in machine.constraints if "no length" in c.message)
    assert check.message == "forearm must not vanish: the arm that Q3 turns would have no length"
    sizes = {L[1].symbol: 400.0}
    held = [bool(check.condition.xreplace({**sizes, forearm.symbol: size})) for size in (300.0, -2.0, 0.0, 1e-9)]
    assert held == [True, True, False, False]


def test_steps_that_no_branch_names_get_one() -> None:
    """Their indicators are those of the arm: how far the wrist is in front of A1, and which way the elbow bends."""
    shoulder, elbow, last = with_search(arm(SIDEWAYS)).branches
    assert (shoulder.name, elbow.name, last.name) == ("shoulder_1", "elbow_1", "crossing")
    q2, q3, l1, l2 = A2.symbol, A3.symbol, L[1].symbol, L[2].symbol
    assert (shoulder.indicator - l1 * sin(q2) - l2 * cos(q2 + q3)).expand(trig=True) == 0
    assert elbow.indicator == cos(q3)
    assert last.is_crossing


def test_branches_that_are_stated_stay() -> None:
    """Those of a step stand first; one that no step decides is read off the root; the crossing comes last."""
    wrist, elbow = branch("wrist", sin(A5), up=+1, down=-1), branch("elbow", cos(A3), up=+1, down=-1)
    found = with_search(arm(SIDEWAYS, wrist, elbow))
    assert [b.name for b in found.branches] == ["elbow", "shoulder_1", "wrist", "crossing"]
    assert found.branches[0] == elbow
    assert any("looks for its roots along A6" in note for note in found.notes)


def test_an_elbow_with_a_step_is_written_in_joints_and_dimensions() -> None:
    """The forearm has two lengths: the indicator does not read the root of their squares, which no program has."""
    found = with_search(
        arm(
            Rz(A1)
            * Ry(A2)
            * Tz(L[1])
            * Ry(A3)
            * Tz(L[2])
            * Tx(L[3])
            * Rx(A4)
            * Ry(A5)
            * Tx(L[4])
            * Tz(L[5])
            * Rx(A6)
            * Tx(L[6])
        )
    )
    own = {j.symbol for j in found.joints} | {p.symbol for p in found.parameters}
    indicators = [b.indicator for b in found.branches if not b.is_crossing]
    assert indicators and all(i.free_symbols <= own for i in indicators)


def test_nothing_is_searched_that_nothing_determines() -> None:
    """Two joints about one axis: no search finds their parts of the sum."""
    with pytest.raises(Undetermined, match="the closure does not determine"):
        with_search(
            arm(Rz(A1) * Rz(A2) * Tz(L[1]) * Ry(A3) * Tx(L[2]) * Rx(A4) * Ty(L[3]) * Ry(A5) * Rx(A6) * Tx(L[4]))
        )


@pytest.mark.parametrize("name", ["side", "goal_x", "residual_tried", "rate_1_1"])
def test_a_parameter_named_like_a_value_of_the_search_keeps_its_name(name: str) -> None:
    """It has another one inside."""
    strange = replace(length(name, "offset of the wrist", nominal=150.0))
    chain = ARM * Ty(strange) * Ry(A5) * Rx(A6) * Tx(L[4])
    built = build(arm(chain, parameters=(*LENGTHS, strange)))
    assert name in [p.given_name for p in built.parameters] and name not in [p.name for p in built.parameters]


@pytest.mark.parametrize("chain", [Rz(A1) * Ty(L[5]) * ELBOW_ACROSS, THREE_PARALLEL * Rz(A6) * Tx(L[5])])
def test_a_trial_that_is_out_of_reach_elsewhere_is_searched(chain: Chain) -> None:
    """What a trial divides by vanishes only where a root is of a negative number: at no solution."""
    found = build(arm(chain))
    assert found.mechanism.search is not None and found.tried_branches > 0


@pytest.mark.parametrize("name", OF_DEGREE_FOUR)
def test_a_commanded_point_is_searched_without_a_step_of_two_roots(name: str) -> None:
    """Its trial has a solution at every angle of the joint, and its residual is a polynomial: no solution is missed."""
    machine = made(name)
    kinematics = kinematics_of(machine.mechanism)
    assert kinematics.mechanism.search is not None and kinematics.tried_branches == 0
    assert [b.is_crossing for b in kinematics.mechanism.branches] == [True]
    evidence = machine.built.evidence
    assert evidence is not None and evidence.inverted is not None and evidence.inverted.missed is not None
    assert evidence.inverted.missed[0] == 0 and evidence.inverted.missed[1] > 50


def test_fixed_angles_in_front_of_a_wrist_and_in_it_have_their_own_names_in_every_loop() -> None:
    """Newton's method on the position stands in front of that on the closure, which binds their cosines, too."""
    front = Rz(A1) * Ty(235) * Tx(216) * Rx(1.234) * Rz(A2) * Ty(294) * Tz(198) * Ry(pi / 3) * Rx(A3)
    forearm = Ty(268) * Tx(376) * Tz(265) * Rx(pi / 3)
    wrist = Rz(A4) * Rx(0.7) * Rz(A5) * Rx(0.9) * Rz(A6)
    mechanism = arm(front * forearm * wrist * Tx(366) * Tz(232) * Ty(221) * Ry(pi / 7))
    found = witness(build(mechanism), mechanism).inverted
    assert found is not None and found.missed is not None and found.missed[0] == 0 < found.solutions


def without_search(branch: Program) -> Program:
    """The program with a search that finds nothing."""
    body = []
    for s in branch.body:
        is_search = isinstance(s, Call) and s.program.name in ("find_root", "compute_wave")
        body += [Let(n, false if isinstance(n, Flag) else Integer(0)) for n in s.names] if is_search else [s]
    return normalise(branch.name, body, branch.outputs)


@pytest.mark.parametrize("name", POINTING)
def test_next_to_the_reference_nothing_is_searched(name: str) -> None:
    """Steps on the closure lead from the reference to the same solution, whatever the turn of the tool is."""
    kin = build(POINTING[name])
    machine = sample_machine(kin.mechanism, 5)
    axes = sample_axes(kin.mechanism, machine, 40, 6)
    constants, _ = run(kin.setup, machine)
    pose, _ = run(kin.forward, {**machine, **constants, **axes})
    signs = {f"sigma_{b.name}": np.sign(pose[f"branch_{b.name}"]) for b in kin.branches}
    given = {**machine, **constants, **axes, **pose, **signs} | {s.name: 0 for s in kin.branch.inputs if is_count(s)}
    names = [j.axis.name for j in kin.mechanism.joints]
    for shift, share in ((0.9, 0.9), (40.0, 0.0)):
        references = {j.reference.name: axes[j.axis.name] + shift for j in kin.mechanism.joints}
        found, status = run(without_search(kin.branch), given | references)
        ok = np.array([s is Status.OK for s in status])
        assert ok.mean() >= share if share else not ok.any()
        assert all(np.abs(found[n] - axes[n])[ok].max(initial=0.0) < 1e-6 for n in names)
