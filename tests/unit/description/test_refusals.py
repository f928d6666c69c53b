"""Descriptions that are wrong or not supported: refused with a sentence that names the fault."""

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest
from sympy import cos, sin

from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Parameter,
    Task,
    Turning,
    X,
    Y,
    branch,
    distance,
    flag,
    length,
    rotary,
)
from derive.description.validate import validate
from derive.geometry.frames import Rx, Rz, Tx, Ty, flip_x
from derive.kinematics.build import build
from derive.solver.unsolved import Unsolved
from tests.mechanisms import named
from tests.unit.kinematics.inventions import A1, A2, A3, A4, L1, L2, L3, P1, P2, P3, described, links
from tests.unit.kinematics.inventions import planar_arm as arm

FOLLOWED = Turning.ABOUT_Z
FLANGE = flag("flange_down", "flange looks down")
ARM = Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2)


def with_parameter(name: str, kind: Callable[..., Parameter] = length) -> Mechanism:
    odd = kind(name, "second link", nominal=200.0)
    return arm(parameters=(L1, odd), chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(odd))


NATURAL = """
    upper_arm axis_offset branch_pipe reach upper_a1 lowest_a1 upper_a_1 axis_a1 cos_a2 sigma_elbow x r11 Link
    linkLength _link link__length lambda check_limits given_x a1 a12
""".split()
OF_EITHER_SIGN = ("tool_x", "point_x", "reach", "x", "r11", "heading", "cos_a2")
"""Their symbols are those of values of a derivation, to the last assumption."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "name"), [*((length, name) for name in NATURAL), *((distance, name) for name in OF_EITHER_SIGN)]
)
def test_any_identifier_names_a_parameter(kind: Callable[..., Parameter], name: str) -> None:
    """Whatever programs call so: the description keeps its name, and the derivation is that of any other name."""
    built = build(validate(with_parameter(name, kind)))
    assert [p.given_name for p in built.parameters[:2]] == ["link_1", name]
    assert [len(p.body) for p in built.programs] == lengths_of_programs(kind)


@cache
def lengths_of_programs(kind: Callable[..., Parameter]) -> list[int]:
    return [len(p.body) for p in build(validate(with_parameter("link_beside", kind))).programs]


@pytest.mark.long
def test_a_joint_may_have_the_name_of_a_sum() -> None:
    """A1 + A2 is called a12 inside."""
    joints = {"joints": (A1, A2, TWELVE), "chain": links(A1, A2, TWELVE), "parameters": (L1, L2, L3)}
    assert build(validate(arm(task=Task("xy", FOLLOWED), **joints))).margins[0].name == "elbow"


TWELVE = rotary("A12", "a name too many")

REFUSED = {
    "an indicator of an unknown joint": (
        arm(branches=(branch("elbow", sin(A3), right=+1, left=-1),)),
        "branch 'elbow' reads 'a3', which is not a joint or a parameter",
    ),
    "a flip in the middle": (
        arm(
            joints=(A1, A2, A3),
            parameters=(L1, L2, FLANGE),
            chain=Rz(A1) * Tx(L1) * flip_x(FLANGE) * Rz(A2) * Tx(L2) * Rz(A3),
            task=Task("xy", FOLLOWED),
        ),
        "a flip must stand at the end",
    ),
    "a flange that turns about x": (
        described(parameters=(L1,), joints=(P1, A1), chain=Tx(P1) * Rx(A1) * Tx(L1), task=Task("xy")),
        "the closure does not determine a1",
    ),
    "one link too many": (
        described(
            parameters=(L1, L2, L3),
            joints=(A1, A2, A3, A4),
            chain=links(A1, A2, A3) * Rz(A4),
            task=Task("xy", FOLLOWED),
        ),
        "one joint too many: the task commands 3 quantities (x, y, turn z), and 4 joints are to be solved for; name the"
        " one that is held at the reference: held=(A1,)",
    ),
    "a telescope with a point beside it": (
        described(
            parameters=(L1,),
            joints=(A1, P1),
            chain=Rz(A1) * Tx(P1),
            task=Task("xy"),
            positive=(P1,),
            offset_interface=True,
        ),
        "with offset_interface=False it could be built, but for a point off the flange no branch names the two "
        "solutions for p1",
    ),
    "two slides too many": (
        described(joints=(P1, P2, P3, A1), chain=Tx(P1 + P2) * Ty(P3) * Rz(A1), task=Task("xy")),
        "2 joints too many: the task commands 2 quantities (x, y), and 4 joints are to be solved for; name those that"
        " are held",
    ),
    "a loop with a joint too many": (
        arm(joints=(P1, P2, P3), chain=None, closure=(X - P1, Y - P2 - P3), branches=()),
        "one joint too many: the task commands 2 quantities (x, y), and 3 joints are to be solved for; command more of "
        "the pose, or leave out joints",
    ),
    "a joint held that the task needs": (arm(held=(A2,)), "2 joints, of which 1 is held"),
    "a radius that is never positive": (
        arm(positive=(-1 - cos(A2) ** 2,)),
        "-cos(a2)**2 - 1 must be positive, and is at most -1: check the nominal values of parameters",
    ),
    "a parameter in letters of no language": (with_parameter("länge"), "'länge' cannot name a parameter: letters"),
    "parameters of one name": (with_parameter("link_1"), "parameter 'link_1' is given 2 times"),
    "a held joint with a gear coupling": (
        arm(joints=(A1, replace(A2, coupling=A1.motor), A3), chain=ARM * Rz(A3), held=(A2,)),
        "joint 'A2' is held and geared to other axes",
    ),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused(kind: str) -> None:
    mechanism, message = REFUSED[kind]
    with pytest.raises((DescriptionError, Unsolved), match=re.escape(message)):
        build(validate(mechanism))


def test_a_closure_without_one_coordinate() -> None:
    said = "the closure does not determine z: 3 unknowns in 2 equations (x, y) leave 1 free to move; state one more "
    with pytest.raises(Unsolved, match=re.escape(f"{said}equation")):
        build(described(joints=(P1, P2, P3), closure=(X - P1, Y - P2), task=Task("xyz")))


@pytest.mark.long
def test_a_root_scan_needs_names() -> None:
    """Its roots are told apart by a crossing, and its other branches are those of the description."""
    arm = named("Kin_Ac6_RZRYRYRXRYRZ_J6Offset")
    without = tuple(b for b in arm.branches if not b.is_crossing)
    with pytest.raises(DescriptionError, match="search needs a branch that tells its roots apart"):
        validate(replace(arm, branches=without))
    crossing = tuple(b for b in arm.branches if b.is_crossing)
    with pytest.raises(DescriptionError, match="no branch names the two solutions for"):
        build(replace(arm, branches=crossing))


def test_what_the_offset_interface_spoils_can_be_built_without() -> None:
    """A mechanism that only the offset interface leaves unsolved is built without it, unless it is asked for."""
    telescope = REFUSED["a telescope with a point beside it"][0]
    for said in (False, None):
        assert build(replace(telescope, offset_interface=said)).offset_branch is None


def test_a_branch_has_two_names_and_both_signs() -> None:
    for names in ({"right": 1}, {"right": 1, "left": 1}, {"right": 1, "left": -1, "up": 1}, {"right": 2, "left": -2}):
        with pytest.raises(DescriptionError, match="branch 'elbow' needs two names with the signs \\+1 and -1"):
            branch("elbow", sin(A2), **names)
