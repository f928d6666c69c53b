"""Invented loops that turn their platforms: derived, measured by the witness, and executed in both languages."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning, assembly, on_plate
from derive.description.validate import validate
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.report.self_test import self_test
from derive.witness import witness
from tests.unit.kinematics.machine import Values, machine
from tests.unit.kinematics.turning_inventions import TURNING_INVENTIONS, three_rpr

pytestmark = pytest.mark.slow

NAMES = tuple(TURNING_INVENTIONS)
EVERY = pytest.mark.parametrize("name", NAMES, ids=str)
COUNT = 60


def described(name: str) -> Mechanism:
    """With a name of its own, so that several are one package."""
    return replace(TURNING_INVENTIONS[name][0], name=f"Kin_Invented_{NAMES.index(name)}")


@cache
def built(name: str) -> Kinematics:
    """The programs, with what the witness found."""
    kinematics = machine(validate(described(name))).kinematics
    evidence = witness(kinematics, described(name))
    return replace(kinematics, evidence=evidence, self_test=self_test(kinematics))


def poses_of(name: str) -> Values:
    """Poses around home."""
    mechanism, rng = described(name), np.random.default_rng(6)
    given = {p.symbol: p.nominal for p in mechanism.parameters}
    home = [float(v.subs(given)) for v in mechanism.home]
    width = len(mechanism.task.position)
    away = rng.uniform(-1.0, 1.0, (COUNT, len(home))) * ([25.0] * width + [0.2] * (len(home) - width))
    pose: Values = {c: np.zeros(COUNT) for c in "xyz"}
    pose |= {c: home[k] + away[:, k] for k, c in enumerate(mechanism.task.position)}
    rotation = np.tile(np.eye(3), (COUNT, 1, 1))
    for axis, angle in zip((2,) if len(home) == width + 1 else (0, 1, 2), (home + away)[:, width:].T, strict=True):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        turn = np.tile(np.eye(3), (COUNT, 1, 1))
        turn[:, first, first] = turn[:, second, second] = np.cos(angle)
        turn[:, second, first], turn[:, first, second] = np.sin(angle), -np.sin(angle)
        rotation = turn @ rotation
    return pose | {f"r{i + 1}{j + 1}": rotation[:, i, j] for i in range(3) for j in range(3)}


@EVERY
def test_the_witness_finds_no_other_solution(name: str) -> None:
    evidence = built(name).evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.poses == 144 and evidence.inverted.solutions == TURNING_INVENTIONS[name][1]


@EVERY
def test_there_and_back(name: str) -> None:
    """Around home, in the branches of home: every pose that the inverse accepts is found from home."""
    own, pose = machine(validate(described(name))), poses_of(name)
    zero = {j.axis.name: np.zeros(COUNT) for j in own.kinematics.mechanism.joints}
    axes, status = own.inverse(pose, own.slots[0], zero)
    good = status == Status.OK
    assert good.mean() > 0.8
    again = own.forward({n: v[good] for n, v in axes.items()})
    for value in pose:
        assert np.abs(again[value] - pose[value][good]).max() < 1e-9
    assert all((again[f"branch_{b.name}"] > 0).all() for b in own.kinematics.branches)


def test_a_loop_that_is_not_described_as_needed_is_refused() -> None:
    """The sentence says what is missing."""
    own = three_rpr()
    on_a_slide = replace(own.rods[0], plate=on_plate(own.joints[0], 1.0))
    for wrong, words in (
        (replace(own, rods=own.rods[:2], joints=own.joints[:2], positive=own.positive[:2]), "only 2 joints"),
        (replace(own, offset_interface=True), "needs offset_interface=False"),
        (replace(own, task=Task("xy", Turning.DIRECTION)), "only 3 joints"),
        (replace(own, assembly=assembly("plate", own.joints[0], margin="x", one=1, two=-1)), "needs no assembly"),
        (replace(own, home=own.home[:2]), "needs a home pose of 3 coordinates, and has 2"),
        (replace(own, task=Task("xy", Turning.FULL)), "and there are only 3 joints"),
        (replace(own, rods=(on_a_slide, *own.rods[1:])), "which no joint moves on it"),
        (replace(own, closure=(own.joints[0].symbol - own.joints[1].symbol,)), "closure has 4 equations"),
    ):
        with pytest.raises(DescriptionError, match=words):
            machine(wrong)
