"""Invented mechanisms from the description to the numbers, through `derive.build` alone."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import combinations

import numpy as np
import pytest

from derive.description.mechanism import Kind
from derive.description.validate import validate
from derive.ir.program import Let, Output, Program, Status
from derive.witness import witness
from tests.unit.kinematics.inventions import INVENTIONS
from tests.unit.kinematics.machine import ENTRIES, Machine, Values, machine

pytestmark = pytest.mark.slow

COUNT = 120
EVERY = pytest.mark.parametrize("name", INVENTIONS)


@cache
def built(name: str) -> Machine:
    """The machine with offsets on its axes: nothing stands at zero by accident."""
    mechanism = validate(INVENTIONS[name].mechanism)
    offsets = {j.offset.name: 10.0 * k - 25.0 for k, j in enumerate(mechanism.joints)}
    return machine(mechanism, **offsets)


def axes_of(name: str, seed: int = 3) -> Values:
    """Axis values over several turns and along the slides; radii on the side that the machine has."""
    generator = np.random.default_rng(seed)
    found: Values = {}
    for joint in built(name).kinematics.mechanism.joints:
        low, high = (-500.0, 500.0) if joint.is_angle else (5.0, 400.0)
        found[joint.axis.name] = generator.uniform(low, high, COUNT) + built(name).constants[joint.offset.name]
    return found


def by_hand(name: str, axes: Values) -> dict[str, np.ndarray]:
    """x, y, z and turn at axis values, by the formulas of the invention."""
    constants, joints, motors = built(name).constants, {}, {}
    for joint in built(name).kinematics.mechanism.joints:
        motors[joint.name] = (axes[joint.axis.name] - constants[joint.offset.name]) * (
            np.pi / 180 if joint.is_angle else 1.0
        )
        joints[joint.name] = motors[joint.name]
    if "coupling_12" in constants:
        joints["A2"] = joints["A2"] + constants["coupling_12"] * motors["A1"]
    plane, z, turn = INVENTIONS[name].hand(constants, joints)
    return {
        k: np.broadcast_to(v, (COUNT,)) for k, v in {"x": plane.real, "y": plane.imag, "z": z, "turn": turn}.items()
    }


@EVERY
def test_forward_is_what_the_description_means(name: str) -> None:
    """Forward kinematics is that of the closure, computed by hand."""
    axes = axes_of(name)
    pose, expected = built(name).forward(axes), by_hand(name, axes)
    size = 1 + max(np.abs(expected[c]).max() for c in "xyz")
    for coordinate in "xyz":
        assert np.abs(pose[coordinate] - expected[coordinate]).max() <= 1e-12 * size
    if "turn z" in built(name).kinematics.rows:
        assert np.abs(pose["r11"] - np.cos(expected["turn"])).max() <= 1e-11
        assert np.abs(pose["r21"] - np.sin(expected["turn"])).max() <= 1e-11


@EVERY
def test_the_way_back(name: str) -> None:
    """The branch of the axes themselves, with the reference at them, brings every turn back."""
    axes = axes_of(name)
    pose = built(name).forward(axes)
    back, status = built(name).inverse(pose, built(name).signs(pose), axes)
    assert set(status) == {Status.OK}
    assert max(np.abs(back[a] - axes[a]).max() for a in axes) <= 1e-8


@EVERY
def test_every_slot_is_another_solution(name: str) -> None:
    """Every slot is a different solution of the closure, with its own signs."""
    axes, own = axes_of(name), built(name)
    pose = own.forward(axes)
    assert len(own.slots) == 2 ** len(own.kinematics.branches)
    found = []
    for slot in own.slots:
        solution, status = own.inverse(pose, slot, axes)
        assert set(status) == {Status.OK}
        again = own.forward(solution)
        size = 1 + max(np.abs(pose[c]).max() for c in "xyz")
        assert max(np.abs(again[c] - pose[c]).max() for c in "xyz") <= 1e-11 * size
        assert max(np.abs(again[r] - pose[r]).max() for r in ENTRIES) <= 1e-9 or not own.kinematics.reads_rotation
        signs = own.signs(again)
        assert all(np.all(signs[s] == sign) for s, sign in slot.items())
        found.append(np.stack(list(solution.values())))
    assert all(np.abs(a - b).max(axis=0).min() > 1e-3 for a, b in combinations(found, 2))


@EVERY
def test_the_witness_finds_no_other_solution(name: str) -> None:
    """Multi-start root finding finds exactly as many solutions as there are slots."""
    evidence = witness(built(name).kinematics, INVENTIONS[name].mechanism)
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == len(built(name).slots)


@EVERY
def test_the_jacobian(name: str) -> None:
    """Against central differences of the formulas by hand; per radian."""
    axes, own = axes_of(name), built(name)
    matrices = own.jacobian(axes)
    rows = [row.replace(" z", "") for row in own.kinematics.rows]
    for column, joint in enumerate(own.kinematics.mechanism.joints):
        step = 1e-4
        unit = np.pi / 180 if joint.is_angle else 1.0
        ahead, behind = (by_hand(name, {**axes, joint.axis.name: axes[joint.axis.name] + d}) for d in (step, -step))
        for line, row in enumerate(rows):
            slope = (ahead[row] - behind[row]) / (2 * step * unit)
            assert np.abs(matrices[:, line, column] - slope).max() <= 1e-6 * (1 + np.abs(slope).max())


@EVERY
def test_the_margins_multiply_to_the_determinant(name: str) -> None:
    """The product of the margins is proportional to the determinant of the Jacobian."""
    axes, own = axes_of(name, seed=4), built(name)
    margins, _ = own.run(own.kinematics.singularity, axes)
    volume = np.abs(np.linalg.det(own.jacobian(axes)))
    expected = np.prod(
        [np.abs(margins[m.factor]) ** m.exponent for m in own.kinematics.margins] or [np.ones(COUNT)], axis=0
    )
    ratio = volume / expected
    assert np.ptp(ratio) <= 1e-9 * np.abs(ratio).max()
    assert all(np.abs(margins[m.name]).max() > 0.1 for m in own.kinematics.margins)


OFFERED = [n for n, i in INVENTIONS.items() if i.mechanism.offers_points]


@pytest.mark.parametrize("name", OFFERED)
@pytest.mark.parametrize("point", [(0.0, 0.0, 0.0), (13.0, -21.0, 7.0)], ids=["the flange", "a point beside it"])
def test_the_way_back_of_the_offset_interface(name: str, point: tuple[float, float, float]) -> None:
    """The inverse of a point beside the flange brings that point back to its position."""
    axes, own = axes_of(name), built(name)
    pose = own.forward(axes)
    offset = dict(zip(("point_x", "point_y", "point_z"), (np.full(COUNT, v) for v in point), strict=True))
    rotation = np.stack([pose[r] for r in ENTRIES], axis=-1).reshape(-1, 3, 3)
    target = np.stack([pose[c] for c in "xyz"], axis=-1) + rotation @ np.asarray(point)
    margins, status = own.run(own.kinematics.offset_configuration, {**axes, **offset})
    assert set(status) == {Status.OK}
    back, status = own.offset_inverse({**dict(zip("xyz", target.T, strict=True)), **offset}, own.signs(margins), axes)
    assert set(status) == {Status.OK}
    assert max(np.abs(back[a] - axes[a]).max() for a in axes) <= 1e-8


INPUTS = (0.0, 1e-300, -1e-12, 1e-6, 1.0, -300.0, 500.0, 1e6, 1e9, -1e9)


def everything(program: Program) -> Program:
    """The program with every value that it binds as an output."""
    return replace(program, outputs=tuple(Output(s.name.name, s.name) for s in program.body if isinstance(s, Let)))


@EVERY
@pytest.mark.parametrize(
    "kind", ["forward", "branch", "singularity", "jacobian", "offset_branch", "offset_configuration"]
)
def test_total(name: str, kind: str) -> None:
    """No input gives NaN or infinity, whatever the status: nothing that would stop a controller."""
    program = getattr(built(name).kinematics, kind)
    if program is None:
        assert kind.startswith("offset") and name not in OFFERED
        return
    generator = np.random.default_rng(9)
    free = [s.name for s in program.inputs if s.name not in built(name).constants]
    given = {n: generator.choice(INPUTS, 3000) for n in free}
    given |= {n: generator.choice([-1.0, 1.0], 3000) for n in free if n.startswith("sigma_")}
    values, _ = built(name).run(everything(program), given)
    for let, value in values.items():
        assert np.all(np.isfinite(value)), let


@EVERY
def test_the_commanded_turn(name: str) -> None:
    """Period n of every multi-turn axis, whatever the reference: the value lies in that turn."""
    axes, own = axes_of(name), built(name)
    pose = own.forward(axes)
    for joint in own.kinematics.period_joints:
        for number, first in ((1, -180.0), (3, 540.0), (-1, -540.0)):
            back, status = own.inverse(pose, own.signs(pose), axes, {joint.name: float(number)})
            assert set(status) == {Status.OK}
            value = back[joint.axis.name]
            assert np.all((value >= first - 1e-8) & (value < first + 360))
            again = own.forward(back)
            assert max(np.abs(again[c] - pose[c]).max() for c in "xyz") <= 1e-9 * (1 + np.abs(pose["z"]).max())


FAR = [n for n, i in INVENTIONS.items() if all(j.kind is not Kind.LINEAR for j in i.mechanism.joints)]


@pytest.mark.parametrize("name", FAR)
def test_out_of_reach(name: str) -> None:
    """A position far away is UNREACHABLE on every slot."""
    axes, own = axes_of(name), built(name)
    pose = {**own.forward(axes), "x": np.full(COUNT, 1e4)}
    for slot in own.slots:
        assert set(own.inverse(pose, slot, axes)[1]) == {Status.UNREACHABLE}
