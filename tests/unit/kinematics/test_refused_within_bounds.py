"""Chains without a solution: refused within the bound of work, with joints and amounts in the reason."""

import random
import re
import time
from math import inf

import pytest
import sympy as sp

from derive.description.mechanism import Mechanism, Parameter, Task, Turning, length, rotary
from derive.description.validate import validate
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.kinematics import shared_names
from derive.kinematics.build import build
from derive.kinematics.scan import choice
from derive.kinematics.scan.choice import with_search
from derive.kinematics.solution import prepared
from derive.solver import solve
from derive.solver.solve import MOST_TERMS
from derive.solver.unsolved import Exhausted, Unsolved
from derive.work import at_most

TURNS, SHIFTS = (Rx, Ry, Rz), (Tx, Ty, Tz)
J = tuple(rotary(f"A{k}", f"axis {k}") for k in range(1, 9))
_SECONDS = 60.0
"""Of processor time, several times what a slow machine takes."""


def random_arm(seed: int, axes: int, *, has_parameters: bool) -> Mechanism:
    """Neighbouring axes at angles of 90° or 50°, with two offsets behind each; six joints are solved for at most."""
    rng, factors, parameters, last = random.Random(100 * axes + seed), list[Chain](), list[Parameter](), 0
    for joint in J[:axes]:
        last = (last + rng.choice([1, 2])) % 3
        factors.append(TURNS[last](joint))
        for shift in rng.sample(SHIFTS, 2):
            size = float(rng.randrange(60, 400))
            parameters.append(length(f"l{len(parameters)}", "length", nominal=size))
            factors.append(shift(parameters[-1] if has_parameters else size))
        if rng.random() < 0.3:
            factors.append(TURNS[(last + 1) % 3](sp.Rational(5, 18) * sp.pi))
    chain = factors[0]
    for factor in factors[1:]:
        chain = chain * factor
    return Mechanism(
        name=f"Random{axes}",
        parameters=tuple(parameters) if has_parameters else (),
        joints=J[:axes],
        chain=chain,
        task=Task("xyz", Turning.DIRECTION if axes == 5 else Turning.FULL),
        held=tuple(sorted(rng.sample(J[:axes], max(0, axes - 6)), key=J.index)),
    )


@pytest.mark.slow
def test_a_random_arm_with_five_axes() -> None:
    start = time.process_time()
    with pytest.raises(Unsolved) as refusal, at_most(6 * MOST_TERMS) as work:
        build(validate(random_arm(1, 5, has_parameters=False)))
    assert time.process_time() - start < _SECONDS
    assert 0 < work.done <= 6 * MOST_TERMS
    said = str(refusal.value)
    assert re.search(r"(A\d, ){2}A\d (were parallel|met in one point), which they miss by \d", said), said
    assert len(said) < 900


@pytest.mark.long
def test_the_same_work_whatever_was_derived_before() -> None:
    machine, counts = prepared(validate(random_arm(2, 6, has_parameters=True))), []
    for _ in range(2):
        with at_most(6 * MOST_TERMS) as work:
            assert with_search(machine).search is not None
        counts.append(work.done)
    assert counts[0] == counts[1]


@pytest.mark.long
def test_a_derivation_that_grows_too_large_is_refused_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """The machine has a solution; with a bound that is too small for it the refusal says so, and names joints."""
    wrist = Rx(J[3]) * Ry(J[4]) * Rx(J[5]) * Tx(80)
    arm = Rz(J[0]) * Tz(400) * Tx(25) * Ry(J[1]) * Tz(455) * Ry(J[2]) * Tz(35) * Tx(420) * wrist
    machine = validate(Mechanism(name="Arm", joints=J[:6], chain=arm, task=Task("xyz", Turning.FULL)))
    for place in (solve, choice):
        monkeypatch.setattr(place, "MOST_TERMS", 60, raising=False)
    monkeypatch.setattr(choice, "elimination_of", lambda *_: None)
    with pytest.raises(Exhausted, match=r"given up after 60 terms"):
        with_search(prepared(machine))


@pytest.mark.long
def test_the_stages_behind_the_solver_share_the_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """With one term less than it needs the whole arm is refused by the stage that needs the last one."""
    wrist = Rx(J[3]) * Ry(J[4]) * Rx(J[5]) * Tx(80)
    arm = Rz(J[0]) * Tz(400) * Ry(J[1]) * Tz(455) * Ry(J[2]) * Tx(420) * wrist
    machine = validate(Mechanism(name="Arm", joints=J[:6], chain=arm, task=Task("xyz", Turning.FULL)))
    with at_most(inf) as work:
        build(machine)
    monkeypatch.setattr(shared_names, "_MOST_TERMS", work.done - 1)
    said = r"^the .* was given up after [\d,]+ terms, before an expression of [\d,]+ terms: state the dimensions"
    with pytest.raises(Exhausted, match=said):
        build(machine)


def five(chain: Chain) -> str:
    """Why five axes with a direction are refused."""
    task = Task("xyz", Turning.DIRECTION)
    with pytest.raises(Unsolved) as refusal:
        build(validate(Mechanism(name="Five", joints=J[:5], chain=chain, task=task)))
    return str(refusal.value)


@pytest.mark.long
def test_three_parallel_axes_are_told_to_be_so_and_a_task_that_fits() -> None:
    upper = Rz(J[0]) * Tz(310) * Ry(J[1]) * Tz(260) * Ry(J[2]) * Tx(230) * Ry(J[3]) * Tx(75)
    said = five(upper * Rx(J[4]) * Ty(35) * Tx(45))
    assert "the axes of A2, A3, A4 are parallel, which is not enough" in said
    assert "met the axis of A5, which it misses by 35" in said
    assert 'with task=Task("xyz", Turning.NONE), held=(A4, A5) these joints are solved' in said


def test_the_amount_by_which_axes_nearly_meet() -> None:
    """A wrist whose last axis passes 12 beside the point in which the others meet."""
    wrist = Rx(J[3]) * Ry(J[4]) * Ty(12) * Rx(J[5]) * Tx(80)
    bent = Tx(30) * Rx(sp.pi / 7)
    arm = Rz(J[0]) * bent * Tz(400) * Ry(J[1]) * bent * Tz(455) * Ry(J[2]) * Tz(35) * Tx(420) * wrist
    machine = validate(Mechanism(name="Arm", joints=J[:6], chain=arm, task=Task("xyz", Turning.FULL)))
    assert "the axes of A4, A5, A6 met in one point, which they miss by 12" in choice.what_misses(prepared(machine))
