"""Invented machines from the description to the numbers; nominal dimensions that leave no pose, or few."""

import re
import time
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from sympy import cos, sin

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Rod,
    Task,
    X,
    Y,
    angle,
    length,
    linear,
    radians,
    rod,
    rotary,
)
from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.ir.program import Let, Output, Program, Status
from derive.kinematics.build import build
from derive.kinematics.sampling import ENOUGH, sample_axes, sample_machine
from derive.mechanism import assembly, branch
from derive.pipeline import derive_and_measure
from derive.vectors import cross, dot, minus, vector
from derive.witness import Disagreement, witness
from tests.unit.kinematics.inventions import INVENTIONS, described
from tests.unit.kinematics.machine import Machine, machine

A1, A2 = rotary("A1", "turn"), rotary("A2", "turn")
S1, S2 = linear("S1", "slide"), linear("S2", "slide")
RADIUS = linear("R", "radius", domain=(0.0, 50.0))
LINK, OTHER = length("link", "link", nominal=300.0), length("other", "link", nominal=200.0)
ROD, BASE = length("rod_length", "rod", nominal=120.0), length("base", "base", nominal=1800.0)
P = vector(X, Y)


def two_rods(first: Rod, second: Rod, **stated: object) -> Mechanism:
    one, two = (minus(P, r.base) for r in (first, second))
    ways = [(branch(n, dot(vector(1, 0), v), ahead=+1, behind=-1)) for n, v in (("left", one), ("right", two))]
    mode = assembly("tcp", cross(one, two), margin="aligned", above=+1, below=-1)
    return described(rods=(first, second), task=Task("xy"), branches=tuple(ways), assembly=mode, **stated)


KNEE = vector(LINK * cos(A1), LINK * sin(A1))
OTHER_KNEE = vector(BASE + LINK * cos(A2), LINK * sin(A2))
BENT = {"parameters": (LINK, ROD, BASE), "joints": (A1, A2)}
PLANAR = load(MECHANISMS / "softkin_planar_3rrr.py")

NOWHERE = {
    "a five-bar too wide for its arms": (
        two_rods(rod("1", KNEE, P, ROD), rod("2", OTHER_KNEE, P, ROD), **BENT),
        "the loop never closes: at best rod '1' is 120 long, and should be 600, rod '2' is 120 long, and should be 600",
    ),
    "rails too far apart": (
        two_rods(
            rod("1", vector(S1, 0), P, ROD), rod("2", vector(S2, 500), P, ROD), parameters=(ROD,), joints=(S1, S2)
        ),
        "the loop never closes: at best rod '1' is 120 long, and should be 250",
    ),
    "a home pose out of reach": (
        replace(PLANAR, home=(5000, 0, 0)),
        "its home pose is not where the legs reach it: at best rod '1' is 180 long, and should be 5031",
    ),
    "a quantity that is never positive": (
        described(
            parameters=(LINK,),
            joints=(A1, RADIUS),
            chain=Rz(A1) * Tx(RADIUS),
            task=Task("xy"),
            positive=(RADIUS - LINK,),
        ),
        "-link + r must be positive, and is at most -250",
    ),
    "quantities that are never positive together": (
        described(
            parameters=(LINK, OTHER),
            joints=(A1, A2),
            chain=Rz(A1) * Tx(LINK) * Rz(A2) * Tx(OTHER),
            task=Task("xy"),
            positive=(sin(A2), -cos(A2) - 0.9, cos(A2)),
            offset_interface=False,
        ),
        "must be positive, and never are together",
    ),
    "rails that meet far from where they begin": (
        replace(
            load(MECHANISMS / "kin_tripod_linear.py"),
            parameters=tuple(
                replace(p, nominal=3000.0) if p.name == "outer_radius" else p
                for p in load(MECHANISMS / "kin_tripod_linear.py").parameters
            ),
        ),
        "no sampled pose is possible, but the loop closes at",
    ),
}


@pytest.mark.long("five-bar", "out of reach", "never positive", "rails")
@pytest.mark.parametrize("kind", NOWHERE)
def test_no_pose_closes(kind: str) -> None:
    """The sentence names what misses, and by how much; it comes within seconds."""
    mechanism, sentence = NOWHERE[kind]
    start = time.process_time()
    with pytest.raises((DescriptionError, Disagreement), match=re.escape(sentence)):
        derive_and_measure(validate(mechanism))
    assert time.process_time() - start < 10.0


LEAN_1 = angle("lean_1", "first rail against X", nominal=35.0)
LEAN_2 = angle("lean_2", "second rail against X", nominal=110.0)
SLIDE_1, SLIDE_2 = (linear(f"S{k}", f"carriage {k}") for k in (1, 2))
ALONG_1, ALONG_2 = (vector(cos(radians(lean)), sin(radians(lean))) for lean in (LEAN_1, LEAN_2))
PLATE = vector(X, Y)


def rails(rod_length: float, apart: float = 300.0) -> Mechanism:
    """Two rails at any angles, some way apart, whose carriages hold a point by two rods."""
    size = length("rod_length", "both rods", nominal=rod_length)
    carriage_1 = vector(SLIDE_1 * ALONG_1[0], SLIDE_1 * ALONG_1[1])
    carriage_2 = vector(apart + SLIDE_2 * ALONG_2[0], SLIDE_2 * ALONG_2[1])
    rod_1, rod_2 = minus(PLATE, carriage_1), minus(PLATE, carriage_2)
    return described(
        parameters=(LEAN_1, LEAN_2, size),
        joints=(SLIDE_1, SLIDE_2),
        rods=(rod("1", carriage_1, PLATE, size), rod("2", carriage_2, PLATE, size)),
        task=Task("xy"),
        branches=(
            branch("left", dot(ALONG_1, rod_1), ahead=+1, behind=-1),
            branch("right", dot(ALONG_2, rod_2), ahead=+1, behind=-1),
        ),
        assembly=assembly("tcp", cross(rod_1, rod_2), margin="aligned", above=+1, below=-1),
    )


@pytest.mark.long
def test_branches_are_told_apart_where_few_of_the_drawn_poses_close() -> None:
    """Rods much shorter than the rails are apart: enough poses are found, and each indicator agrees with one step."""
    mechanism = rails(40.0)
    assert [m.name for m in build(mechanism).margins] == ["left", "right", "aligned"]
    found = machine(mechanism)
    drawn = sample_axes(mechanism, sample_machine(mechanism, 21), 64, 22)
    _, status = found.run(found.kinematics.forward, drawn)
    assert 0 < np.sum(np.asarray(status) == Status.OK) < ENOUGH


@pytest.mark.long
def test_a_loop_that_closes_far_away_is_said_to() -> None:
    """Rails that cross far from where they begin: the sentence names where, by the law of sines."""
    sentence = "no sampled pose is possible, but the loop closes at S1 = 9.728e+05, S2 = 5.938e+05: state nominal"
    with pytest.raises(DescriptionError, match=re.escape(sentence)):
        build(rails(1e-3, 1e6))


EVERY = pytest.mark.parametrize("name", INVENTIONS)


@cache
def built(name: str) -> Machine:
    """The machine with offsets on its axes: nothing stands at zero by accident."""
    mechanism = validate(INVENTIONS[name])
    offsets = {j.offset.name: 10.0 * k - 25.0 for k, j in enumerate(mechanism.joints)}
    return machine(mechanism, **offsets)


@pytest.mark.slow
@EVERY
def test_the_witness_finds_no_other_solution(name: str) -> None:
    """Multi-start root finding finds exactly as many solutions as there are slots."""
    evidence = witness(built(name).kinematics, INVENTIONS[name])
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == len(built(name).slots)
    assert evidence.closure_residual <= 1e-12


INPUTS = (0.0, 1e-300, -1e-12, 1e-6, 1.0, -300.0, 500.0, 1e6, 1e9, -1e9)


def everything(program: Program) -> Program:
    """The program with every value that it binds as an output."""
    return replace(program, outputs=tuple(Output(s.name.name, s.name) for s in program.body if isinstance(s, Let)))


@pytest.mark.slow
@EVERY
@pytest.mark.parametrize(
    "kind", ["forward", "branch", "singularity", "jacobian", "offset_branch", "offset_configuration"]
)
def test_total(name: str, kind: str) -> None:
    program = getattr(built(name).kinematics, kind)
    if program is None:
        assert kind.startswith("offset") and not INVENTIONS[name].offers_points
        return
    generator = np.random.default_rng(9)
    free = [s.name for s in program.inputs if s.name not in built(name).constants]
    given = {n: generator.choice(INPUTS, 3000) for n in free}
    given |= {n: generator.choice([-1.0, 1.0], 3000) for n in free if n.startswith("sigma_")}
    values, _ = built(name).run(everything(program), given)
    for let, value in values.items():
        assert np.all(np.isfinite(value)), let
