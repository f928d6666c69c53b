"""What the build says of programs that contradict each other: the last checks before the witness, with remedies."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from sympy import cos

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import DescriptionError, Mechanism, X, Y
from derive.description.remedies import with_remedy
from derive.description.validate import validate
from derive.faults import GenerationError
from derive.ir.primitives import Atan2
from derive.ir.program import Output
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram
from derive.kinematics import build as building
from derive.kinematics import bundle, solution
from derive.kinematics.differential import jacobian_entries
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.scan import derivations, margins
from derive.live import _refuse_another_runtime
from derive.report import self_test
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
