"""Turning loops whose equations are stated without rods: read as rods where they are, else refused with the reason."""

import time
from dataclasses import replace

import pytest
import sympy as sp

from derive.description.mechanism import ROTATION, DescriptionError, Mechanism, Task, Turning, X, Y, Z, length
from derive.description.validate import validate
from derive.kinematics.build import build
from derive.plate.stated_rods import with_positive_lengths, with_stated_rods
from tests.mechanisms import kinematics_of, named
from tests.unit.kinematics.turning_inventions import TURNING_INVENTIONS, three_prr, three_rpr

MACHINES = {
    **{name: own for name, (own, _) in TURNING_INVENTIONS.items()},
    **{name: named(name) for name in ("Softkin_Planar_3RRR", "Softkin_Hexaglide", "Kin_Hexapod")},
}
QUICK = 20.0
"""Seconds, in which anything is refused."""


def stated(mechanism: Mechanism, factor: object = -3) -> Mechanism:
    """The same loop as equations alone, each times a factor."""
    return replace(mechanism, rods=(), closure=tuple(factor * r.equation for r in mechanism.rods))


@pytest.mark.long("cranks", "Kin_Hexapod")
@pytest.mark.parametrize("name", MACHINES)
def test_equations_that_are_rods_are_read_as_these(name: str) -> None:
    """Every machine that turns its platform, in space and in a plane, with joints in the length and in the base."""
    mechanism = MACHINES[name]
    read = with_stated_rods(stated(mechanism))
    assert read.closure == () and len(read.rods) == len(mechanism.rods)
    values = {s: sp.Rational(k + 3, 7) for k, s in enumerate(sorted(mechanism.rods[0].equation.free_symbols, key=str))}
    values |= dict(zip(ROTATION, sp.rot_axis3(-0.7), strict=True))
    if mechanism.task.turning is Turning.FULL:
        values |= dict(zip(ROTATION, sp.rot_axis1(0.4) * sp.rot_axis2(-0.9) * sp.rot_axis3(0.3), strict=True))
    for one, other in zip(read.rods, mechanism.rods, strict=True):
        rest = {s: sp.Rational(5, 3) for s in (one.equation.free_symbols | other.equation.free_symbols) - set(values)}
        difference = (one.equation - other.equation).subs(values | rest)
        assert abs(sp.N(difference)) <= 1e-9 * (1.0 + abs(sp.N(other.equation.subs(values | rest))))


@pytest.mark.long
def test_the_programs_are_those_of_the_rods() -> None:
    """The planar 3-RRR as equations is the 3-RRR of the catalogue."""
    mechanism = named("Softkin_Planar_3RRR")
    one, other = build(validate(stated(mechanism))), kinematics_of(mechanism)
    assert one.branch == other.branch
    assert one.forward == other.forward
    assert one.jacobian == other.jacobian
    assert one.margins == other.margins


@pytest.mark.long
def test_an_equation_that_is_multiplied_out_is_read_too() -> None:
    """With two entries of the rotation, as heading's cosine and sine, and every square expanded."""
    mechanism = named("Softkin_Planar_3RRR")
    table = {ROTATION[0, 1]: -ROTATION[1, 0], ROTATION[1, 1]: ROTATION[0, 0]}
    long = replace(mechanism, rods=(), closure=tuple(sp.expand(r.equation.xreplace(table)) / 2 for r in mechanism.rods))
    assert [(r.base, r.plate, r.length) for r in with_stated_rods(long).rods] == [
        (tuple(map(sp.expand, r.base)), r.plate, r.length) for r in mechanism.rods
    ]


def differences(mechanism: Mechanism) -> Mechanism:
    """The first equation as a difference of two: no rod."""
    first, second, *others = (r.equation for r in mechanism.rods)
    return replace(mechanism, rods=(), closure=(first - second, second, *others))


TURNS = ROTATION[0, 0] * sp.sin(three_rpr().joints[2].symbol) - ROTATION[1, 0] * sp.cos(three_rpr().joints[2].symbol)
REFUSED = {
    "a difference of two": (
        lambda: differences(three_prr()),
        "it has 2 rods and 1 other equations: closure= of a loop that turns its platform must say that a point of the "
        "platform keeps its distance from one that joints move",
    ),
    "a length that depends on the pose": (
        lambda: replace(three_rpr(), rods=three_rpr().rods[1:], closure=(three_rpr().rods[0].equation + X * Y,)),
        "it has 2 rods and 1 other equations",
    ),
    "a joint that turns the platform": (
        lambda: replace(three_rpr(), rods=three_rpr().rods[:2], closure=(TURNS,)),
        "an equation that only turns it: where a joint on the plate (P3) does, say so by heading=",
    ),
    "a platform that moves where it is not commanded": (
        lambda: replace(named("Kin_Hexapod"), task=Task("z", Turning.DIRECTION)),
        "the task commands 'z', and the loop moves x, y as well: coordinates that are not commanded must be held by "
        "guides=",
    ),
    "a task without x": (
        lambda: replace(three_rpr(), task=Task("yz", Turning.ABOUT_Z), closure=(Z - 1,)),
        "the task commands 'yz', and the loop moves x as well",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_rule_derives_is_refused_with_the_reason(what: str) -> None:
    change, said = REFUSED[what]
    began = time.process_time()
    with pytest.raises(DescriptionError) as refused:
        build(validate(change()))
    assert said in str(refused.value)
    assert time.process_time() - began < QUICK


def test_a_length_under_a_square_has_the_sign_that_makes_it_positive() -> None:
    """A winch that pays out less than the whole cable: the equation holds the square of the rest."""
    total = length("cable", "whole length of a cable", nominal=2000.0)
    own = three_rpr()
    taut = tuple(r.equation + r.length**2 - (r.length - total) ** 2 for r in own.rods)
    stated = replace(own, parameters=(*own.parameters, total), rods=(), closure=taut, positive=())
    rods = with_stated_rods(stated).rods
    assert [r.length for r in rods] == [total.symbol - r.length for r in own.rods]
    assert with_positive_lengths(with_stated_rods(stated)).positive == tuple(r.length for r in rods)
