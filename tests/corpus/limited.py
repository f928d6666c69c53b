"""Limits of a SCARA on several turns: what is asked in a language other than Python, and what Python says to that."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pytest
import softkin

from tests.corpus.dimensions import DIMENSIONS

NAME = "Kin_Scara4_ZCcoupled_Type1"
LIMITS: list[dict[str, Any]] = [
    {"A1": [-170.0, 170.0]}, {"A1": [None, 90.0]}, {"A1": [-90.0, None], "A3": [None, None]}, {"A2": None},
    {"A4": [None, 300.0]}, {"A4": [200.0, 700.0]}, {"A1": [-350.0, -300.0], "A3": [-50.0, 50.0]},
]  # fmt: skip
TURNS = ([1, 0, 0, 0], [0, 0, 0, 0], [2, 2, 1, -1])


@dataclass(frozen=True)
class Limited:
    """The machine with limits, and what is asked of it: frame, configuration, reference."""

    robot: softkin.Mechanism
    asked: Sequence[tuple[softkin.Frame, list[int], tuple[float, ...]]]

    @property
    def calls(self) -> list[Any]:
        return [["inverse", {"position": f.position, "rotation": f.rotation}, c, axes] for f, c, axes in self.asked]

    def confirm(self, answers: Sequence[Mapping[str, Any]]) -> int:
        """Every solution is that of Python, and so is every refusal; how many are refused."""
        refused = 0
        for (frame, given, axes), found in zip(self.asked, answers, strict=True):
            why = self.robot.diagnose(frame, given, axes)
            assert found["status"] == int(why.status)
            if why.status is softkin.Status.OK:
                assert found["axes"] == pytest.approx(self.robot.inverse(frame, given, axes), abs=1e-9)
            else:
                refused += 1
                assert f"{found['reason']} [{found['unit']}]" == why.reason and found["turn"] == why.turn
                assert found["missing"] == pytest.approx(why.missing, abs=1e-9)
        return refused


def limited(limits: Mapping[str, Any]) -> Limited:
    """Poses on several turns, each with open and with commanded turns."""
    robot = softkin.catalogue()[NAME](**DIMENSIONS[NAME], limits=limits)
    poses = [(20.0 + 37.0 * k, 40.0 - 61.0 * k, 7.0 * k, 113.0 * k) for k in range(-8, 9)]
    return Limited(robot, [(robot.forward(axes)[0], given, axes) for axes in poses for given in TURNS])
