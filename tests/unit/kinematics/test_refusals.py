"""What the build refuses: programs that contradict each other, and chains without a solution, within its bounds."""

import random
import time
from collections.abc import Callable
from dataclasses import replace
from math import inf
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from sympy import cos

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import DescriptionError, Mechanism, Parameter, Task, Turning, X, Y, length, rotary
from derive.description.remedies import with_remedy
from derive.description.validate import validate
from derive.faults import GenerationError
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.primitives import Atan2
from derive.ir.program import Output
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram
from derive.kinematics import build as building
from derive.kinematics import bundle, shared_names, solution
from derive.kinematics.build import build
from derive.kinematics.differential import jacobian_entries
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.search import choice, derivations, margins
from derive.kinematics.search.choice import with_search
from derive.kinematics.solution import prepared
from derive.live import _refuse_another_runtime
from derive.report import self_test
from derive.solver import solve
from derive.solver.solve import MOST_TERMS
from derive.solver.unsolved import Exhausted
from derive.work import at_most
from tests.unit.kinematics.inventions import A1, L1, L2, planar_arm

SEARCHED = MECHANISMS / "kin_ac6_rzryryrxryrz_j6offset.py"


def arm(**changes: object) -> Mechanism:
    return validate(planar_arm(**changes))


@pytest.fixture(scope="module")
def kinematics() -> Kinematics:
    return building.build(arm())


def refused(call: Callable[[], object], kind: type[Exception] = DescriptionError) -> str:
    with pytest.raises(kind) as refusal:
        call()
    return with_remedy(str(refusal.value))


def test_margins_that_do_not_multiply(monkeypatch: pytest.MonkeyPatch) -> None:
    """A margin with half a unit added: no power of it is the determinant."""
    factor = solution.factor_of
    monkeypatch.setattr(
        solution, "factor_of", lambda m, a: replace(f := factor(m, a), **{"value": f.value + sp.Rational(1, 2)})
    )
    said = refused(lambda: building.build(arm()))
    assert (
        "the margins elbow, free_a1 do not multiply to the determinant of the Jacobian; state the joints and lengths"
        in said
    )


def test_a_name_that_nothing_gives(kinematics: Kinematics) -> None:
    forward = kinematics.forward
    given = {s.name for s in forward.inputs} - {"link_2"}
    said = refused(lambda: bundle._check_inputs(kinematics.mechanism, forward, given), BrokenProgram)
    assert said == "the forward program reads link_2, which nothing gives"


def test_a_turn_that_is_not_chosen(kinematics: Kinematics) -> None:
    outputs = (Output("axis_a1", Atan2(real("y"), real("x"))),)
    spoiled = replace(kinematics.branch, body=(), outputs=outputs)
    said = refused(lambda: bundle._check_outputs(spoiled), BrokenProgram)
    assert said.endswith("nothing has chosen a turn of axis_a1")


def test_a_point_off_the_flange_that_needs_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """The point needs a length that the pose does not: the sentence names it, and what to write."""
    solve = building.solve_offset

    def with_condition(mechanism: Mechanism) -> object:
        found = solve(mechanism)
        return replace(found, derivation=replace(found.derivation, conditions=(L2.symbol,)))

    monkeypatch.setattr(building, "solve_offset", with_condition)
    mechanism = replace(load(MECHANISMS / "kin_scara4_zccoupled_type1.py"), offset_interface=True)
    said = refused(lambda: building.build(mechanism))
    assert "but for a point off the flange" in said and "must not vanish, which the pose does not need" in said
    assert "write offset_interface=False" in said


def test_a_loop_with_an_equation_too_few() -> None:
    loop = replace(arm(), chain=None, closure=(X - L1 * cos(A1),))
    assert "1 closure equations for 2 commanded coordinates; state one equation for each" in refused(
        lambda: jacobian_entries(loop)
    )


@pytest.fixture(scope="module")
def searched() -> Mechanism:
    return solution.prepared(load(SEARCHED))


@pytest.mark.long
def test_a_search_that_leaves_two_conditions(searched: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    solve = derivations.solve_at

    def with_two(mechanism: Mechanism, joint: object) -> object:
        found = solve(mechanism, joint)
        return replace(found, derivation=replace(found.derivation, residuals=(X, Y)))

    monkeypatch.setattr(derivations, "solve_at", with_two)
    said = refused(lambda: derivations.solve_both(searched))
    assert "known, 2 conditions are left, not one; search another joint, or leave search= out" in said


@pytest.mark.long
def test_a_trial_that_is_out_of_reach_elsewhere(searched: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(derivations, "guards_of", lambda _: None)
    said = refused(lambda: derivations.solve_both(searched))
    assert "may be out of reach in its two-root steps only; search another joint" in said


@pytest.mark.long
def test_a_slope_of_both_signs(searched: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    measured = margins._measured_slope

    def turned(*arguments: object) -> np.ndarray:
        found = np.array(measured(*arguments))
        found[0] = -found[0]
        return found

    monkeypatch.setattr(margins, "_measured_slope", turned)
    said = refused(lambda: margins._orientation(derivations.solve_both(searched)), BrokenProgram)
    assert said == "the slope of the residual is not det J over the determinants of the steps"


def test_a_machine_without_a_regular_pose(kinematics: Kinematics, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(self_test._Vectors, "_regular", ())
    said = refused(lambda: self_test.self_test(kinematics))
    assert "no sampled pose is regular: check the nominal values of parameters and joints" in said


def test_a_softkin_of_another_version(tmp_path: Path) -> None:
    folder = tmp_path / "softkin"
    folder.mkdir()
    (folder / "_call.py").write_text("old = True\n", encoding="utf-8")
    module = ModuleType("softkin")
    module.__file__ = str(folder / "__init__.py")
    said = refused(lambda: _refuse_another_runtime(module, {"softkin/_call.py": "new = True\n"}), GenerationError)
    assert f"the softkin in {tmp_path} was written by another version of this compiler (_call.py differs): " in said
    assert "install the one that `make generate` writes, or remove it" in said


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
    with at_most(6 * MOST_TERMS) as work:
        search = build(validate(random_arm(1, 5, has_parameters=False))).mechanism.search
    assert time.process_time() - start < _SECONDS
    assert search is not None and search.is_eliminated and 0 < work.done <= 6 * MOST_TERMS


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


def test_the_amount_by_which_axes_nearly_meet() -> None:
    """A wrist whose last axis passes 12 beside the point in which the others meet."""
    wrist = Rx(J[3]) * Ry(J[4]) * Ty(12) * Rx(J[5]) * Tx(80)
    bent = Tx(30) * Rx(sp.pi / 7)
    arm = Rz(J[0]) * bent * Tz(400) * Ry(J[1]) * bent * Tz(455) * Ry(J[2]) * Tz(35) * Tx(420) * wrist
    machine = validate(Mechanism(name="Arm", joints=J[:6], chain=arm, task=Task("xyz", Turning.FULL)))
    assert "the axes of A4, A5, A6 met in one point, which they miss by 12" in choice.what_misses(prepared(machine))
