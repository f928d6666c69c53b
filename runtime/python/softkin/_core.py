"""The calls that all mechanisms share, around the programs of each mechanism."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import inf, isfinite, nan
from os import PathLike
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Protocol, Self, TypeAlias, cast

from softkin import _native
from softkin._configuration import (
    AUTOMATIC,
    FIRST_TURN,
    SECOND_TURN,
    Criterion,
    Slot,
    branch_byte,
    period,
    slots,
    squared_distance,
)
from softkin._constants import GEARED_TURN, LARGEST, LIMIT, NO_MEANING, ONE_TURN, SINGULAR, TIE
from softkin._ends import given_ends, limit_names
from softkin._frame import Frame
from softkin._input import bytes_of, parameter_value, pose_of, position_of, reals, unusable
from softkin._rotation import in_words, made_rotation
from softkin._scalar import reasonable
from softkin._solutions import Solutions
from softkin._types import (
    Axis,
    Configuration,
    ConfigurationByte,
    ConfigurationLike,
    Diagnosis,
    FrameLike,
    KinematicsError,
    Matrix,
    Numbers,
    OrientationImage,
    Parameter,
    PlainFrame,
    Reals,
    Rotation,
    Signs,
    Singularity,
    Solution,
    Status,
    Turns,
    Vector,
)
from softkin._value import Value
from softkin._vectors import turn_between

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from softkin._array import Programs
    from softkin._assembly import ForwardSolution
    from softkin._chain import Link
    from softkin._mounted import Mounted
    from softkin._names import NamedConfiguration
    from softkin._nearest import Measure
    from softkin._path import Path
    from softkin._timed import Timed
    from softkin._view import View

WARNING_DISTANCE = SINGULAR
"""A pose of a coupling, which has no parameters, is singular where a margin is smaller than this in size."""

TWIST = ("x", "y", "z", "turn x", "turn y", "turn z")
"""The rows of a twist: along and about the axes of the machine."""
FIXED, WHOLE, TURN, DIRECTION, PITCH = "fixed", "whole", "turn", "direction", "pitch"
ONE_AXIS, SEVERAL_AXES = "one axis", "several axes"
"""The rotation of the flange: it is constant; or it follows the whole commanded rotation, the turn about one axis, the
direction of the tool, or its pitch, which depends on the position; or the position alone turns the flange, about one
axis or several."""
_IDENTITY: Rotation = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

_STATUSES = tuple(Status)

Pose: TypeAlias = tuple[Vector, Rotation, Reals]
EveryPose: TypeAlias = tuple[tuple[Pose, bool], ...]
"""All poses at axis values, the one of `forward` first, each with whether it is of the other assembly mode."""
Image: TypeAlias = tuple[Rotation, Vector, Vector]
_OneBranch: TypeAlias = Callable[[Signs], Reals | Diagnosis]
"""The axes by the signs of the branches."""


NOTHING = (None,) * len(_STATUSES)
"""None for each status."""
_NUMBERS = tuple(map(int, _STATUSES))


class Window(NamedTuple):
    """The range of an axis: it is unlimited where limits are not tested."""

    lowest: float
    """The lower limit with its tolerance."""
    highest: float
    single: bool
    """Whether the limits leave one value for every direction at most, with a gap that no step crosses."""
    middle: float
    """The middle of the range."""


class Branches(Protocol):
    """`Mechanism.branches` of one machine."""

    def __call__(
        self, frame: PlainFrame, reference: Reals | None = None, refused: Sequence[Any] = NOTHING
    ) -> tuple[Any, ...]:
        """refused: the value in a slot that has no axes, by the number of its status."""


class Branch(Protocol):
    """`Mechanism.branch` of one machine."""

    def __call__(self, frame: PlainFrame, signs: Signs, reference: Reals | None = None) -> Reals | None: ...


Finish: TypeAlias = Callable[[tuple[Reals | int, ...], Reals], tuple[Reals | int, ...]]
"""Slots as `Branches` gives them, and the reference → slots with the axes on their turns and inside their limits, or
with the number of a status."""


class Unrolled(NamedTuple):
    """The functions of a machine whose inverse solves all branches in one straight-line program."""

    branches: Branches
    branch: Branch
    finish: Finish | None


class Mechanism(Value, ABC):
    """Forward and inverse kinematics of a mechanism.

    Positions are in the user's length unit, axis values in that unit or in degrees, the Jacobian per radian.
    A call without an answer raises `KinematicsError`. Instances never change: one may serve several threads. Instances
    with equal class and parameters are equal, and every parameter is an attribute.
    """

    __slots__ = ("_machine", "checks_limits", "parameters")

    NAME: str
    """The name of the function block and of the entry in `catalogue()`."""
    KEY = ""
    """The digest that the class and its machine in C have in common; empty if there is no C."""
    AXES: tuple[Axis, ...]
    PARAMETERS: tuple[Parameter, ...]
    CONFIGURATION: tuple[ConfigurationByte, ...]
    DEFAULT_CONFIGURATION: Configuration
    JACOBIAN_ROWS: tuple[str, ...]
    """The rows of the Jacobian: motion along `x`, `y`, `z`; rotation about the axes of the machine: `turn x`, `turn y`,
    `turn z`; rotation about the axes of the tool: `tilt x`, `tilt y`."""
    MARGINS: tuple[str, ...]
    """The names of the singularity margins."""
    READS_ROTATION: bool
    """Whether the inverse reads the commanded rotation."""
    FREEDOM: str
    """The number of degrees of freedom of the rotation of the frame: `zero`, `one` or `three`."""
    ROLE: str
    """`position` (it can carry an orientation kinematics), `orientation` (a position kinematics carries it), or
    `complete`."""
    BRANCHES: int
    """The number of branch bytes in the configuration; they come first."""
    PERIOD_AXES: tuple[int, ...]
    """The indices of the axes that have period bytes."""
    HELD: tuple[int, ...] = ()
    SURPLUS: tuple[int, ...] = ()
    """The indices of the axes that the inverse leaves where the reference has them."""
    LINES: tuple[tuple[int, int, str], ...] = ()
    """What is drawn of a closed loop: lines by the numbers of two points of `_points`, -1 is the tool, and the axes."""
    ASSEMBLY: str = ""
    """The parameter that names the assembly mode of a closed loop which closes in two ways."""
    DISTANCE_AXES: tuple[int, ...]
    """The indices of the axes that decide an automatic choice."""

    parameters: Mapping[str, float]
    """The parameters as given: flags are bool, directions int; the end of a one-sided limit is infinite."""
    checks_limits: bool
    """Whether the inverse tests the limits."""

    _is_native = False
    """Whether the native core answers the calls of the class."""
    _machine: Any
    """The machine in C, where the native core answers."""

    def __init_subclass__(cls, **options: Any) -> None:
        """If the native core has the machine of a class, it answers the calls of the class."""
        super().__init_subclass__(**options)
        if "KEY" in vars(cls):
            cls._is_native = _native.take_over(cls)

    def _seal(self) -> None:
        """Complete the machine: no attribute may be set from now on."""
        if self._is_native:
            self._machine = _native.machine_of(self)
        super()._seal()

    if TYPE_CHECKING:  # each class names its own parameters

        def __init__(self, **parameters: Any) -> None: ...

    def _accept(self, given: Mapping[str, Any]) -> None:
        """Store the parameters, each in its type; raises NOT_INITIALIZED for the first one that is not allowed.

        given: the parameters by name, among other values; `limits` is a mapping of limits, or None.
        """
        found = {p.name: parameter_value(self.NAME, p, given[p.name]) for p in self.PARAMETERS}
        limits = (
            {}
            if given.get("limits") is None
            else given_ends(self.NAME, limit_names(self.LIMIT_KEYS, self.AXES), self.PARAMETERS, given["limits"])
        )
        self.parameters = MappingProxyType(found | limits)
        self.checks_limits = bool(found["check_limits"])
        for parameter in self.PARAMETERS:
            if not parameter.allows(found[parameter.name]):
                raise self._refusal(parameter.meaning, parameter.name)
            if parameter.name in limits and found[parameter.name] != parameter.default:
                raise self._refusal("limits are given once: as a mapping, or each by itself", parameter.name)

    def _window(self, key: str, otherwise: tuple[float, float] | None = None, turns: float | None = None) -> Window:
        """The range of an axis or of another quantity, by the last part of the names of its limits.

        otherwise: the range if no limits are given; None stands for an unlimited one. turns: with a gear, those of
        the joint per turn of the axis.
        Raises NOT_INITIALIZED for a lower limit that is not below the upper one.
        """
        lower, upper = self.parameters[f"lower_{key}"], self.parameters[f"upper_{key}"]
        is_given = abs(lower) + abs(upper) > 0.0
        if is_given and not lower < upper:
            raise self._refusal(f"lower_{key} below upper_{key}, or both 0", f"lower_{key}", f"upper_{key}")
        low, high = (lower, upper) if is_given or otherwise is None else otherwise
        if not (isfinite(low) and isfinite(high)):
            return self._one_sided_window(key, low, high, otherwise)
        tolerance = LIMIT + LIMIT * abs(low) + LIMIT * abs(high)
        middle = 0.5 * low + 0.5 * high
        has_limits = is_given or otherwise is not None
        single = has_limits and high - low <= ONE_TURN + tolerance
        if turns is not None:
            single = has_limits and (high - low + 2.0 * tolerance) * turns <= GEARED_TURN
        if not (has_limits and self.checks_limits):
            return Window(-LARGEST, LARGEST, single, middle)
        return Window(low - tolerance, high + tolerance, single, middle)

    def _one_sided_window(self, key: str, low: float, high: float, otherwise: tuple[float, float] | None) -> Window:
        """The range of an axis with one limited end; if the axis always has limits, these are the other end."""
        tolerance = LIMIT + sum([LIMIT * abs(end) for end in (low, high) if isfinite(end)])
        if otherwise is not None:
            low, high = max(low, otherwise[0]), min(high, otherwise[1])
            if not low < high:
                raise self._refusal(f"lower_{key} below upper_{key}", f"lower_{key}", f"upper_{key}")
        if not self.checks_limits:
            low, high = -inf, inf
        lowest = low - tolerance if isfinite(low) else -LARGEST
        return Window(lowest, high + tolerance if isfinite(high) else LARGEST, False, 0.0)

    def _refusal(self, condition: str, *names: str) -> KinematicsError:
        """The error for the named parameters, which violate a condition; the condition on a single one is its range."""
        if not names:
            return KinematicsError(Status.NOT_INITIALIZED, f"{self.NAME}: the parameters must give {condition}")
        found = ", ".join(f"{name} = {self.parameters[name]!r}" for name in names)
        needed = condition  # a sentence
        if len(names) == 1:
            (parameter,) = (p for p in self.PARAMETERS if p.name in names)
            needed = f"it must be {parameter.range} ({condition})"
        return KinematicsError(Status.NOT_INITIALIZED, f"{self.NAME}: {found} is not allowed: {needed}")

    def forward(self, axes: Numbers) -> tuple[Frame, Configuration]:
        """The frame at axis values, and their configuration. Axis limits are not tested.

        axes: one value for each axis, in degrees or the user's length unit.
        Raises BAD_INPUT for values that are no such numbers, IMPOSSIBLE where the mechanism cannot be assembled.
        """
        values = reals(axes, len(self.AXES), "axes")
        pose = self._forward(values)
        if isinstance(pose, Status):
            self._missed(values, pose)
            self._fail("forward", pose, axes=values)
        position, rows, margins = pose
        return Frame(position, rows), self._written(margins, values)

    def forward_all(self, axes: Numbers) -> tuple[ForwardSolution, ...]:
        """All poses at axis values, the one of `forward` first: frame, configuration, and whether it is of the other
        assembly mode. Axis limits are not tested. Where there is no pose the result is empty.

        A chain has one pose: a loop inside it closes on the side that its description states. A closed loop that closes
        in two ways (`ASSEMBLY`) has up to two, both in closed form: these are all. A platform whose forward kinematics
        iterates is searched in both modes: Newton's method from 1,000 starts, spread evenly over places and rotations,
        and from a thousand more until it came to each pose four times, 20,000 at most. The same axes give the same
        result; it is no proof that there are no more poses. Those that differ by less than 1e-5 of the size of the
        machine, and of the entries of a rotation, are one.
        axes: one value for each axis, in degrees or the user's length unit. Raises BAD_INPUT for values that are no
        such numbers.
        """
        from softkin import _assembly

        values = reals(axes, len(self.AXES), "axes")
        if not reasonable(*values):
            self._fail("forward_all", Status.BAD_INPUT, axes=values)
        return _assembly.forward_all(self, values)

    def misses(self, axes: Numbers) -> dict[str, float]:
        """What each surplus rod is too short for the pose that the other axes give, by the name of its axis.

        axes: one value for each axis. `forward` refuses a miss larger than `max_miss` (0: a thousandth of the length).
        Empty for a machine without `SURPLUS` axes. Raises the other errors of `forward`.
        """
        values = reals(axes, len(self.AXES), "axes")
        if not self.SURPLUS:
            return {}
        most = next(p.high for p in self.PARAMETERS if p.name == "max_miss")
        loose = type(self)(**{**self.parameters, "max_miss": most})
        pose = loose._forward(values)
        if isinstance(pose, Status):
            self._fail("misses", pose, axes=values)
        position, rows, margins = pose
        signs = tuple(-1 if margin < 0.0 else 1 for margin in margins)
        fitting = loose._branch(position, rows, signs, (0,) * len(self.PERIOD_AXES), values)
        if isinstance(fitting, Diagnosis):
            self._fail("misses", fitting, position=position, rotation=rows, reference=values)
        return {self.AXES[i].name: fitting[i] - values[i] for i in self.SURPLUS}

    def orientation(self, axes: Numbers) -> Rotation:
        """The rotation of the frame at axis values, by rows."""
        values = reals(axes, len(self.AXES), "axes")
        rows = self._orientation(values)
        if isinstance(rows, Status):
            self._fail("orientation", rows, axes=values)
        return rows

    def inverse(
        self, frame: FrameLike, configuration: ConfigurationLike | None = None, reference: Numbers | None = None
    ) -> Reals:
        """The axis values that reach a frame.

        frame: position (3) and rotation (3 rows of 3), a `Frame` or any pair of sequences, or a matrix (4, 4). A
        rotation with few exact digits, as from single precision, is repaired: the direction of z is kept. No entry of
        R^T R - I may be beyond 0.0001.
        configuration: see `CONFIGURATION`; bytes, or names as in `{"elbow": "left"}`; None stands for
        `DEFAULT_CONFIGURATION`. If it leaves a branch open, the
        solution nearest to the reference is taken. If it leaves a period open, an axis whose limits are at most
        350 degrees apart takes its one value inside them; any other axis takes the value nearest to the
        reference. Limits then refuse, and never choose another turn: for a move from point to point name the period of
        an axis with a wider range.
        reference: one value for each axis, usually the present axis values; None stands for zeros. The axes of `HELD`
        keep these values: a machine that has some needs a reference.
        Raises BAD_INPUT, UNREACHABLE (out of reach, or beyond a limit), or IMPOSSIBLE. The `refusal` of the error is
        what `diagnose` returns: which quantity, how much is missing, and whether another turn is inside.
        """
        position, rows = self._pose(frame)
        near = self._near(reference)
        branches, turns = self._read(configuration)
        rotation = self._used("inverse", rows)
        axes = self._choose(lambda signs: self._branch(position, rotation, signs, turns, near), branches, near)
        if isinstance(axes, Diagnosis):
            self._fail("inverse", axes, position=position, rotation=rows, reference=near)
        return self._limited("inverse", axes)

    def inverse_all(self, frame: FrameLike, reference: Numbers | None = None) -> Sequence[Solution]:
        """Every branch of the inverse, in fixed slots: branch 1 before branch 2, the first byte varies fastest.

        Periods are open, as in `inverse`. No slot is left out: a slot without axes has a status, and a `refusal` with
        the reason, such as the axis that is beyond a limit, by how much, and whether another turn is inside. Raises
        BAD_INPUT only for input that does not have the form of a frame. The result behaves as a tuple.
        """
        position, rows = self._pose(frame)
        near, rotation = self._near(reference), self._made(rows)
        every = slots((AUTOMATIC,) * self.BRANCHES)
        if isinstance(rotation, Diagnosis):
            return Solutions((rotation,) * len(every), every, self._solution)
        explained = partial(self._explained, position, rotation, near)
        return Solutions(self._every_branch(position, rotation, near), every, explained)

    def tilted_plane(self, plane: FrameLike, reference: Numbers) -> tuple[Solution, ...]:
        """The axis values at which the tool of a five-axis machine is along the normal of a plane, in the slots of
        `inverse_all`: what G53.1 turns to after G68.2.

        plane: a frame in the coordinates of the workpiece, whose z axis is the normal; its position is not used.
        reference: the present axis values. Sliding axes keep them, and so the tip of the tool moves; a turning axis
        takes the turn that `inverse` takes, and one that the plane leaves free (tool along the last one) stays. A slot
        beyond a limit has the reason. Raises BAD_INPUT for what is no frame or reference, IMPOSSIBLE for a
        machine whose task is no direction, or whose sliding axes turn the tool.
        """
        from softkin._tilted import tilted_plane

        return tilted_plane(self, plane, reference)

    def branches(self, frame: PlainFrame, reference: Reals | None = None) -> tuple[Reals | None, ...]:
        """Every branch for inner loops, in the slots of `inverse_all`: its axes, or None if it has no solution.

        The input is trusted: plain tuples of floats, with a rotation that is exact to all digits. An axis may be on any
        turn if no other axis moves with it. Limits are not tested. Without a reference, which stands for zeros, a
        machine that holds an axis at the reference has no solution.
        """
        return tuple([self.branch(frame, signs, reference) for _, signs in slots((AUTOMATIC,) * self.BRANCHES)])

    def branch(self, frame: PlainFrame, signs: Signs, reference: Reals | None = None) -> Reals | None:
        """One branch for inner loops, with input and axes as in `branches`.

        signs: 1 for byte 1 of a branch, -1 for byte 2.
        """
        if reference is None and self.HELD:
            return None
        near = self._without_reference() if reference is None else reference
        axes = self._branch(*frame, signs, (0,) * len(self.PERIOD_AXES), near)
        return None if isinstance(axes, Diagnosis) else axes

    def diagnose(
        self, frame: FrameLike, configuration: ConfigurationLike | None = None, reference: Numbers | None = None
    ) -> Diagnosis:
        """Why `inverse` refuses these arguments, without raising: which quantity, and how much is missing.

        Where the configuration leaves branches open and none has a solution, the reason is that of the first branch.
        Where the turn of an axis is beyond its limits and another turn is not, `turn` is the number of the other one:
        with it in the period byte, the call succeeds if nothing else refuses. Where nothing refuses, `projection` is
        the angle by which the commanded rotation was changed, because the machine cannot take it.
        """
        position, rows = self._pose(frame)
        near = self._near(reference)
        branches, turns = self._read(configuration)
        for place, byte in zip(self._branch_bytes, branches, strict=True):
            if byte not in (0, 1, 2, 3):
                return Diagnosis(Status.BAD_INPUT, NO_MEANING.format(byte=place), 0.0)
        rotation = self._made(rows)
        if isinstance(rotation, Diagnosis):
            return rotation
        axes = self._choose(lambda signs: self._branch(position, rotation, signs, turns, near), branches, near)
        if isinstance(axes, Diagnosis):
            return axes
        if (refused := self._beyond_limits(axes)) is not None:
            return refused
        reached = self._started(position, rotation)._orientation(axes) if self.READS_ROTATION else rotation
        turn = 0.0 if isinstance(reached, Status) else self._full_turn() * turn_between(rotation, reached)
        return Diagnosis(Status.OK, "", 0.0, projection=turn)

    def nearest(
        self, frame: FrameLike, reference: Numbers, *, weights: Numbers | None = None, measure: Measure = "squares"
    ) -> Reals:
        """The axis values inside the limits that reach a frame and are nearest to a reference.

        Unlike `inverse`, it chooses among all branches and all turns, up to 254 turns away, and limits choose with it:
        for a move from point to point.
        frame: as for `inverse`. reference: one value for each axis, usually the present axis values.
        measure: `squares`, the least sum of squared differences, or `largest`, the least largest difference (ties: the
        least sum of squares of the turns). weights: a factor of the difference of each axis, at least 0; None counts
        the rotary axes in degrees, and the linear ones if there are none, as an automatic choice does. Distances
        that differ by less than its tie (squared 1e-6, times the largest weight squared) go to the lower slot.
        Raises BAD_INPUT, UNREACHABLE or IMPOSSIBLE; the `refusal` is the reason of the nearest miss: the limit that a
        solution exceeds least, as a share of the range, or else the least missing amount of a branch.
        """
        from softkin import _nearest

        position, rows = self._pose(frame)
        near = reals(reference, len(self.AXES), "reference")
        metric = _nearest.metric_of(self, weights, measure)
        rotation = self._used("nearest", rows)
        found = _nearest.nearest(self, position, rotation, near, metric)
        if isinstance(found, Diagnosis):
            self._fail("nearest", found, position=position, rotation=rows, reference=near)
        return found

    def nearest_batch(
        self,
        positions: ArrayLike,
        rotations: ArrayLike | None,
        references: ArrayLike,
        *,
        weights: Numbers | None = None,
        measure: Measure = "squares",
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """`nearest` of N rows → axes (N, n), statuses (N,).

        positions, rotations and references are those of `inverse_batch`. A row whose status is not OK holds NaN. Where
        a turn moves several axes (a pitch, a gear coupling), and for a searched arm, rows are computed one by one.
        Raises BAD_INPUT for a wrong shape, a wrong measure or wrong weights.
        """
        from softkin import _nearest, _nearest_batch

        metric = _nearest.metric_of(self, weights, measure)
        return _nearest_batch.nearest_batch(self, positions, rotations, references, metric)

    def configuration(self, **names: str | int) -> NamedConfiguration:
        """The configuration with these branches and turns: `robot.configuration(elbow="left", A4=2)`.

        A branch is given by its name or as a byte (1, 2; 0 automatic; 3, read as automatic), the turn of an axis as a
        number: 1 contains 0 degrees, 2 the next turn, -1 the one before; 0 is automatic. What is not given is as in
        `DEFAULT_CONFIGURATION`. The name of a byte with spaces is given with underscores.
        Raises BAD_INPUT for an unknown name, with the known ones.
        """
        from softkin import _names

        return _names.configuration(self, names)

    def names(self, configuration: ConfigurationLike) -> dict[str, str | int]:
        """The inverse of `configuration`: by the name of each byte, the name of the branch or the number of the turn.

        An open branch is `automatic`; `coincide` where `forward` says that the branches meet.
        Raises BAD_INPUT for what is no configuration of this machine.
        """
        from softkin import _names

        return _names.names(self, self._bytes(configuration))

    def path(
        self,
        frames: Iterable[FrameLike],
        configuration: ConfigurationLike | None = None,
        reference: Numbers | None = None,
        *,
        samples: int = 1,
        singular: float | None = None,
    ) -> Path:
        """The axes along straight lines from frame to frame, on one branch, until the machine cannot go on.

        The tool turns about one axis at constant speed between two frames. The first frame is solved as `inverse` does,
        with the configuration and the reference; from there on the branch stays, and every axis follows on its turn.
        samples: the number of equal steps of each line. singular: margins smaller than this make a singular stretch;
        None stands for the warning distance of the machine.
        The path stops if there is no answer, where an axis is beyond a limit, or where an axis jumps: see `Path`.
        It is found between the samples, too. Raises BAD_INPUT for what is no frame, and if there is no frame.
        """
        from softkin import _path

        near = self._warning_distance() if singular is None else singular
        return _path.path(self, frames, configuration, reference, samples, near)

    def line(
        self,
        start: FrameLike,
        goal: FrameLike,
        configuration: ConfigurationLike | None = None,
        reference: Numbers | None = None,
        *,
        samples: int = 100,
        singular: float | None = None,
    ) -> Path:
        """The path from one frame straight to another: `path` of both."""
        return self.path((start, goal), configuration, reference, samples=samples, singular=singular)

    def move(
        self, start: Numbers, goal: Numbers, limits: Mapping[str, Sequence[float]], *, step: float = 0.01
    ) -> Timed:
        """The move of all axes from point to point, as fast as their limits allow: all start and arrive together.

        start, goal: axis values, inside the limits of the axes. limits: for every axis by name its highest speed and
        acceleration (trapezoids of speed), or speed, acceleration and jerk (S-curves), per second, in the unit of the
        axis. step: the seconds from one time of the result to the next. Raises UNREACHABLE beyond limits, BAD_INPUT for
        other input, ImportError without ruckig.
        """
        from softkin import _timed

        return _timed.move(self, start, goal, limits, step)

    def __str__(self) -> str:
        """A table of the axes with their limits, the parameters that are given, and the branches, by name."""
        from softkin import _tables

        return _tables.text(self)

    def _repr_html_(self) -> str:
        """For a notebook: the same tables, and the drawing of a machine of the catalogue."""
        from softkin import _tables

        return _tables.html(self)

    def plot(self, axes: Numbers, ax: Any = None) -> Any:
        """Draw the machine at axis values with matplotlib: its lines, the names of its axes, the frame of the tool.

        axes: one value for each axis. ax: three-dimensional axes of matplotlib to draw in; None makes a figure.
        Returns the axes of matplotlib. Raises ImportError without matplotlib, and the errors of `forward`.
        """
        from softkin import _plot

        return _plot.machine(self, reals(axes, len(self.AXES), "axes"), ax)

    def view(self, axes: Numbers | None = None, page: str | PathLike[str] | None = None) -> View:
        """The machine in the viewer, for a notebook: the whole page stands in the result, and needs no server.

        axes: where it stands, one value for each axis; None for the pose of the drawing.
        page: the page of the viewer that has this machine, which `make view` and `softkin view` write; None for the
        one that a wheel of the package carries. Raises NOT_INITIALIZED where there is none, or if the page has no such
        machine (a coupling).
        """
        from softkin import _view

        return _view.view(self, axes, page)

    def in_radians(self) -> Self:
        """The same machine with radians for degrees: axes, references, offsets, limits, the amounts of `diagnose`.

        Its calls are those of this machine, batches included; the Jacobian is per radian in both. A pitch stays per
        turn, a gear per degree. It is not an instance of this class; `in_degrees()` of it is this machine.
        """
        from softkin import _radians

        return cast("Self", _radians.in_radians(self))

    def in_degrees(self) -> Self:
        """This machine, whose angles are in degrees."""
        return self

    def jacobian(self, axes: Numbers) -> Matrix:
        """The Jacobian: rows as in `JACOBIAN_ROWS`, one column for each axis, per radian for an axis in degrees."""
        values = reals(axes, len(self.AXES), "axes")
        rows = self._jacobian(values)
        if isinstance(rows, Status):
            self._fail("jacobian", rows, axes=values)
        return rows

    def singularity(self, axes: Numbers) -> Singularity:
        """The singularity margins at axis values. Axis values that allow no pose are singular, with margins NaN."""
        margins = self._singularity(reals(axes, len(self.AXES), "axes"))
        if isinstance(margins, Status):
            return Singularity(True, dict.fromkeys(self.MARGINS, nan))
        near = self._warning_distance()
        is_singular = any(abs(margin) < near for margin in margins)
        return Singularity(is_singular, dict(zip(self.MARGINS, margins, strict=True)))

    def _started(self, position: Vector, rotation: Rotation) -> Self:
        """This machine, whose forward kinematics starts at a frame that the axes have: the same unless it iterates."""
        return self

    def _warning_distance(self) -> float:
        """The size of a margin below which a pose is called singular."""
        return self.parameters.get("warning_distance", WARNING_DISTANCE)

    def jacobian_batch(self, axes: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """The Jacobians of N rows: axes (N, n) → Jacobians (N, rows, n), statuses (N,).

        Each is that of `jacobian`. A row whose status is not OK holds NaN. Raises BAD_INPUT for a wrong shape.
        """
        from softkin import _differential

        return _differential.jacobian(self, self._array_programs(), axes)

    def singularity_batch(self, axes: ArrayLike) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """The singularities of N rows: axes (N, n) → whether each is singular (N,), margins (N, m) as in `MARGINS`.

        Both are those of `singularity`: axis values that allow no pose are singular, with margins NaN. Raises BAD_INPUT
        for a wrong shape.
        """
        from softkin import _differential

        return _differential.singularity(self, self._array_programs(), axes)

    def twist(self, axes: Numbers, velocities: Numbers) -> Reals:
        """The velocity of the frame: rows as in `JACOBIAN_ROWS`, in lengths and radians per time.

        velocities: one for each axis, of `HELD` axes too: radians per time for an axis in degrees, else lengths.
        Raises the errors of `jacobian`.
        """
        from softkin import _velocities

        return _velocities.twist(self, axes, velocities)

    def axis_velocities(
        self,
        axes: Numbers,
        twist: Numbers,
        *,
        held: Numbers | None = None,
        damping: float = 0.0,
        length: float | None = None,
    ) -> Reals:
        """The velocities of all axes that move the frame with a twist: the inverse of `twist`, in its units.

        twist: one number for each of `JACOBIAN_ROWS`. held: the velocities of the axes of `HELD`, which nobody but the
        caller knows; None stands for zeros. The other axes make up for their motion.
        damping: 0 for the exact velocities, which are refused where `singularity` says that the pose is singular, and
        where the axes cannot move so. A positive number for damped least squares: the velocities v that minimise
        |J v - twist|² + damping² |v|², which are finite everywhere, and near a singularity not exact.
        length: the characteristic length of `condition`, which makes the terms of that sum comparable; it is needed
        for damping where rows or axes differ in their unit, and has no influence on an exact solution.
        Raises IMPOSSIBLE at a singular pose without damping, UNREACHABLE for a motion that the axes do not have (of a
        machine with fewer axes than rows), BAD_INPUT for invalid numbers, and the errors of `jacobian`.
        """
        from softkin import _velocities

        return _velocities.axis_velocities(self, axes, twist, held, damping, length)

    def twist_rate(self, axes: Numbers, velocities: Numbers, accelerations: Numbers) -> Reals:
        """The acceleration of the frame: the rate of `twist`, row by row, J a + J' v.

        velocities, accelerations: one for each axis, of `HELD` axes too, in the units of `twist`. Raises the errors of
        `jacobian`, and BAD_INPUT for invalid numbers.
        """
        from softkin import _accelerations

        return _accelerations.twist_rate(self, axes, velocities, accelerations)

    def axis_accelerations(
        self,
        axes: Numbers,
        velocities: Numbers,
        twist_rate: Numbers,
        *,
        held: Numbers | None = None,
        damping: float = 0.0,
        length: float | None = None,
    ) -> Reals:
        """The accelerations of all axes that give the frame an acceleration: the inverse of `twist_rate`, in its units.

        velocities: those that the axes have, as `axis_velocities` finds them. twist_rate: one number for each of
        `JACOBIAN_ROWS`; zeros on a straight line at constant speed. held: the accelerations of the axes of `HELD`.
        damping, length and the errors are those of `axis_velocities`.
        """
        from softkin import _accelerations

        return _accelerations.axis_accelerations(self, axes, velocities, twist_rate, held, damping, length)

    def largest_feed(
        self,
        axes: Numbers,
        twist: Numbers,
        *,
        velocities: Numbers | None = None,
        accelerations: Numbers | None = None,
        twist_rate: Numbers | None = None,
    ) -> float:
        """The largest constant speed along a path that the limits of the axes allow at a pose; infinite without limits.

        twist: that of the frame at speed 1: for a feed in lengths per time, x, y and z are a vector of length 1.
        velocities, accelerations: the largest size that each may have, one positive number for each axis, in radians
        per time for an axis in degrees; None for no limit. twist_rate: the rate of the twist at speed 1, which is the
        curvature of the path; None for a straight line. Axes of `HELD` do not move.
        Raises the errors of `axis_velocities`, and BAD_INPUT for limits that are not positive.
        """
        from softkin import _accelerations

        return _accelerations.largest_feed(self, axes, twist, twist_rate, (velocities, accelerations))

    def axis_velocities_batch(
        self, axes: ArrayLike, twists: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """`axis_velocities` of N rows: axes (N, n), twists (N, rows) → velocities (N, n), statuses (N,).

        Without damping; axes of `HELD` do not move. A row whose status is not OK holds NaN: singular poses are
        IMPOSSIBLE. Raises BAD_INPUT for a wrong shape.
        """
        from softkin import _accelerations

        return _accelerations.axis_velocities_batch(self, self._array_programs(), axes, twists)

    def axis_accelerations_batch(
        self, axes: ArrayLike, velocities: ArrayLike, twist_rates: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """`axis_accelerations` of N rows: axes (N, n), velocities (N, n), twist rates (N, rows) → accelerations (N, n),
        statuses (N,), as in `axis_velocities_batch`.
        """
        from softkin import _accelerations

        return _accelerations.axis_accelerations_batch(self, self._array_programs(), axes, velocities, twist_rates)

    def largest_feed_batch(
        self,
        axes: ArrayLike,
        twists: ArrayLike,
        *,
        velocities: Numbers | None = None,
        accelerations: Numbers | None = None,
        twist_rates: ArrayLike | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """`largest_feed` of N rows: axes (N, n), twists (N, rows), twist rates (N, rows) → speeds (N,), statuses (N,).

        The limits are the same for all rows. A row whose status is not OK holds NaN. Raises BAD_INPUT for a wrong
        shape.
        """
        from softkin import _accelerations

        limits = velocities, accelerations
        return _accelerations.largest_feed_batch(self, self._array_programs(), axes, twists, twist_rates, limits)

    def condition(self, axes: Numbers, length: float | None = None) -> float:
        """The condition number of the Jacobian: at least 1, and infinite where the pose is singular to all digits.

        length: the characteristic length (u) that makes the Jacobian dimensionless: rows of positions are divided by
        it, columns of linear axes multiplied. It is needed where rows or axes differ in their unit, and has no
        influence elsewhere. Axes of `HELD` do not count. Raises the errors of `jacobian`, and BAD_INPUT for a length
        that is missing or not positive.
        """
        from softkin import _velocities

        return _velocities.condition(self, axes, length)

    def manipulability(self, axes: Numbers, length: float | None = None) -> float:
        """Yoshikawa's measure: the product of the singular values of the Jacobian, 0 at a singular pose.

        For as many rows as axes it is the absolute value of the determinant. length: as in `condition`; without one,
        where all rows and all axes have one unit, the measure has the unit of the determinant.
        """
        from softkin import _velocities

        return _velocities.manipulability(self, axes, length)

    def with_tool(self, tool: FrameLike) -> Mounted:
        """This machine with a tool at its flange: the same calls, for the frame of the tool.

        tool: the frame of the tool, seen from the flange (`Frame`, matrix, or pair). Tools compose: the second one is
        seen from the first. Raises INVALID_COUPLING, with the reason, where a commanded frame does not determine the
        flange: where the position alone turns it, a tool may be shifted along the axis of that turn only.
        """
        from softkin._mounted import mounted

        return mounted(self, tool=tool)

    def with_base(self, base: FrameLike) -> Mounted:
        """This machine on a base: the same calls, for frames in the coordinates in which the base is given.

        base: the frame of the machine in these coordinates. Bases compose: the machine with its first base stands on
        the second one.
        """
        from softkin._mounted import mounted

        return mounted(self, base=base)

    def calibrated(self, deviations: Mapping[str, float]) -> Mechanism:
        """This machine as it was measured: the same calls, with its deviations from the drawing.

        deviations: by name, in degrees and lengths; those that `deviations` lists, and all that are missing are as
        they are in this machine. Without any it is the nominal machine, to the last bit. With tilts of some 5 mrad and
        shifts of some 5 mm the inverse answers wherever the machine is; what it does not meet is refused.
        Raises NOT_INITIALIZED for an unknown name, with the one that was perhaps meant.
        """
        from softkin import _calibrated

        return _calibrated.calibrated(self, deviations)

    @property
    def deviations(self) -> Mapping[str, float]:
        """All deviations that this machine may have, by name, with their values: 0 in the machine as it is drawn.

        Of a serial machine: the tilts of each axis about x and y of a frame whose z is the axis (degrees), and of a
        turning axis its shifts along them. Of a closed loop: what is added to its dimensions. Of both: shifts and turns
        of tool and base, offsets of the axes in their own unit, and gains, of which 0.001 is one part in a thousand.
        """
        from softkin import _deviations

        if self.in_degrees() is not self:
            return self.in_degrees().deviations
        inputs = self.parameters if _deviations.are_inputs(self) else {}
        return {name: inputs.get(name, 0.0) for name in _deviations.units_of(self)}

    def orientation_image(self) -> OrientationImage:
        """The orientations that the flange can have."""
        image = self._image()
        if isinstance(image, Status):
            self._fail("orientation_image", image)
        return OrientationImage(self.FREEDOM, *image)

    def forward_batch(
        self, axes: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int8], NDArray[np.uint8]]:
        """Forward kinematics of N rows: axes (N, n) → positions, rotations, configurations, statuses.

        Their shapes are (N, 3), (N, 3, 3), (N, m) and (N,). A row whose status is not OK holds NaN, and zeros in its
        configuration. Raises BAD_INPUT for a wrong shape.
        """
        from softkin import _batch

        return _batch.forward(self, self._array_programs(), axes)

    def inverse_batch(
        self,
        positions: ArrayLike,
        rotations: ArrayLike | None = None,
        configurations: ArrayLike | ConfigurationLike | None = None,
        references: ArrayLike | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """Inverse kinematics of N rows → axes (N, n), statuses (N,).

        positions (N, 3); rotations (N, 3, 3), not read (and may be None) where `READS_ROTATION` is False. Frames, or
        their matrices (N, 4, 4), may stand in the place of both: `inverse_batch(frames)`.
        configurations (N, m), or (m,) or names for all rows, or None for the default; references (N, n), or (n,) for
        all rows, or None for zeros.
        A row whose status is not OK holds NaN. Raises BAD_INPUT for a wrong shape.
        """
        from softkin import _batch

        return _batch.inverse(self, self._array_programs(), positions, rotations, configurations, references)

    def inverse_all_batch(
        self, positions: ArrayLike, rotations: ArrayLike | None = None, references: ArrayLike | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """Every branch of N rows → axes (N, slots, n), statuses (N, slots), in the slots of `inverse_all`.

        The input is that of `inverse_batch`. A slot whose status is not OK holds NaN. Raises BAD_INPUT for a wrong
        shape.
        """
        from softkin import _batch

        return _batch.inverse_all(self, self._array_programs(), positions, rotations, references)

    def _every_branch(self, position: Vector, rotation: Rotation, reference: Reals) -> tuple[Reals | int, ...]:
        """The slots of the inverse, each with its axes or the number of its status."""
        open_turns = (0,) * len(self.PERIOD_AXES)
        found: list[Reals | int] = []
        for _, signs in slots((AUTOMATIC,) * self.BRANCHES):
            axes = self._branch(position, rotation, signs, open_turns, reference)
            found.append(self._inside(axes))
        return tuple(found)

    def _finished(
        self, solve: Branches, finish: Finish | None, position: Vector, rotation: Rotation, reference: Reals
    ) -> tuple[Reals | int, ...]:
        """The slots of the inverse, by the functions of the machine; one branch after the other where these fail."""
        if finish is not None and reasonable(*position, *reference):
            found = solve((position, rotation), reference, _NUMBERS)
            if found:
                return finish(found, reference)
        return Mechanism._every_branch(self, position, rotation, reference)

    def _every_solution(
        self, position: Vector, rotation: Rotation, reference: Reals
    ) -> Iterable[tuple[Signs, Reals | Diagnosis]]:
        """The axes of every branch with automatic turns, or its status where it has none; limits are not tested."""
        every, turns = slots((AUTOMATIC,) * self.BRANCHES), (0,) * len(self.PERIOD_AXES)
        solve: Branches | None = getattr(self, "_all_trusted", None)
        if solve is not None and getattr(self, "_finish", None) is not None and reasonable(*position, *reference):
            found = solve((position, rotation), reference)
            if any(found):  # else the status of the branch
                return [(signs, axes) for (_, signs), axes in zip(every, found, strict=True) if axes is not None]
        return [(signs, self._branch(position, rotation, signs, turns, reference)) for _, signs in every]

    def _has_one_solution_a_branch(self) -> bool:
        """Whether a branch has at most one solution, apart from turns."""
        return True

    def _ranges(self) -> tuple[tuple[float, float], ...]:
        """The ranges of the axes, then of other quantities with limits; wide where limits are not tested."""
        k = vars(getattr(self, "_constants"))  # noqa: B009  each class has its own
        found = [(k[f"lowest_{key}"], k[f"highest_{key}"]) for key in self.LIMIT_KEYS]
        return tuple(found)

    def _quantities(self, axes: Reals) -> Reals | Status:
        """The quantities other than axes that have limits, in the unit of these limits."""
        return ()

    def _limited_values(self, axes: Reals) -> Reals:
        """The quantities with limits, computed from solved axes."""
        found = self._quantities(axes)
        return () if isinstance(found, Status) else found

    def _parameter_units(self) -> dict[str, str]:
        """The units of the parameters by name."""
        return {p.name: p.unit for p in self.PARAMETERS}

    def _chain(self) -> tuple[Link, ...] | None:
        """The chain of a serial machine as it is described, from the base to the frame; None for a closed loop."""
        return None

    def _points(self, axes: Reals, position: Vector, rotation: Rotation) -> Reals | Status:
        """The points of a closed loop that are drawn, three numbers each: see `LINES`."""
        return ()

    def _axis_zeros(self) -> Reals:
        """The axis values at which the joints are zero."""
        return tuple(self.parameters[f"offset_{key}"] for key in self.LIMIT_KEYS[: len(self.AXES)])

    def _full_turn(self) -> float:
        """A full turn in the unit of the rotary axes."""
        return 360.0

    def _inside(self, axes: Reals | Diagnosis) -> Reals | int:
        """The axes if they are inside their limits, else the number of the status."""
        if isinstance(axes, Diagnosis):
            return int(axes.status)
        refused = self._beyond_limits(axes)
        return axes if refused is None else int(refused.status)

    def _solution(self, slot: Slot, found: Reals | Diagnosis) -> Solution:
        """The solution of a slot, with its configuration, or the reason why it has none."""
        branches, _ = slot
        if isinstance(found, Diagnosis):
            return Solution(self._joined(branches, (0,) * len(self.PERIOD_AXES)), None, found.status, (), found)
        return Solution(self._joined(branches, self._periods(found)), found, Status.OK)

    def _explained(
        self, position: Vector, rotation: Rotation, reference: Reals, slot: Slot, found: Reals | int
    ) -> Solution:
        """The solution of a slot; for the number of a status, the slot is solved again for its reason."""
        if not isinstance(found, int):
            return self._solution(slot, found)
        axes = self._branch(position, rotation, slot[1], (0,) * len(self.PERIOD_AXES), reference)
        refused = axes if isinstance(axes, Diagnosis) else self._beyond_limits(axes)
        is_same = refused is not None and refused.status == found
        return self._solution(slot, refused if refused and is_same else Diagnosis(_STATUSES[found], "", 0.0))

    def _pose(self, frame: FrameLike) -> tuple[Vector, Rotation]:
        """Position and rotation as given; a mechanism that reads no rotation accepts any."""
        return pose_of(frame) if self.READS_ROTATION else (position_of(frame), _IDENTITY)

    def _made(self, rotation: Rotation) -> Rotation | Diagnosis:
        """The commanded rotation, repaired for the programs, or the reason why it is no rotation."""
        return made_rotation(rotation) if self.READS_ROTATION else rotation

    def _used(self, call: str, rotation: Rotation) -> Rotation:
        """The commanded rotation, repaired for the programs, in a call that raises errors."""
        made = self._made(rotation)
        if isinstance(made, Diagnosis):
            self._refuse_rotation(call, made, rotation)
        return made

    def _refuse_rotation(self, call: str, refused: Diagnosis, rotation: Rotation) -> NoReturn:
        """Raise the error of a call with a matrix that is no rotation."""
        self._refuse(call, refused, unusable({"rotation": rotation}) or in_words(refused))

    def _refuse(self, call: str, refused: Diagnosis, detail: str) -> NoReturn:
        """Raise the error of an inverse that refuses."""
        raise KinematicsError(refused.status, f"{self.NAME}.{call}: {refused.status.meaning}: {detail}", refused)

    def _near(self, reference: Numbers | None) -> Reals:
        if reference is None:
            return self._without_reference()
        return reals(reference, len(self.AXES), "reference")

    def _without_reference(self) -> Reals:
        """Zeros. Raises BAD_INPUT where an axis is held at the reference: nobody but the caller knows where it is."""
        if self.HELD:
            names = " and ".join(self.AXES[i].name for i in self.HELD)
            raise KinematicsError(
                Status.BAD_INPUT, f"{self.NAME}: a reference is needed: it holds the value of {names}"
            )
        return (0.0,) * len(self.AXES)

    def _bytes(self, configuration: ConfigurationLike | None) -> Configuration:
        """The bytes of a configuration in any of its forms."""
        if configuration is None:
            return self.DEFAULT_CONFIGURATION
        if isinstance(configuration, str | Mapping):
            from softkin import _names

            return _names.named(self, configuration)
        return bytes_of(configuration, len(self.CONFIGURATION))

    def _read(self, configuration: ConfigurationLike | None) -> tuple[Configuration, Turns]:
        """The branch bytes, and the numbers of the commanded turns."""
        found = self._bytes(configuration)
        return found[: self.BRANCHES], found[self.BRANCHES :]

    @property
    def _branch_bytes(self) -> list[int]:
        """The indices of the branch bytes in the configuration."""
        return list(range(self.BRANCHES))

    @property
    def _period_bytes(self) -> list[int]:
        """The indices of the period bytes in the configuration."""
        return list(range(self.BRANCHES, len(self.CONFIGURATION)))

    def _joined(self, branches: Configuration, periods: Configuration) -> Configuration:
        """The configuration that consists of branch bytes and period bytes."""
        return branches + periods

    def _written(self, margins: Reals, axes: Reals) -> Configuration:
        """The configuration of a pose."""
        return tuple(map(branch_byte, margins)) + self._periods(axes)

    def _turn_sizes(self) -> Reals:
        """The turns of the joint per turn of its axis, for every axis with a period byte."""
        return (1.0,) * len(self.PERIOD_AXES)

    def _periods(self, axes: Reals) -> Configuration:
        return tuple([1 if FIRST_TURN <= axes[i] < SECOND_TURN else period(axes[i]) for i in self.PERIOD_AXES])

    def _choose(self, program: _OneBranch, branches: Configuration, near: Reals) -> Reals | Diagnosis:
        """The axes on the slot that the branch bytes name, or on the nearest of the slots that they leave open.

        Where all of these refuse, the result is the reason of the first one.
        """
        named = slots(branches)
        if len(named) == 1:
            return program(named[0][1])
        found = [program(signs) for _, signs in named]
        answers = [axes for axes in found if not isinstance(axes, Diagnosis)]
        if not answers:
            return found[0]
        best = answers[0]
        for axes in answers[1:]:
            if self._is_nearer(axes, best, near):
                best = axes
        return best

    @property
    def _criteria(self) -> tuple[Criterion, ...]:
        """The criteria of an automatic choice; each decides where all criteria before it tie."""
        return (Criterion(self.DISTANCE_AXES, TIE),)

    def _is_nearer(self, axes: Reals, other: Reals, near: Reals) -> bool:
        """Whether axes are nearer to the reference than others."""
        for counted, tie in self._criteria:
            own, least = squared_distance(axes, near, counted), squared_distance(other, near, counted)
            if own < least - tie:
                return True
            if least < own - tie:
                return False
        return False

    def _beyond_limits(self, axes: Reals) -> Diagnosis | None:
        """The limit that the axes exceed; None if they exceed none, or limits are not tested."""
        return self._limits(axes) if self.checks_limits else None

    def _limited(self, call: str, axes: Reals) -> Reals:
        """The axes if they are inside their limits; else the error is raised."""
        refused = self._beyond_limits(axes)
        if refused is not None:
            message = f"{self.NAME}.{call}: axes {axes} are beyond the limits: {refused.in_words}"
            raise KinematicsError(refused.status, message, refused)
        return axes

    def _missed(self, axes: Reals, why: Status) -> None:
        """Raise the error of forward kinematics with the misses of surplus rods, where these refuse."""
        if why is Status.IMPOSSIBLE and self.SURPLUS:
            found = ", ".join(f"{name} is {miss:+.6g} too short" for name, miss in self.misses(axes).items())
            raise KinematicsError(why, f"{self.NAME}.forward: {why.meaning}: at the pose of the other axes {found}")

    def _fail(self, call: str, why: Status | Diagnosis, **inputs: object) -> NoReturn:
        """Raise the error of a call that fails."""
        if isinstance(why, Diagnosis):
            self._refuse(call, why, (unusable(inputs) if why.status is Status.BAD_INPUT else "") or why.in_words)
        detail = unusable(inputs) if why is Status.BAD_INPUT else ""
        raise KinematicsError(why, f"{self.NAME}.{call}: {why.meaning}" + (f": {detail}" if detail else ""))

    def _every_pose(self, axes: Reals) -> EveryPose:
        """All poses at axis values: of a closed loop those of both assembly modes."""
        modes = [(self, False)]
        if self.ASSEMBLY:
            modes.append((self.changed(**{self.ASSEMBLY: not self.parameters[self.ASSEMBLY]}), True))
        poses = [(machine._forward(axes), is_other) for machine, is_other in modes]
        return tuple((pose, is_other) for pose, is_other in poses if not isinstance(pose, Status))

    @abstractmethod
    def _forward(self, axes: Reals) -> Pose | Status: ...

    @abstractmethod
    def _orientation(self, axes: Reals) -> Rotation | Status: ...

    @abstractmethod
    def _branch(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Reals | Diagnosis: ...

    @abstractmethod
    def _limits(self, axes: Reals) -> Diagnosis | None: ...

    @abstractmethod
    def _singularity(self, axes: Reals) -> Reals | Status: ...

    def _jacobian(self, axes: Reals) -> Matrix | Status:
        """The rows of the Jacobian: those of the twist, where a class has a program for all of these."""
        rows = self._twist(axes)
        return rows if isinstance(rows, Status) else tuple(rows[TWIST.index(row)] for row in self.JACOBIAN_ROWS)

    def _twist(self, axes: Reals) -> Matrix | Status:
        """The six rows of the twist. If the frame keeps its orientation: those of the Jacobian, and zeros."""
        rows = self._jacobian(axes)
        if isinstance(rows, Status):
            return rows
        known = dict(zip(self.JACOBIAN_ROWS, rows, strict=True))
        return tuple(known.get(row, (0.0,) * len(axes)) for row in TWIST)

    def _bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        """The acceleration of the rows of the Jacobian at constant speeds of the axes."""
        rows = self._twist_bias(axes, speeds)
        return rows if isinstance(rows, Status) else tuple(rows[TWIST.index(row)] for row in self.JACOBIAN_ROWS)

    def _twist_bias(self, axes: Reals, speeds: Reals) -> Reals | Status:
        """The same of the six rows of the twist."""
        rows = self._bias(axes, speeds)
        if isinstance(rows, Status):
            return rows
        known = dict(zip(self.JACOBIAN_ROWS, rows, strict=True))
        return tuple(known.get(row, 0.0) for row in TWIST)

    def _turns_unseen(self) -> bool:
        """Whether the Jacobian lacks rows of the twist that are not zero."""
        return type(self)._twist is not Mechanism._twist

    def _follows(self) -> str:
        """The part of a commanded rotation that the flange follows: see `_tools`."""
        if self.FREEDOM == "zero":
            return FIXED
        if not self.READS_ROTATION:
            return ONE_AXIS if self.FREEDOM == "one" else SEVERAL_AXES
        if len(self.JACOBIAN_ROWS) != len(self.AXES) - len(self.HELD):  # with more rows it is not known
            return SEVERAL_AXES
        if "pitch" in self.JACOBIAN_ROWS:
            return PITCH
        return DIRECTION if "tilt x" in self.JACOBIAN_ROWS else WHOLE

    def _nearest_flange(self, rotation: Rotation) -> Rotation | Status:
        """The rotation that the inverse gives the flange for a commanded one, where it depends on nothing else."""
        return rotation

    @abstractmethod
    def _image(self) -> Image | Status: ...

    @abstractmethod
    def _array_programs(self) -> Programs: ...
