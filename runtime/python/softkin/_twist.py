"""Mechanisms that follow the turn of the commanded rotation about one axis, and ignore the rest of it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable

from softkin._core import TURN, Mechanism
from softkin._input import rotation_by_rows
from softkin._types import Numbers, Rotation, Status


class TwistChoice(Mechanism):
    """A mechanism whose flange turns about one axis."""

    __slots__ = ()

    def project(self, rotation: Iterable[Numbers]) -> Rotation:
        """Of the rotations that the flange can have, the one nearest to a commanded rotation, by rows; the direction of
        the tool comes first.
        """
        rows = self._used("project", rotation_by_rows(rotation))
        nearest = self._projection(rows)
        if isinstance(nearest, Status):
            self._fail("project", nearest, rotation=rows)
        return nearest

    def _follows(self) -> str:
        return TURN

    def _nearest_flange(self, rotation: Rotation) -> Rotation | Status:
        return self._projection(rotation)

    @abstractmethod
    def _projection(self, rotation: Rotation) -> Rotation | Status: ...
