"""The refusals of descriptions that are sound but for one part: each sentence names it; machines without a pose."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp
from sympy import sin

from derive import compile_mechanism
from derive.description.catalogue import MECHANISMS, catalogue, load
from derive.description.mechanism import Constraint, DescriptionError, Mechanism, Task, Turning, X, Y, rod
from derive.description.validate import validate
from derive.frames import Rz, Tx, Ty, Tz
from derive.ir.program import Require, Status
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.refusals.no_pose import why_no_pose
from derive.mechanism import distance, length, linear, rotary
from derive.vectors import vector
from derive.witness import Disagreement, witness
from derive.witness.frames import term
from tests.unit.kinematics.inventions import A1, A2, L1, L2
from tests.unit.kinematics.inventions import planar_arm as arm
from tests.unit.witness.test_witness import changed

PLANAR, HEXAPOD = (load(MECHANISMS / f"{n}.py") for n in ("softkin_planar_3rrr", "kin_hexapod"))
SCISSOR = load(MECHANISMS / "kin_p2x_type2.py")
S1, S2, S3 = (linear(name, "slide") for name in ("S1", "S2", "S3"))
RADIUS = linear("R", "radius", domain=(0.0, 50.0))
ROD, WIDE = length("rod_length", "rod", nominal=120.0), length("base", "base", nominal=1800.0)
TURNED = rotary("C", "turn")
P = vector(X, Y)


def loop(**stated: object) -> Mechanism:
    return arm(chain=None, branches=(), **stated)


def with_joint(**changes: object) -> Mechanism:
    return arm(joints=(A1, replace(A2, **changes)))


COSINE = Constraint(sp.Gt(real("nowhere"), 0), "a condition")
SHORTER = Constraint(sp.Lt(L1.symbol, L2.symbol), "the first link is the shorter one")
DESCRIPTIONS: dict[str, tuple[Mechanism | Callable[[], Mechanism], str]] = {
    "no joints": (arm(joints=(), branches=()), "the mechanism has no joints"),
    "a nominal value outside": (
        with_joint(domain=(0.0, 90.0), nominal=100.0),
        "joint 'A2': its nominal value 100 is outside its domain (0.0, 90.0)",
    ),
    "a pitch of a joint": (
        with_joint(pitch=A1.symbol, limit_range=(-1.0, 1.0)),
        "pitch of joint 'A2' reads 'a1', which is not a parameter",
    ),
    "periods without a joint": (arm(periods=("A1",)), "periods must name every multi-turn joint once: A1, A2"),
    "a chain and a closure": (arm(closure=(X - L1,)), "the mechanism needs either a chain or closure equations"),
    "a constraint of something unknown": (
        arm(constraints=(COSINE,)),
        "constraint 'a condition' reads 'nowhere', which is no parameter of this mechanism",
    ),
    "a platform that follows a direction": (
        replace(
            HEXAPOD, task=Task("xyz", Turning.DIRECTION), joints=HEXAPOD.joints[:5], rods=HEXAPOD.rods[:5], positive=()
        ),
        "a loop may turn its platform about z, or about every axis: it commands a direction only where guides hold",
    ),
    "a platform with the offset interface": (
        replace(PLANAR, offset_interface=True),
        "needs offset_interface=False: a position alone leaves its joints open",
    ),
    "a platform with a rod that goes with a joint": (
        replace(
            PLANAR,
            rods=(
                replace(PLANAR.rods[0], plate=tuple(p + PLANAR.joints[0] for p in PLANAR.rods[0].plate)),
                *PLANAR.rods[1:],
            ),
        ),
        "rod '1': its end must be a point of the plate",
    ),
    "a platform with an equation beside its rods": (
        replace(PLANAR, closure=(X - PLANAR.joints[0],)),
        "the closure has 4 equations, and the task commands only 3 quantities",
    ),
    "a platform with half a home pose": (replace(PLANAR, home=(0,)), "needs a home pose of 3 coordinates, and has 1"),
    "a quantity that is a text": (
        lambda: arm(positive=("2 *",)),
        "positive holds '2 *' (a str), which is no expression",
    ),
    "a nominal value that is a text": (
        lambda: arm(joints=(A1, linear("A2", "slide", nominal="3"))),  # type: ignore[arg-type]
        "joint 'A2': its nominal value is '3' (a str), and no number",
    ),
    "a nominal length that is true": (
        lambda: arm(parameters=(L1, length("link_2", "link", nominal=True))),
        "parameter 'link_2': its nominal value is True (a bool), and no number",
    ),
    "a range of one end": (
        lambda: arm(joints=(A1, rotary("A2", "turn", limits=(90.0,)))),  # type: ignore[arg-type]
        "joint 'A2': its limits is (90.0,) (a tuple), and not two numbers: as in limits=(-90.0, 90.0)",
    ),
    "a range of a text": (
        lambda: arm(joints=(A1, rotary("A2", "turn", domain=("a", 3.0)))),  # type: ignore[arg-type]
        "joint 'A2': its domain is ('a', 3.0) (a tuple), and not two numbers: as in domain=(-90.0, 90.0)",
    ),
    "a heading of a chain that never turns": (
        arm(
            parameters=(),
            joints=(S1, S2, S3, TURNED),
            chain=Tx(S1) * Ty(S2) * Tz(S3) * Tx(TURNED),
            task=Task("xyz", Turning.ABOUT_Z),
            branches=(),
        ),
        "its rotation is not one turn about z, it does not turn at all; command the whole rotation, or a direction",
    ),
}


@pytest.mark.parametrize("kind", DESCRIPTIONS)
def test_refused(kind: str) -> None:
    mechanism, sentence = DESCRIPTIONS[kind]
    with pytest.raises(DescriptionError, match=re.escape(sentence)):
        build(validate(mechanism() if callable(mechanism) else mechanism))


NOWHERE: dict[str, tuple[Mechanism, str]] = {
    "an equation that nothing solves": (
        loop(parameters=(ROD,), joints=(S1, S2), closure=(X - S1, (Y - S2) ** 2 + ROD**2)),
        "with nominal dimensions the loop never closes: at best equation 2 of the closure misses zero by 1.44e+04; "
        "check the nominal values of parameters",
    ),
    "rods that a joint makes longer, and not long enough": (
        loop(
            parameters=(ROD, WIDE),
            joints=(A1, S1),
            rods=(rod("1", (0, 0), P, ROD * sin(A1)), rod("2", (WIDE, 0), P, ROD * sin(A1))),
        ),
        "rod '1', which changes its length, misses ",
    ),
    "a joint whose values are bounded": (
        arm(parameters=(), joints=(A1, RADIUS), chain=Rz(A1) * Tx(RADIUS), branches=()),
        "no pose is possible where the joints may be (R from 0 to 50): check the nominal values of parameters",
    ),
    "nothing that could be the reason": (arm(), "no sampled pose is possible: check the nominal values of parameters"),
}


@pytest.mark.parametrize("what", NOWHERE)
def test_why_there_is_no_pose(what: str) -> None:
    mechanism, sentence = NOWHERE[what]
    assert sentence in why_no_pose(mechanism)


def test_what_is_no_description() -> None:
    with pytest.raises(TypeError, match="compile_mechanism takes a Mechanism, or the path of its file, not 3"):
        compile_mechanism(3)  # type: ignore[arg-type]


def test_a_folder_without_files(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="no mechanism files"):
        catalogue(tmp_path)


def test_what_no_equation_can_have() -> None:
    """The witness reads descriptions itself, and refuses what it does not know."""
    with pytest.raises(DescriptionError, match="strange is neither a joint nor a parameter"):
        term(real("strange"), {})
    with pytest.raises(DescriptionError, match=r"has no place in a description: tan\(strange\)"):
        term(sp.tan(real("strange")), {real("strange"): 1.0})


@pytest.fixture(scope="module")
def planar_arm() -> Kinematics:
    return build(validate(arm(offset_interface=False)))


@pytest.mark.long
def test_a_program_that_refuses_a_regular_pose(planar_arm: Kinematics) -> None:
    closed = Require(sp.Le(real("axis_a1"), 10), Status.UNREACHABLE)
    spoiled = replace(planar_arm.jacobian, body=(closed, *planar_arm.jacobian.body))
    with pytest.raises(Disagreement, match=r"jacobian refuses a regular pose: at A1=.*of the machine link"):
        witness(replace(planar_arm, jacobian=spoiled), planar_arm.mechanism)


def test_a_branch_without_a_clear_sample(planar_arm: Kinematics) -> None:
    unclear = changed(planar_arm.forward, "branch_elbow", lambda b: sp.Float(0.0))
    with pytest.raises(Disagreement, match="no sample has clear branches"):
        witness(replace(planar_arm, forward=unclear), planar_arm.mechanism)


def test_a_machine_that_is_always_singular(planar_arm: Kinematics) -> None:
    chain = Rz(A1) * Tx(L1) * Rz(A2 * sp.Rational(1, 10**9)) * Tx(L2)
    with pytest.raises(Disagreement, match="a machine has no regular pose: is the mechanism always singular"):
        witness(planar_arm, replace(planar_arm.mechanism, chain=chain))


@pytest.mark.long
def test_a_dimension_that_may_be_zero_needs_no_pose_there() -> None:
    """A link that is stated as a distance is zero in some of the machines that the witness tries: they are left out."""
    offset = distance("offset", "a link that may vanish", nominal=80.0)
    chain = Rz(A1) * Tx(L1) * Rz(A2) * Tx(offset)
    machine = validate(arm(chain=chain, parameters=(L1, offset), offset_interface=False))
    assert witness(build(machine), machine).inverted is not None
