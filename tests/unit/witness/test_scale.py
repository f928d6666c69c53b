"""The unit and the size of a machine change no verdict; a solution is found where Newton's method ends, not before."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from sympy import cos, pi, sin

from derive.description.mechanism import Mechanism, Parameter, Task, length, linear, rod, rotary
from derive.description.validate import validate
from derive.frames import Ry, Rz, Ty, Tz
from derive.ir.program import Status
from derive.kinematics.build import build
from derive.kinematics.kinematics import Called, Evidence
from derive.mechanism import Turning, X, Y, branch, coordinate, on_plate
from derive.mechanisms import kin_p2x_type1
from derive.pipeline import derive_and_measure
from derive.witness import roots, witness
from derive.witness.closure import closure_of
from derive.witness.samples import regular_samples
from tests.unit.kinematics.inventions import planar_arm

pytestmark = pytest.mark.slow

UNITS = [1.0, 1e-3, 2e-6, 60.0]


def solutions(evidence: Evidence) -> int:
    assert evidence.inverted is not None
    assert max(evidence.closure_residual, evidence.inverted.round_trip, evidence.inverted.jacobian) <= 1e-11
    return evidence.inverted.solutions


def flat_platform(unit: float) -> Mechanism:
    """A plate in a plane on three telescopes."""
    base, plate = (length(n, n, nominal=v * unit) for n, v in (("base", 430.0), ("plate", 95.0)))
    own = tuple(linear(f"L{k}", f"leg {k}", nominal=340.0 * unit) for k in (1, 2, 3))

    def corner(radius: Parameter, k: int) -> tuple[object, object]:
        return radius * cos(2 * pi * k / 3), radius * sin(2 * pi * k / 3)

    rods = tuple(rod(str(k + 1), corner(base, k), on_plate(*corner(plate, k)), leg) for k, leg in enumerate(own))
    common = {"task": Task("xy", Turning.ABOUT_Z), "home": (0, 0, 0.45), "offset_interface": False}
    return Mechanism(name="Flat", parameters=(base, plate), joints=own, rods=rods, **common)


def six_legs(unit: float) -> Mechanism:
    """A plate on six telescopes, of which every joint has coordinates of its own."""
    rng = np.random.default_rng(4)
    around = {"base": (700.0, (8, 112, 128, 232, 248, 352)), "plate": (320.0, (52, 68, 172, 188, 292, 308))}
    parameters: list[Parameter] = []
    points: dict[str, list[list[Parameter]]] = {"base": [], "plate": []}
    for word, (radius, angles) in around.items():
        for k, degrees in enumerate(angles, 1):
            at = radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), rng.uniform(-20.0, 20.0)
            named = zip("xyz", at, strict=True)
            points[word].append([coordinate(f"{word}_{k}_{c}", c, nominal=float(v) * unit) for c, v in named])
            parameters += points[word][-1]
    own = tuple(linear(f"L{k}", f"leg {k}", nominal=950.0 * unit) for k in range(1, 7))
    ends = zip(own, points["base"], points["plate"], strict=True)
    return Mechanism(
        name="Six",
        parameters=tuple(parameters),
        joints=own,
        task=Task("xyz", Turning.FULL),
        home=(0, 0, 850.0 * unit, 0, 0, 0),
        rods=tuple(rod(leg.key, foot, on_plate(*top), leg) for leg, foot, top in ends),
        offset_interface=False,
    )


KINDS: dict[str, tuple[Callable[[float], Mechanism], int]] = {"flat": (flat_platform, 1), "six": (six_legs, 1)}


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_machine_is_accepted_in_every_unit(kind: str, unit: float) -> None:
    """With legs of variable length of which the description does not say that they are positive: they are. The
    self-test has several regular poses.
    """
    described, expected = KINDS[kind]
    kin = derive_and_measure(validate(described(unit)))
    assert kin.evidence is not None and solutions(kin.evidence) == expected
    assert not kin.branches
    assert kin.self_test is not None
    cases = [c for c in kin.self_test.cases if c.called is Called.FORWARD and c.status is Status.OK]
    assert len({c.axes for c in cases}) >= 3


def short_tip(unit: float) -> Mechanism:
    """An arm whose last link and a shift are some hundredths of the others: they hardly move the tool."""
    sizes = (26.0, 97.0, 21.0, 0.5, 1.1)
    own = tuple(length(f"l{k}", f"shift {k}", nominal=v * unit) for k, v in enumerate(sizes, 1))
    a, b, c, d = (rotary(f"A{k}", f"joint {k}") for k in (1, 2, 3, 4))
    chain = Rz(a) * Ty(own[0]) * Rz(b) * Tz(own[1]) * Ry(c) * Ty(own[2]) * Tz(own[3]) * Ry(d) * Tz(own[4])
    return validate(
        Mechanism(name="Tip", parameters=own, joints=(a, b, c, d), chain=chain, task=Task("xyz"), held=(a,))
    )


@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_no_solution_is_counted_before_it_is_found(unit: float) -> None:
    """A joint that hardly moves the tool leaves a small residual far away from its solution."""
    described = short_tip(unit)
    kin = build(described)
    assert solutions(witness(kin, described)) == 4
    closure = closure_of(described, kin.mechanism)
    samples = regular_samples(kin, closure)
    problem = roots.problem_at(closure, samples.take(np.array([0])))
    (found,) = roots.all_solutions(problem)
    one = problem.take(np.zeros(len(found), dtype=int))
    away = found + 5e-6 * np.linalg.svd(one.slopes(found))[2][:, -1]
    assert np.linalg.norm(one.residual(away), axis=1).max() < 1e-9
    assert roots.is_solution(one, found).all() and not roots.is_solution(one, away).any()


def test_a_solution_that_no_start_finds_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The slots hold it, and the closure says that it is one."""
    two = validate(planar_arm())
    monkeypatch.setattr("derive.witness.inverse.all_solutions", lambda p, _: [f[:1] for f in roots.all_solutions(p)])
    assert solutions(witness(build(two), two)) == 2


def test_a_leg_whose_sign_a_branch_tells_keeps_it() -> None:
    """A description that names both signs of a length has both solutions."""
    base = length("base", "anchors", nominal=420.0)
    own = tuple(linear(f"L{k}", "leg", nominal=500.0) for k in (1, 2))
    rods = tuple(rod(str(k), (s * base / 2, 0), (X, Y), leg) for k, s, leg in ((1, -1, own[0]), (2, 1, own[1])))
    plain = Mechanism(name="Cords", parameters=(base,), joints=own, task=Task("xy"), rods=rods)
    named = replace(plain, branches=(branch("side", own[0], out=+1, through=-1),))
    for described, count in ((validate(plain), 1), (validate(named), 2)):
        assert solutions(witness(build(described), described)) == count


def test_fewer_solutions_than_branches_are_told_as_what_was_seen() -> None:
    """Two rods on slides have four branches; those of the other assembly mode are no solutions of this machine."""
    told: list[str] = []
    kin = derive_and_measure(kin_p2x_type1.MECHANISM, lambda stage, found: told.append(f"{stage} {found}"))
    assert kin.evidence is not None and kin.evidence.inverted is not None
    seen = kin.evidence.inverted.solutions
    assert seen < 4 and f"up to {seen} solutions seen, of 4 branches" in told[-1]


def test_the_number_of_solutions_is_the_largest_of_all_poses() -> None:
    """A five-bar has poses with four solutions in one assembly mode, and the first poses of its machines have less."""
    sizes = (("base", 160.0), ("arm", 210.0), ("rod", 330.0))
    base, link, forearm = (length(n, n, nominal=v) for n, v in sizes)
    joints = tuple(rotary(f"A{k}", "arm") for k in (1, 2))
    knees = [(s * base / 2 + link * cos(a), link * sin(a)) for s, a in zip((-1, 1), joints, strict=True)]
    rods = tuple(rod(str(k), knee, (X, Y), forearm) for k, knee in enumerate(knees, 1))
    own = (base, link, forearm)
    bars = validate(Mechanism(name="Bars", parameters=own, joints=joints, task=Task("xy"), rods=rods))
    assert solutions(witness(build(bars), bars)) == 4
