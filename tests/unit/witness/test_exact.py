"""The check in a finite field: right formulas hold exactly, and what is wrong by the last digit does not."""

from collections.abc import Callable
from dataclasses import replace

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.description.mechanism import Mechanism, Task, length, linear, rotary
from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.ir.primitives import Atan2
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.witness import Disagreement
from derive.witness.exact.field import PRIME, NoRoot, of_angle, on_circle, root, root_of_whole, times, turned
from derive.witness.exact.proof import check_exactly
from tests.machines.task_machines import DRIVEN
from tests.mechanisms import kinematics_of, named

NUMBERS = st.integers(1, PRIME - 1)
DEGREES = st.integers(-720_000, 720_000)


@given(NUMBERS)
def test_a_square_has_its_root(number: int) -> None:
    assert root(number * number) in (number, PRIME - number)


@given(NUMBERS)
def test_of_a_number_and_its_multiple_by_no_square_one_has_a_root(number: int) -> None:
    other = next(n for n in range(2, 50) if pow(n, (PRIME - 1) // 2, PRIME) == PRIME - 1)

    def has_root(value: int) -> bool:
        try:
            return root(value) ** 2 % PRIME == value % PRIME
        except NoRoot:
            return False

    assert has_root(number) is not has_root(number * other)


@given(DEGREES, DEGREES, NUMBERS)
def test_angles_add(one: int, other: int, slope: int) -> None:
    """Sines and cosines of fixed angles are on the circle, add, and have the roots that they have in real numbers."""
    cosine, sine = of_angle(one)
    assert (cosine**2 + sine**2) % PRIME == 1
    assert turned(of_angle(one), of_angle(other)) == of_angle(one + other)
    assert times(on_circle(slope), 3) == turned(on_circle(slope), turned(on_circle(slope), on_circle(slope)))
    assert of_angle(90_000) == (0, 1)
    assert (2 * of_angle(45_000)[1] - root_of_whole(2)) % PRIME == 0
    assert (2 * of_angle(60_000)[1] - root_of_whole(3)) % PRIME == 0


def test_a_length_may_have_the_name_of_a_joint() -> None:
    """As in tables of Denavit-Hartenberg parameters: the length a1 is not the angle of A1."""
    first, second = (length(f"a{k}", f"Link {k}", nominal=300.0) for k in (1, 2))
    joints = tuple(rotary(f"A{k}", f"Arm {k}") for k in (1, 2))
    chain = Rz(joints[0]) * Tx(first) * Rz(joints[1]) * Tx(second)
    arm = validate(Mechanism(name="Arm", parameters=(first, second), joints=joints, chain=chain, task=Task("xy")))
    exact = check_exactly(build(arm), arm)
    assert (exact.trials, exact.but, exact.what) == (3, "", "equations")


PROVEN = {
    "Kin_Scara4_ZCcoupled_Type1": "", "Kin_ArticulatedRobot_6DOF": "", "Kin_SCCC": "", "MC_KIN_TYPE_12_XY": "",
    "Kin_Crane": "", "Kin_Hexapod": "forward kinematics iterates",
}  # fmt: skip


@pytest.mark.parametrize("name", PROVEN)
def test_the_equations_hold_exactly(name: str) -> None:
    """Chains with couplings and pitches, loops, and the inverse of a platform."""
    exact = check_exactly(kinematics_of(named(name)), named(name))
    assert (exact.trials, exact.but) == (3, PROVEN[name])


@pytest.mark.long
@pytest.mark.parametrize("name", DRIVEN)
def test_gears_are_exact_too(name: str) -> None:
    """A turn of the axis is a fraction of one of the joint, or a multiple; screws read angles as numbers."""
    exact = check_exactly(kinematics_of(DRIVEN[name]), DRIVEN[name])
    assert exact.trials == 3, exact.but


@pytest.mark.long
def test_what_cannot_be_asked_is_said() -> None:
    searched = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
    exact = check_exactly(kinematics_of(named(searched)), named(searched))
    assert exact.sentence == "The equations were not checked in a finite field: its roots are searched along a joint."


P1, A1, LINK = linear("P1", "rail"), rotary("A1", "turn"), length("link", "link", nominal=300.0)


@pytest.mark.long
def test_a_turn_behind_the_links_is_exact() -> None:
    chain = Tx(P1) * Rz(A1) * Tx(LINK) * Rz(sp.pi / 5)
    described = validate(Mechanism(name="Turned", parameters=(LINK,), joints=(P1, A1), chain=chain, task=Task("xy")))
    assert check_exactly(build(described), described).trials == 3


def changed(program: Program, change: Callable[[Let], Let]) -> Program:
    """The program with a change of the direction from which it takes an angle last."""
    place = max(k for k, s in enumerate(program.body) if isinstance(s, Let) and s.value.atoms(Atan2))
    body = list(program.body)
    last = body[place]
    assert isinstance(last, Let)
    body[place] = change(last)
    return replace(program, body=tuple(body))


def nearly(let: Let) -> Let:
    """Its sine is wrong by 1e-14 of itself."""
    return replace(let, value=let.value.replace(Atan2, lambda y, x: Atan2((1 + sp.Rational(1, 10**14)) * y, x)))


NOMINAL = real("link_length_1") - 250
WRONG: dict[str, Callable[[Kinematics], Kinematics]] = {
    "a coefficient wrong by 1e-14": lambda k: replace(k, branch=changed(k.branch, nearly)),
    "a term that vanishes at the nominal machine": lambda k: replace(
        k,
        forward=replace(
            k.forward,
            outputs=tuple(
                Output(o.name, o.value + NOMINAL / 10**16) if o.name == "x" else o for o in k.forward.outputs
            ),
        ),
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_nearly_right_is_refused(what: str) -> None:
    """No measurement in floating-point numbers sees these."""
    name = "Kin_Scara4_ZCcoupled_Type1"
    spoiled = WRONG[what](kinematics_of(named(name)))
    with pytest.raises(Disagreement, match="does not meet the closure exactly"):
        check_exactly(spoiled, named(name))
