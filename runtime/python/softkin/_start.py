"""Mechanisms whose forward kinematics iterates: it may start at a given frame instead of the machine's home pose."""

from __future__ import annotations

from copy import copy
from typing import TYPE_CHECKING, Any, Self, TypeAlias

from softkin import _native
from softkin._core import EveryPose, Mechanism
from softkin._frame import Frame
from softkin._input import position_of, rotation_of
from softkin._scalar import reasonable
from softkin._types import Configuration, FrameLike, Matrix, Numbers, Reals, Rotation, Singularity, Status, Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from softkin._array import StartedPrograms
    from softkin._batch import Started

Starts: TypeAlias = "FrameLike | tuple[ArrayLike, ArrayLike] | None"
"""Positions (N, 3) and rotations (N, 3, 3), or frames (N, 4, 4), or one frame for all rows; None is the home pose."""


class IterativeForward(Mechanism):
    """A mechanism whose axes have several poses: forward kinematics finds the one of the machine's assembly mode.

    A call does not affect the next one: without a start every call begins at the home pose, which is a parameter. Every
    call that takes axes also takes a start: the frame that the axes have, or one nearby, as the previous one on a path.
    """

    __slots__ = ()

    def forward(self, axes: Numbers, start: FrameLike | None = None) -> tuple[Frame, Configuration]:
        """The frame at axis values, and their configuration. Axis limits are not tested.

        axes: one value for each axis. start: a frame nearby, as the previous one on a path; None is the home pose.
        Raises BAD_INPUT for invalid numbers, IMPOSSIBLE where no frame is found.
        """
        return super(IterativeForward, self._at("forward", start)).forward(axes)

    def orientation(self, axes: Numbers, start: FrameLike | None = None) -> Rotation:
        """The rotation of the frame at axis values, by rows. start: as in `forward`."""
        return super(IterativeForward, self._at("orientation", start)).orientation(axes)

    def jacobian(self, axes: Numbers, start: FrameLike | None = None) -> Matrix:
        """The Jacobian, as `Mechanism.jacobian`. start: the frame that the axes have, as in `forward`."""
        return super(IterativeForward, self._at("jacobian", start)).jacobian(axes)

    def singularity(self, axes: Numbers, start: FrameLike | None = None) -> Singularity:
        """The singularity margins, as `Mechanism.singularity`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("singularity", start)).singularity(axes)

    def twist(self, axes: Numbers, velocities: Numbers, start: FrameLike | None = None) -> Reals:
        """The velocity of the frame, as `Mechanism.twist`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("twist", start)).twist(axes, velocities)

    def axis_velocities(
        self,
        axes: Numbers,
        twist: Numbers,
        *,
        held: Numbers | None = None,
        damping: float = 0.0,
        length: float | None = None,
        start: FrameLike | None = None,
    ) -> Reals:
        """The velocities of all axes, as `Mechanism.axis_velocities`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("axis_velocities", start)).axis_velocities(
            axes, twist, held=held, damping=damping, length=length
        )

    def twist_rate(
        self, axes: Numbers, velocities: Numbers, accelerations: Numbers, start: FrameLike | None = None
    ) -> Reals:
        """The acceleration of the frame, as `Mechanism.twist_rate`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("twist_rate", start)).twist_rate(axes, velocities, accelerations)

    def axis_accelerations(
        self,
        axes: Numbers,
        velocities: Numbers,
        twist_rate: Numbers,
        *,
        held: Numbers | None = None,
        damping: float = 0.0,
        length: float | None = None,
        start: FrameLike | None = None,
    ) -> Reals:
        """The accelerations of all axes, as `Mechanism.axis_accelerations`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("axis_accelerations", start)).axis_accelerations(
            axes, velocities, twist_rate, held=held, damping=damping, length=length
        )

    def largest_feed(
        self,
        axes: Numbers,
        twist: Numbers,
        *,
        velocities: Numbers | None = None,
        accelerations: Numbers | None = None,
        twist_rate: Numbers | None = None,
        start: FrameLike | None = None,
    ) -> float:
        """The largest speed along a path, as `Mechanism.largest_feed`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("largest_feed", start)).largest_feed(
            axes, twist, velocities=velocities, accelerations=accelerations, twist_rate=twist_rate
        )

    def condition(self, axes: Numbers, length: float | None = None, start: FrameLike | None = None) -> float:
        """The condition number of the Jacobian, as `Mechanism.condition`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("condition", start)).condition(axes, length)

    def manipulability(self, axes: Numbers, length: float | None = None, start: FrameLike | None = None) -> float:
        """Yoshikawa's measure, as `Mechanism.manipulability`. start: as in `jacobian`."""
        return super(IterativeForward, self._at("manipulability", start)).manipulability(axes, length)

    def forward_batch(
        self, axes: ArrayLike, start: Starts = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int8], NDArray[np.uint8]]:
        """Forward kinematics of N rows, as `Mechanism.forward_batch`. start: one frame a row, or one for all."""
        from softkin import _batch

        return _batch.forward(self, self._programs_at(axes, start), axes)

    def jacobian_batch(self, axes: ArrayLike, start: Starts = None) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """The Jacobians of N rows, as `Mechanism.jacobian_batch`. start: one frame a row, or one for all."""
        from softkin import _differential

        return _differential.jacobian(self, self._programs_at(axes, start), axes)

    def singularity_batch(self, axes: ArrayLike, start: Starts = None) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """The singularities of N rows, as `Mechanism.singularity_batch`. start: one frame a row, or one for all."""
        from softkin import _differential

        return _differential.singularity(self, self._programs_at(axes, start), axes)

    def axis_velocities_batch(
        self, axes: ArrayLike, twists: ArrayLike, start: Starts = None
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """The velocities of N rows, as `Mechanism.axis_velocities_batch`. start: as in `jacobian_batch`."""
        from softkin import _accelerations

        return _accelerations.axis_velocities_batch(self, self._programs_at(axes, start), axes, twists)

    def axis_accelerations_batch(
        self, axes: ArrayLike, velocities: ArrayLike, twist_rates: ArrayLike, start: Starts = None
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """The accelerations of N rows, as `Mechanism.axis_accelerations_batch`. start: as in `jacobian_batch`."""
        from softkin import _accelerations

        programs = self._programs_at(axes, start)
        return _accelerations.axis_accelerations_batch(self, programs, axes, velocities, twist_rates)

    def largest_feed_batch(
        self,
        axes: ArrayLike,
        twists: ArrayLike,
        *,
        velocities: Numbers | None = None,
        accelerations: Numbers | None = None,
        twist_rates: ArrayLike | None = None,
        start: Starts = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """The largest speeds of N rows, as `Mechanism.largest_feed_batch`. start: as in `jacobian_batch`."""
        from softkin import _accelerations

        programs, limits = self._programs_at(axes, start), (velocities, accelerations)
        return _accelerations.largest_feed_batch(self, programs, axes, twists, twist_rates, limits)

    def _at(self, call: str, start: FrameLike | None) -> Self:
        """This machine, whose forward kinematics starts at a frame that a caller gives."""
        if start is None:
            return self
        position, rotation = position_of(start), self._used(call, rotation_of(start))
        if not reasonable(*position):
            self._fail(call, Status.BAD_INPUT, start=position)
        return self._started(position, rotation)

    def _every_pose(self, axes: Reals) -> EveryPose:
        from softkin import _assembly

        return _assembly.searched(self, axes)

    def _started(self, position: Vector, rotation: Rotation) -> Self:
        return self._with(with_start(self._constants, position, rotation))

    def _in_other_assembly(self) -> Self:
        """This machine in the other assembly mode. Its home pose is not one of that mode: it needs a start."""
        constants = copy(self._constants)
        constants.assembly_sign = -constants.assembly_sign
        return self._with(constants)

    def _with(self, constants: Any) -> Self:
        """This machine with other constants."""
        found = object.__new__(type(self))
        names = {name for cls in type(self).__mro__ for name in getattr(cls, "__slots__", ()) if hasattr(self, name)}
        known = {name: getattr(self, name) for name in names - {"__dict__", "__weakref__"}} | getattr(
            self, "__dict__", {}
        )
        known |= {"_constants": constants}
        known |= {"_machine": _native.machine_of(self, is_changed=True)} if self._is_native else {}
        for name, value in known.items():
            object.__setattr__(found, name, value)
        return found

    def _programs_at(self, axes: ArrayLike, start: Starts) -> StartedPrograms | Started:
        """The programs on arrays, from the starts that a caller gives."""
        from softkin import _batch

        programs = self._array_programs()
        return programs if start is None else _batch.started(self, programs, axes, start)

    _constants: Any

    if TYPE_CHECKING:

        def _array_programs(self) -> StartedPrograms: ...


def with_start(constants: Any, position: Any, rotation: Any) -> Any:
    """The constants of a machine with another start of forward kinematics: of plain numbers, or of columns."""
    found = copy(constants)
    for name, value in zip("xyz", position, strict=True):
        setattr(found, f"start_{name}", value)
    for number, row in enumerate(rotation, 1):
        for column, value in enumerate(row, 1):
            setattr(found, f"start_r{number}{column}", value)
    return found
