"""What a machine of a user's own is asked in a language other than Python, and what its answers are held against."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from tests.catalogue.refusals import status_of
from tests.languages.language import LANGUAGES, Language
from tests.machines.made import Array, Made, made
from tests.machines.odd_names import ODD
from tests.text.controller import OK

Answer = dict[str, Any]
Forward = Callable[[Mechanism, Sequence[list[float]]], tuple[list[str], list[Answer]]]
"""A mechanism and axis values → the names of its parameters, and forward kinematics with nominal dimensions."""
HELD = "seven axes beside each other, the first held"
BASE = "palletizer with both motors at the base"


EVERY_OTHER = pytest.mark.parametrize("language", (None, *LANGUAGES), ids=lambda one: str(one or "ST"))
"""The languages that answer as Python does: None is Structured Text, whose block a controller calls."""


@dataclass(frozen=True)
class Spoken:
    """A machine, poses that it has, and the calls that ask for all solutions there."""

    machine: Made
    poses: Sequence[tuple[tuple[float, ...], softkin.Frame]]
    calls: Sequence[list[Any]]

    @property
    def asked(self) -> list[Answer]:
        """The machine with its calls."""
        return [{"parameters": dict(self.machine.robot.parameters), "calls": list(self.calls)}]

    def confirm(self, answer: Answer) -> None:
        """Every slot is that of Python."""
        robot = self.machine.robot
        assert answer["made"] == {"status": 0}
        for (axes, frame), found in zip(self.poses, answer["found"], strict=True):
            expected = robot.inverse_all(frame, axes)
            assert [int(s.status) for s in expected] == [s["status"] for s in found["slots"]]
            for one, other in zip(expected, found["slots"], strict=True):
                if one.axes is not None:
                    least = min((1.0, *map(abs, robot.singularity(one.axes).margins.values())))
                    assert other["axes"] == pytest.approx(one.axes, abs=1e-12 * 1e3 / max(least, 1e-6))


@cache
def spoken(name: str) -> Spoken:
    """Random poses of a machine."""
    machine = made(name)
    robot, count = machine.robot, len(machine.robot.AXES)
    spread = np.random.default_rng(5).uniform(-1.0, 1.0, (60, count)) * np.where(machine.closure.angles, 90.0, 0.3)
    rows = map(tuple, machine.axes(spread).tolist())
    poses = [(axes, robot.forward(axes)[0]) for axes in rows if status_of(robot.forward, axes) is softkin.Status.OK]
    assert len(poses) > 10
    calls = [["inverseAll", {"position": f.position, "rotation": f.rotation}, axes] for axes, f in poses]
    return Spoken(machine, poses, calls)


def confirm_natural_names(name: str, forward: Forward, words: Mapping[str, str]) -> None:
    """A machine with odd names moves as its twin. words: of the language, by the name in the description."""
    axes = [[10.0 * k, 20.0 - 7.0 * k, 5.0 + 3.0 * k, 4.0 * k] for k in range(6)]
    (names, odd), (_, twin) = (forward(validate(m), axes) for m in (ODD[name].mechanism(), ODD[name].twin()))
    assert [answer["status"] for answer in odd] == [answer["status"] for answer in twin]
    for one, other in zip(odd, twin, strict=True):
        if one["status"] == 0:
            assert one["frame"]["position"] == pytest.approx(other["frame"]["position"], rel=1e-12, abs=1e-9)
    assert odd[0]["status"] == 0
    stated = [p.given_name for p in ODD[name].mechanism().parameters]
    assert names[: len(stated)] == [words.get(n) or ODD[name].python.get(n, n) for n in stated]


def answered(language: Language | None, machine: Made, robot: softkin.Mechanism, axes: Array, near: Array) -> Array:
    """Axes that the inverse answers in a language, none of them refused, at the poses of other axes of a robot of the
    kind of a machine. near: references.
    """
    asked = [(*robot.forward(row), reference) for row, reference in zip(axes.tolist(), near.tolist(), strict=True)]
    if language is None:
        block = machine.controller()
        assert block.initialise(robot.parameters) == OK
        answers = [block.inverse(f.position, f.rotation, c, reference) for f, c, reference in asked]
    else:
        calls = [["inverse", {"position": f.position, "rotation": f.rotation}, c, near] for f, c, near in asked]
        given = {"parameters": dict(robot.parameters), "calls": calls}
        (told,) = language.ask(language.of(machine.mechanism), [given])
        answers = [(one["status"] or OK, one.get("axes")) for one in told["found"]]
    assert [row for row, (status, _) in zip(axes.tolist(), answers, strict=True) if status != OK] == []
    return np.array([found[: axes.shape[1]] for _, found in answers])
