"""One machine as it is called in either language: what it answers, and why it refuses."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.turns.axes import Axes, robot_of
from tests.text.controller import OK, UNREACHABLE, Controller
from tests.text.units import compiled

Bytes = tuple[int, ...]
Reason = tuple[str, float, int]
"""The text, how much is missing, and the number of a turn that is inside."""


@dataclass(frozen=True)
class Asked:
    """The arguments of a call."""

    frame: Frame
    configuration: Bytes
    reference: Axes


class Caller(Protocol):
    """A machine."""

    def forward(self, axes: Axes) -> tuple[Frame, Bytes]:
        """The frame, and its configuration."""
        ...

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes; None where it is out of reach or beyond a limit."""
        ...

    def why(self, asked: Asked) -> Reason:
        """Why it refuses."""
        ...

    def check_alike(self) -> None:
        """Ask once more what was asked, in the other ways that there are."""


class InPython:
    """The Python class."""

    def __init__(self, mechanism: Mechanism, given: Mapping[str, float]) -> None:
        self.robot = robot_of(mechanism, given)
        self.answers: list[tuple[Asked, Axes | None]] = []
        self.forward = cache(self.robot.forward)  # the same pose is asked for with many references

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes, by a call that says the same of the turn as `diagnose` does."""
        found = None
        try:
            found = self.robot.inverse(asked.frame, asked.configuration, asked.reference)
        except KinematicsError as error:
            assert error.status is Status.UNREACHABLE
            _, _, turn = self.why(asked)
            assert self.robot.diagnose(asked.frame, asked.configuration, asked.reference).in_words in str(error)
            assert (f"which is turn {turn}" in str(error)) == (turn != 0)
        self.answers.append((asked, found))
        return found

    def why(self, asked: Asked) -> Reason:
        """What `diagnose` says."""
        status, reason, missing, turn, _ = self.robot.diagnose(asked.frame, asked.configuration, asked.reference)
        assert status is Status.UNREACHABLE
        return reason, missing, turn

    def check_alike(self) -> None:
        """As one batch, and by the slots where turns are open."""
        asked, answers = zip(*self.answers, strict=True)
        positions, rotations = (np.array(part) for part in zip(*(one.frame for one in asked), strict=True))
        configurations, references = np.array([a.configuration for a in asked]), np.array([a.reference for a in asked])
        axes, statuses = self.robot.inverse_batch(positions, rotations, configurations, references)
        wanted = np.array([a or (np.nan,) * axes.shape[1] for a in answers])
        is_refused = np.isnan(wanted[:, 0])
        assert (np.isnan(axes) == np.isnan(wanted)).all()
        assert (statuses == np.where(is_refused, Status.UNREACHABLE, Status.OK)).all()
        assert np.abs(axes - wanted)[~is_refused].max(initial=0.0) < 1e-9
        branches = self.robot.BRANCHES
        is_open = ~configurations[:, branches:].any(axis=1)
        slots, outcomes = self.robot.inverse_all_batch(positions[is_open], rotations[is_open], references[is_open])
        own = ((configurations[is_open, :branches] - 1) * 2 ** np.arange(branches)).sum(axis=1)
        assert (outcomes[range(len(own)), own] == statuses[is_open]).all()
        assert np.nanmax(np.abs(slots[range(len(own)), own] - axes[is_open]), initial=0.0) < 1e-9
        scalar = self.robot.inverse_all(asked[0].frame, asked[0].reference)[own[0]]
        assert scalar.status == statuses[0]
        assert (scalar.axes is None) == bool(is_refused[0])


class OnController:
    """The function block, executed; frames are made in Python."""

    def __init__(self, mechanism: Mechanism, given: Mapping[str, float]) -> None:
        self.robot = robot_of(mechanism, given)
        self.controller = Controller(compiled(mechanism), mechanism)
        assert self.controller.initialise(self.robot.parameters) == OK

    def forward(self, axes: Axes) -> tuple[Frame, Bytes]:
        """The frame, and its configuration."""
        return self.robot.forward(axes)

    def inverse(self, asked: Asked) -> Axes | None:
        """The axes."""
        status, found = self.controller.inverse(*asked.frame, asked.configuration, asked.reference)
        assert status in (OK, UNREACHABLE)
        return None if found is None else tuple(found[: len(asked.reference)])

    def why(self, asked: Asked) -> Reason:
        """What Diagnose says."""
        return self.controller.explain(*asked.frame, asked.configuration, asked.reference)[:3]

    def check_alike(self) -> None:
        """There is one way."""
