"""The witness accepts right formulas, and refuses every kind of wrong one by name."""

import re
from collections.abc import Callable
from dataclasses import replace

import pytest
import sympy as sp

from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.symbols import real
from derive.kinematics.kinematics import Kinematics
from derive.witness import Disagreement, decade, witness
from tests.mechanisms import kinematics_of, named

SCARA = "Kin_Scara4_ZCcoupled_Type1"
Change = Callable[[sp.Expr], sp.Expr]


@pytest.fixture(scope="module")
def scara() -> Kinematics:
    return kinematics_of(named(SCARA))


def changed(program: Program, name: str, change: Change) -> Program:
    assert name in [o.name for o in program.outputs]
    outputs = (Output(o.name, change(o.value)) if o.name == name else o for o in program.outputs)
    return replace(program, outputs=tuple(outputs))


def without_sigma(program: Program) -> Program:
    """The program with every branch sign read as +1."""
    signs = {s: 1 for s in program.reads() if s.name.startswith("sigma_")}
    assert signs
    body = (replace(s, value=s.value.subs(signs)) if isinstance(s, Let) else s for s in program.body)
    return replace(program, body=tuple(body))


def refusing(program: Program, condition: sp.Basic) -> Program:
    return replace(program, body=(Require(condition, Status.UNREACHABLE), *program.body))


def test_the_scara_agrees(scara: Kinematics) -> None:
    evidence = witness(scara, named(SCARA))
    assert evidence.poses == 144
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == 2
    assert max(evidence.closure_residual, evidence.inverted.round_trip, evidence.inverted.jacobian) <= 1e-12


@pytest.mark.long
def test_what_is_not_excluded_is_missed() -> None:
    """Without `positive` the mirror solutions count: radius and azimuth, and the polar angle with them."""
    kinematics = kinematics_of(named("Kin_Crane"))
    mirrored = replace(named("Kin_Crane"), positive=())
    with pytest.raises(Disagreement, match="number of solutions: the closure has 4, the slots hold 1"):
        witness(kinematics, mirrored)


SIGMA = real("sigma_elbow")
WRONG: dict[str, tuple[str, Callable[[Kinematics], Kinematics]]] = {
    "a wrong height": (
        "forward kinematics: error",
        lambda k: replace(k, forward=changed(k.forward, "z", lambda z: z + real("pitch_zc") / 1000)),
    ),
    "an entry of the rotation": (
        "forward kinematics: error",
        lambda k: replace(k, forward=changed(k.forward, "r33", lambda r: -r)),
    ),
    "another orientation": (
        "forward kinematics: error",
        lambda k: replace(k, orientation=changed(k.orientation, "r12", lambda r: -r)),
    ),
    "another image": ("orientation image: error", lambda k: replace(k, image=changed(k.image, "rot_z", lambda r: -r))),
    "another projection": (
        "projection of the orientation: error",
        lambda k: replace(k, projection=changed(k.projection or k.image, "r21", lambda r: -r)),
    ),
    "a forward that refuses": (
        "forward kinematics refuses a possible pose",
        lambda k: replace(k, forward=refusing(k.forward, sp.Le(real("axis_a1"), 100))),
    ),
    "an axis a little off": (
        "inverse kinematics: error 1.\\de-0[67]",
        lambda k: replace(k, branch=changed(k.branch, "axis_a2", lambda a: a + sp.Float(1e-4))),
    ),
    "another turn": (
        "the way back: error",
        lambda k: replace(k, branch=changed(k.branch, "axis_a1", lambda a: a + 360)),
    ),
    "one elbow in both slots": (
        "slot 1 answers on another branch",
        lambda k: replace(k, branch=without_sigma(k.branch)),
    ),
    "the elbows exchanged": (
        "branch 'elbow' has the opposite sign of its indicator at ",
        lambda k: replace(k, forward=changed(k.forward, "branch_elbow", lambda b: -b)),
    ),
    "a slot that never answers": (
        "the way back: error inf",
        lambda k: replace(k, branch=refusing(k.branch, sp.Ge(SIGMA, 0))),
    ),
    "a slot that answers on half of the plane": (
        "number of solutions: the closure has 2, the slots hold 1|the way back: error inf",
        lambda k: replace(k, branch=refusing(k.branch, sp.Or(sp.Ge(SIGMA, 0), sp.Ge(real("x"), 0)))),
    ),
    "an entry of the Jacobian": (
        "Jacobian: error",
        lambda k: replace(k, jacobian=changed(k.jacobian, "j34", lambda j: -j)),
    ),
    "a row of the Jacobian": ("the Jacobian has the rows", lambda k: replace(k, rows=("x", "y", "z", "turn x"))),
    "another exponent": (
        "singularity margins",
        lambda k: replace(k, margins=tuple(replace(m, exponent=2) for m in k.margins)),
    ),
    "another margin": (
        "singularity margins",
        lambda k: replace(k, singularity=changed(k.singularity, "elbow", lambda m: m + sp.Rational(1, 100))),
    ),
    "a setup that refuses": (
        "Initialize refuses the nominal parameters",
        lambda k: replace(k, setup=refusing(k.setup, sp.Gt(real("link_length_1"), 900))),
    ),
    "the point off the flange elsewhere": (
        "offset interface: error",
        lambda k: replace(k, offset_branch=changed(k.offset_branch or k.branch, "axis_a3", lambda a: a + 1)),
    ),
    "the offset interface on another elbow": (
        "the way back of the offset interface",
        lambda k: replace(
            k, offset_configuration=changed(k.offset_configuration or k.forward, "branch_elbow", lambda b: -b)
        ),
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_formula_is_refused(scara: Kinematics, what: str) -> None:
    message, spoil = WRONG[what]
    with pytest.raises(Disagreement) as refused:
        witness(spoil(scara), named(SCARA))
    text = str(refused.value)
    assert text.startswith("Kin_Scara4_ZCcoupled_Type1: ")
    assert re.search(message, text), text
    assert "\n" not in text


def test_measured_numbers_are_rounded_up_to_a_decade() -> None:
    assert [decade(v) for v in (0.0, 3e-16, 1e-12, 1.1e-12, 9e-11, 1e-10)] == [1e-12, 1e-12, 1e-12, 1e-11, 1e-10, 1e-10]
