"""Orientation kinematics, which can be coupled with a position kinematics."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeAlias

from softkin._constants import HELD
from softkin._core import Mechanism
from softkin._rotation import made_rotation
from softkin._types import Diagnosis, OrientationImage, Rotation, Status, Vector
from softkin._vectors import transposed, turned

if TYPE_CHECKING:
    from softkin._array import OrientationPrograms

SAME_AXIS = HELD
"""Two axes are the same where the sine of the angle between them is at most this."""
_ZERO: Vector = (0.0, 0.0, 0.0)

TotalImage: TypeAlias = tuple[Rotation, Vector, Vector, float]
"""An image, and the sine of the angle between the axis of the flange and that of the tool."""


class OrientationKinematics(Mechanism):
    """A mechanism that turns the tool on the flange of another mechanism: see `Coupled`.

    Alone, its frames are relative to the flange, and the inverse follows the rotation of a frame and not its position.
    """

    __slots__ = ()

    def is_compatible(self, image: OrientationImage) -> bool:
        """Whether a coupling with a flange of these orientations is possible: a frame must determine the axes."""
        flange_axis, _ = turning_axis(image)
        return image.freedom == "zero" or self._compatible(flange_axis) is Status.OK

    def image_on(self, image: OrientationImage) -> OrientationImage:
        """The orientations that the tool can have on a flange with these orientations."""
        flange_axis, base_axis = turning_axis(image)
        given = image.rotation
        if self.FREEDOM != "three":  # else all orientations, on any flange
            made = made_rotation(given)
            if isinstance(made, Diagnosis):
                self._refuse_rotation("image_on", made, given)
            given = made
        total = self._total_image(given, flange_axis, base_axis)
        if isinstance(total, Status):
            self._fail("image_on", total, flange_axis=flange_axis, base_axis=base_axis)
        rotation, base, flange, apart = total
        freedom = "three"
        if self.FREEDOM == "zero":
            freedom = image.freedom
        elif self.FREEDOM == "one" and (image.freedom == "zero" or (image.freedom == "one" and apart <= SAME_AXIS)):
            freedom = "one"
        if freedom != "one":
            base, flange = image.base_axis, image.flange_axis
        if freedom == "zero" and rotation != given:  # a tool without an axis that is turned against the flange
            flange = turned(transposed(rotation), base)
        return OrientationImage(freedom, rotation, base, flange)

    def _total_image(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> TotalImage | Status:
        """The image of a mechanism that turns about several axes: all orientations, on any flange."""
        return rotation, base_axis, flange_axis, 1.0

    @abstractmethod
    def _compatible(self, flange_axis: Vector) -> Status: ...

    @abstractmethod
    def _end_point_shift(self, rotation: Rotation, flange_axis: Vector, base_axis: Vector) -> Vector | Status: ...

    @abstractmethod
    def _array_programs(self) -> OrientationPrograms: ...


def turning_axis(image: OrientationImage) -> tuple[Vector, Vector]:
    """The axis about which a flange turns, in the frames of flange and machine; zero if there is none."""
    return (image.flange_axis, image.base_axis) if image.freedom == "one" else (_ZERO, _ZERO)
