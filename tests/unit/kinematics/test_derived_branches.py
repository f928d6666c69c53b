"""Branches and assemblies that no description names: derived, called something, and told in words that are true."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy import cos, pi, sin

from derive.description.joints import Joint
from derive.description.loops import Rod
from derive.description.mechanism import (
    Branch,
    DescriptionError,
    Mechanism,
    Parameter,
    Task,
    X,
    Y,
    Z,
    assembly,
    length,
    linear,
    rod,
    rotary,
)
from derive.description.validate import validate
from derive.ir.interpret import evaluate
from derive.ir.program import Status
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import derive_and_measure
from derive.report.branch_meanings import pair_at_one_frame
from derive.report.reference_calls import Machine, branches, forward, machine_with
from tests.mechanisms import kinematics_of, named

pytestmark = pytest.mark.slow

NAMES = {
    "Kin_Scara4_ZCcoupled_Type1": ["elbow_1"],
    "Kin_SCCC": ["elbow_1"],
    "Kin_PCC": ["elbow_1"],
    "Kin_Pos_RRR": ["shoulder_1", "elbow_1"],
    "Kin_Ac6_ThreeParallel": ["shoulder_1", "wrist_1", "elbow_1"],
    "Kin_Wrist2": ["wrist_1"],
    "Kin_P2X_Type1": ["slide_1", "slide_2"],
    "Kin_P2C_Type2": ["elbow_1", "elbow_2"],
    "Softkin_TableTable_AC": ["wrist_1"],
}


def nameless(name: str) -> Mechanism:
    return replace(named(name), branches=())


def joints_at(mechanism: Mechanism, axes: Sequence[float]) -> list[float]:
    """Joint values of the nominal machine."""
    values = {p.symbol: p.nominal for p in mechanism.parameters}
    values |= {j.motor: a * (np.pi / 180 if j.is_angle else 1.0) for j, a in zip(mechanism.joints, axes, strict=True)}
    return [float(values[j.motor] + sp.sympify(j.coupling).subs(values)) for j in mechanism.joints]


def signs(mechanism: Mechanism, branch: Branch, poses: np.ndarray) -> np.ndarray:
    """The signs of an indicator at joint values and positions, for the nominal machine."""
    given = {p.symbol: p.nominal for p in mechanism.parameters} | {sp.Symbol("DEGREE", positive=True): np.pi / 180}
    position = sp.symbols("x y z", real=True)
    free = [*(j.symbol for j in mechanism.joints), *position]
    indicator = sp.sympify(branch.indicator).subs(given)
    own = {s: next(f for f in free if f.name == s.name) for s in indicator.free_symbols}
    return np.asarray(np.sign(sp.lambdify(free, indicator.xreplace(own))(*poses.T)))


@pytest.mark.parametrize("name", NAMES)
def test_every_step_is_named_once_and_is_a_branch_of_the_description(name: str) -> None:
    """At poses of the machine each derived indicator has the sign, or the opposite one, of one that is described."""
    described, derived = kinematics_of(named(name)), kinematics_of(nameless(name))
    assert [b.name for b in derived.branches] == NAMES[name]
    mechanism = described.mechanism
    machine = machine_with(described, {p.name: p.nominal for p in described.parameters})
    rng = np.random.default_rng(8)
    start = np.array([j.nominal for j in mechanism.joints])
    rows = []
    for _ in range(30):
        axes = start + rng.uniform(-1.0, 1.0, len(start)) * [70.0 if j.is_angle else 60.0 for j in mechanism.joints]
        status, frame, configuration = forward(machine, tuple(axes.tolist()))
        if status is Status.OK:
            every = branches(machine, frame, (0,) * len(configuration), tuple(axes.tolist()))
            solved = [one for one, answer in zip(*every[1:], strict=True) if answer is Status.OK]
            rows += [[*joints_at(mechanism, one), *frame[:3]] for one in (tuple(axes.tolist()), *solved)]
    poses = np.array(rows)
    assert len(poses) >= 20
    own = [signs(mechanism, b, poses) for b in described.branches]
    found = [[abs(np.sum(signs(mechanism, b, poses) * o)) == len(poses) for o in own] for b in derived.branches]
    assert sorted(map(sum, found)) == [1] * len(own)
    assert sorted(map(sum, zip(*found, strict=True))) == [1] * len(own)


@pytest.mark.parametrize("name", ["Kin_Scara4_ZCcoupled_Type1", "Kin_P2C_Type1", "Softkin_Planar_3RRR"])
def test_the_witness_agrees_with_what_is_derived(name: str) -> None:
    """The branches are measured as those of a description are, and the notes say what they mean."""
    whole = derive_and_measure(nameless(name))
    assert whole.evidence is not None and whole.evidence.inverted is not None
    described = derive_and_measure(named(name))
    assert described.evidence is not None and described.evidence.inverted == whole.evidence.inverted
    notes = [n for n in whole.mechanism.notes if n.startswith("The description does not name the branch ")]
    assert len(notes) == len(whole.branches) == len(described.branches)
    assert not [n for n in described.mechanism.notes if "does not name" in n]
    assert all(re.search("For one (frame|position) of the nominal machine positive has", note) for note in notes)


def test_the_meaning_in_words_is_true() -> None:
    """Two axis vectors of one frame, in both ways of a branch: each is where the words say."""
    whole = derive_and_measure(nameless("Kin_Scara4_ZCcoupled_Type1"))
    (note,) = (n for n in whole.mechanism.notes if "elbow_1" in n)
    assert "In positive A2 is between 0 and 180 degrees; in negative A2 is between -180 and 0 degrees. " in note
    one, other = (float(v) for v in re.findall(r"A2 (-?[\d.]+)", note)[-2:])
    assert 0 < one < 180 and one == -other
    _agree_with_meanings(whole)
    _agree_with_meanings(kinematics_of(nameless("Kin_Pos_RRR")))


def _agree_with_meanings(whole: Kinematics) -> None:
    """The pair that the note shows is in the branches that it says, and at one frame."""
    machine = machine_with(whole, {p.name: p.nominal for p in whole.parameters})
    for index in range(len(whole.branches)):
        pair = pair_at_one_frame(whole, index)
        assert pair is not None
        (_, first, bytes_1), (_, second, bytes_2) = (forward(machine, axes) for axes in pair)
        size = len(first) if whole.reads_rotation else 3
        assert np.allclose(first[:size], second[:size], rtol=0.0, atol=1e-4)
        assert (bytes_1[index], bytes_2[index]) == (1, 2)


def test_names_of_the_description_come_first_and_are_never_taken_again() -> None:
    """What is named keeps its name and its byte; the rest follows."""
    arm = named("Kin_Pos_RRR")
    (elbow,) = (b for b in arm.branches if b.name == "elbow")
    partly = replace(arm, branches=(replace(elbow, name="shoulder_1"),))
    built = kinematics_of(partly)
    assert [b.name for b in built.branches] == ["shoulder_1", "shoulder_2"]
    assert built.branches[0].names == elbow.names and built.branches[1].meanings[0]


R, F, ARM = (length(n, n, nominal=v) for n, v in (("rod", 400.0), ("base", 300.0), ("arm", 180.0)))
S1, S2, S3 = (linear(f"S{k}", "slide") for k in (1, 2, 3))
J1, J2 = (rotary(f"J{k}", "arm") for k in (1, 2))
C1, C2, C3 = (linear(f"C{k}", "cylinder", domain=(0.0, 1e9)) for k in (1, 2, 3))


def _feet(k: int) -> tuple[object, object, int]:
    return F * cos(2 * pi * k / 3), F * sin(2 * pi * k / 3), 0


def _loop(joints: Sequence[Joint], parameters: Sequence[Parameter], *rods: Rod, **more: Any) -> Mechanism:
    task = Task("xy" if len(joints) == 2 else "xyz")
    return Mechanism("Loop", tuple(joints), task, parameters=tuple(parameters), rods=rods, **more)


def _crank(joint: Joint) -> tuple[object, object]:
    return ARM * cos(joint), ARM * sin(joint)


PLAIN, STANDING = ("positive", "negative"), ("above", "below")
TIP, CYLINDERS = (X, Y, Z), (C1, C2, C3)
LOOPS: dict[str, tuple[Callable[[], Mechanism], str, int, tuple[str, str]]] = {
    "orthoglide": (
        lambda: _loop(
            (S1, S2, S3), (R,), rod("1", (S1, 0, 0), TIP, R), rod("2", (0, S2, 0), TIP, R), rod("3", (0, 0, S3), TIP, R)
        ),
        "rods_coplanar", 8, PLAIN,
    ),
    "three cylinders": (
        lambda: _loop(
            CYLINDERS, (F,), *(rod(str(k + 1), _feet(k), TIP, c) for k, c in enumerate(CYLINDERS)), positive=CYLINDERS
        ),
        "rods_coplanar", 1, STANDING,
    ),
    "two cords": (
        lambda: _loop(
            (C1, C2), (F,), rod("1", (-F, 0), (X, Y), C1), rod("2", (F, 0), (X, Y), C2), positive=(C1, C2)
        ),
        "rods_aligned", 1, PLAIN,
    ),
    "slides in one line": (
        lambda: _loop((S1, S2), (R,), rod("1", (S1, 0), (X, Y), R), rod("2", (S2, 0), (X, Y), R)),
        "rods_aligned", 1, PLAIN,
    ),
    "motors in one axis": (
        lambda: _loop((J1, J2), (ARM, R), rod("1", _crank(J1), (X, Y), R), rod("2", _crank(J2), (X, Y), R)),
        "rods_aligned", 1, PLAIN,
    ),
    "a crank and a slide on a quill": (
        lambda: _loop(
            (J1, S1, S3), (ARM, R), rod("1", _crank(J1), (X, Y), R), rod("2", (S1, 0), (X, Y), R), closure=(Z - S3,)
        ),
        "rods_aligned", 4, PLAIN,
    ),
}  # fmt: skip
"""The description, where its two positions meet, and the most solutions that a pose has: of slides in one line, and of
motors in one axis, equal rods lean to opposite sides."""


def _machines(kin: Kinematics) -> tuple[Machine, Machine]:
    """The nominal machine in both of its assemblies."""
    nominal, way = {p.name: p.nominal for p in kin.parameters}, kin.mechanism.assembly
    assert way is not None
    first, second = (machine_with(kin, nominal | {way.parameter: v}) for v in (0.0, 1.0))
    return first, second


@pytest.mark.parametrize("name", LOOPS)
def test_both_assemblies_are_derived_and_measured(name: str) -> None:
    """The witness finds as many solutions as the loop has. At the same axes both machines have a position, and the
    indicator has the stated sign.
    """
    described, margin, solutions, names = LOOPS[name]
    kin = derive_and_measure(described())
    way = kin.mechanism.assembly
    assert way is not None and way.margin == margin and way.names == names
    assert kin.evidence is not None and kin.evidence.inverted is not None
    assert kin.evidence.inverted.solutions == solutions
    assert any(f"{way.parameter} chooses" in note for note in kin.mechanism.notes)
    pair, found = _machines(kin), 0
    for axes in np.random.default_rng(5).uniform(-90.0, 700.0, (300, len(kin.mechanism.joints))).tolist():
        poses = [forward(machine, tuple(axes)) for machine in pair]
        assert poses[0][0] is poses[1][0], "one is as possible as the other"
        if poses[0][0] is not Status.OK:
            continue
        units = [np.pi / 180 if j.is_angle else 1.0 for j in kin.mechanism.joints]
        known = {p.name: np.asarray(p.nominal) for p in kin.parameters}
        known |= {j.symbol.name: np.asarray(v * u) for j, v, u in zip(kin.mechanism.joints, axes, units, strict=True)}
        signs = [
            float(evaluate(way.indicator, known | {c: np.asarray(p[k]) for k, c in enumerate("xyz")}))
            for _, p, _ in poses
        ]
        assert way.signs[0] * signs[0] >= 0 >= way.signs[0] * signs[1]
        assert np.isclose(signs[0], -signs[1], rtol=1e-6, atol=1e-3 * abs(signs[0]))
        found += 1
    assert found > 5


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1)])
@pytest.mark.parametrize("height", [250.0, 0.0])
def test_what_hangs_on_arms_or_carriages_is_below_them(order: tuple[int, ...], height: float) -> None:
    """Whichever way its towers are numbered: the first mode has the plate below the carriages of the nominal pose."""
    carriages = tuple(linear(f"C{k}", "carriage, up", nominal=height) for k in (1, 2, 3))
    feet = [_feet(k)[:2] for k in order]
    rods = tuple(rod(c.key, (*foot, c), (X, Y, Z), R) for foot, c in zip(feet, carriages, strict=True))
    kin = build(validate(Mechanism(name="Towers", joints=carriages, parameters=(R, F), task=Task("xyz"), rods=rods)))
    way = kin.mechanism.assembly
    assert way is not None and (way.names, way.parameter) == (("below", "above"), "assembly_above")
    drop = float(np.sqrt(400.0**2 - 300.0**2))
    for machine, side in zip(_machines(kin), (-1, 1), strict=True):
        _, frame, _ = forward(machine, (height, height, height))
        assert frame[:3] == pytest.approx((0.0, 0.0, height + side * drop), abs=1e-6)


def test_a_loop_with_one_assembly_needs_no_name() -> None:
    """Two equations, linear in the position."""
    slides = Mechanism(name="Slides", joints=(S1, S2), task=Task("xy"), closure=(X - S1 - S2, Y - S1 + S2))
    kin = derive_and_measure(slides)
    assert kin.mechanism.assembly is None
    named = replace(slides, assembly=assembly("tool", Y - S1, margin="aligned", up=+1, down=-1))
    with pytest.raises(DescriptionError, match="assembly 'tool': the loop can be assembled in one way alone"):
        derive_and_measure(named)
