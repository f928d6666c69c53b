"""Inverse kinematics of a point that is fixed to the flange: the offset interface."""

from __future__ import annotations

from abc import abstractmethod

from softkin._core import Mechanism
from softkin._input import reals
from softkin._types import Configuration, ConfigurationLike, Diagnosis, Numbers, Reals, Signs, Status, Turns, Vector


class OffsetKinematics(Mechanism):
    """A mechanism for which one can command the position of a point beside its flange, without the orientation.

    Joints that the position does not determine stay at the reference. With a zero offset the result is that of
    `inverse`.
    """

    __slots__ = ()

    def inverse_offset(
        self,
        point: Numbers,
        offset: Numbers,
        configuration: ConfigurationLike | None = None,
        reference: Numbers | None = None,
    ) -> Reals:
        """The axis values that bring a point of the flange to a position.

        point: the position (3), in the frame of the machine. offset: the point (3), in the frame of the flange.
        configuration: as `configuration_offset` gives it, which may differ from that of `forward`.
        The reference and the errors are those of `inverse`.
        """
        place, arm, near = _vector(point, "point"), _vector(offset, "offset"), self._near(reference)
        branches, turns = self._read(configuration)
        axes = self._choose(lambda signs: self._offset_branch(place, arm, signs, turns, near), branches, near)
        if isinstance(axes, Diagnosis):
            self._fail("inverse_offset", axes, point=place, offset=arm, reference=near)
        return self._limited("inverse_offset", axes)

    def configuration_offset(self, axes: Numbers, offset: Numbers) -> Configuration:
        """The configuration with which `inverse_offset` finds these axis values again, for the same offset."""
        values, arm = reals(axes, len(self.AXES), "axes"), _vector(offset, "offset")
        margins = self._offset_margins(values, arm)
        if isinstance(margins, Status):
            self._fail("configuration_offset", margins, axes=values, offset=arm)
        return self._written(margins, values)

    @abstractmethod
    def _offset_branch(
        self, point: Vector, offset: Vector, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis: ...

    @abstractmethod
    def _offset_margins(self, axes: Reals, offset: Vector) -> Reals | Status: ...


def _vector(values: Numbers, what: str) -> Vector:
    x, y, z = reals(values, 3, what)
    return x, y, z
