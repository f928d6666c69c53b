"""Invented loops that turn their platforms: derived, measured by the witness, and executed in both languages."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning, assembly, on_plate
from derive.description.validate import validate
from derive.emit.language import Part
from derive.emit.python import package as python
from derive.emit.softmotion.library import StructuredTextFiles
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.report.self_test import self_test
from derive.witness import witness
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text
from tests.unit.kinematics.machine import Values, machine
from tests.unit.kinematics.turning_inventions import TURNING_INVENTIONS, three_rpr

pytestmark = pytest.mark.slow

NAMES = tuple(TURNING_INVENTIONS)
QUICK = tuple(n for n in NAMES if n != "six cranks with rods")
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


@pytest.mark.parametrize("name", QUICK)
def test_both_languages_answer_alike(name: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Structured Text and Python, there and back, in every slot: what the interpreter answers, and singular poses."""
    kinematics, pose = built(name), poses_of(name)
    own = machine(kinematics.mechanism)
    asked = [[float(pose[c][k]) for c in (*"xyz", *(f"r{i}{j}" for i in "123" for j in "123"))] for k in range(12)]
    controller = _block(kinematics)
    robot = json.loads(_python(kinematics, asked, tmp_path_factory.mktemp("package")))
    zero = {j.axis.name: np.zeros(COUNT) for j in kinematics.mechanism.joints}
    answers = 0
    for slot, signs in enumerate(own.slots):
        axes, status = own.inverse(pose, signs, zero)
        data = [1 + (slot >> k & 1) for k in range(len(kinematics.branches))] + [0] * len(kinematics.period_joints)
        for k, (row, found) in enumerate(zip(asked, (slots[slot] for slots in robot), strict=True)):
            expected = [float(v[k]) for v in axes.values()]
            place, rows = tuple(row[:3]), [row[3:6], row[6:9], row[9:12]]
            text, block = controller.inverse(place, rows, data, (0.0,) * len(expected))
            assert (text == OK) == (status[k] == Status.OK) == (found is not None)
            if found is None:
                continue
            answers += 1
            np.testing.assert_allclose(found["axes"], expected, atol=1e-9)
            np.testing.assert_allclose(block[: len(expected)], expected, atol=1e-9)
            text, back = controller.forward(tuple(expected))
            assert (text == OK) == (found["position"] is not None)
            if text == OK:
                np.testing.assert_allclose(back[0], found["position"], atol=1e-8)
                assert controller.is_singular(tuple(expected)) == found["singular"]
    assert answers >= 12


def _block(kinematics: Kinematics) -> Controller:
    name = kinematics.mechanism.block_name
    language = StructuredTextFiles(None)
    texts = language.files([language.part(kinematics)])
    text = next(v for k, v in texts.items() if k == f"{kinematics.mechanism.family}/{name}.st")
    controller = Controller(compiled_text(f"{name}.st", text), kinematics.mechanism)
    assert controller.initialise({p.name: p.nominal for p in kinematics.parameters}) == OK
    return controller


ASK = """
import json, sys, softkin
given, asked = json.loads(sys.stdin.read())
robot = next(iter(softkin.catalogue().values()))(**given)
rows = []
for a in asked:
    slots = []
    for s in robot.inverse_all((a[:3], [a[3:6], a[6:9], a[9:]]), [0.0] * len(robot.AXES)):
        if s.axes is None:
            slots.append(None)
            continue
        try:
            place = robot.forward(s.axes)[0].position
        except softkin.KinematicsError:
            place = None
        slots.append({"axes": s.axes, "position": place, "singular": bool(robot.singularity(s.axes).is_singular)})
    rows.append(slots)
print(json.dumps(rows))
"""


def _python(kinematics: Kinematics, asked: list[list[float]], folder: Path) -> str:
    part: Part = python.part(kinematics)
    for name, text in python.files([part]).items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    given = {p.name: p.nominal for p in kinematics.mechanism.parameters}
    done = subprocess.run(
        [sys.executable, "-c", ASK], input=json.dumps([given, asked]), cwd=folder, text=True, capture_output=True,
        env={"PYTHONPATH": str(folder)}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


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
