"""The drawing of a mechanism: its scene, and the choice of each configuration byte, at one regular pose."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TypeAlias

import numpy as np

from derive.description.mechanism import COORDINATE_NAMES, COORDINATE_NAMES_OF_A_PLANE, Joint, Task, Turning
from derive.drawing.chain import chain_scene
from derive.drawing.labels import plain
from derive.drawing.loop import loop_scene
from derive.drawing.pose import Pose, drawn_pose, nominal_machine, pose_at, values_at
from derive.drawing.scene import Scene, Segment, Spot, Turn
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics, Reals
from derive.kinematics.sampling import sample_axes
from derive.plate.plate import home_position
from derive.report.reference_calls import Machine, branches, fitted

_ANGLES = (25.0, 60.0, -40.0, 35.0, 50.0, 20.0)
"""Values of the rotary axes at which a configuration is shown, tried in this order."""
_AROUND, _TRIED = 60.0, 300
"""For a loop that turns its platform: the distance from home (degrees) and the number of poses at which a
configuration is sought."""
_VISIBLE = 0.04
"""Two poses look different where some point moves by this fraction of the machine's size."""


_TURNED = 0.7
"""The cosine of the smallest angle at which two directions of an axis look different."""
_SAMPLED = 80
"""The number of sampled poses at which a configuration is sought that the regular ones do not show."""

_Pair: TypeAlias = tuple[tuple[Scene, Scene], bool]
"""The scenes of both bytes, and whether the first is that of the pose from which the second was found."""


@dataclass(frozen=True)
class Choice:
    """One choice: two poses with the same tool frame, or with the same axes where it is the assembly mode."""

    name: str
    names: tuple[str, str]
    scenes: tuple[Scene, Scene] | None
    """None if both look alike, or no such pair was found."""
    assemblies: tuple[str, str] | None = None
    """The assembly mode of each pose, where in one mode no such pair was found."""


@dataclass(frozen=True)
class Drawing:
    """A mechanism, drawn: the names of its axes with their values, and the choices of its configuration."""

    scene: Scene
    axes: tuple[tuple[Joint, float], ...]
    is_zero: bool
    is_home: bool
    plane: tuple[int, int] | None
    """The two coordinates of a machine that moves in their plane."""
    choices: tuple[Choice, ...]
    assembly: Choice | None


def drawing_of(kinematics: Kinematics) -> Drawing:
    """Draw a mechanism. Raises `DescriptionError` if a bar has not the length that is stated, or nothing can be
    drawn.
    """
    mechanism = kinematics.mechanism
    machine = nominal_machine(kinematics)
    pose = drawn_pose(machine)
    scene = scene_at(machine, pose)
    if mechanism.home:
        home = Spot(tuple(map(plain, home_position(mechanism))), pose.tool.position)
        scene = replace(scene, spots=(*scene.spots, home))
    return Drawing(
        scene=scene,
        axes=tuple(zip(mechanism.joints, pose.axes, strict=True)),
        is_zero=pose.is_zero,
        is_home=bool(mechanism.home),
        plane=_plane(mechanism.task),
        choices=tuple(_choices(_without_search(kinematics, machine), pose, _reassembled(kinematics))),
        assembly=_assembly(kinematics, pose),
    )


def _plane(task: Task) -> tuple[int, int] | None:
    is_flat = task.position == COORDINATE_NAMES_OF_A_PLANE or task.turning in (Turning.NONE, Turning.PITCH)
    if len(task.position) != 2 or not is_flat:
        return None
    first, second = map(COORDINATE_NAMES.index, task.position)
    return first, second


def _without_search(kinematics: Kinematics, machine: Machine) -> Machine:
    """The machine with a closed form, if there is one, without the branch of a root search, which a picture cannot
    show."""
    search = kinematics.mechanism.search
    return (
        machine if search is None or search.where is None else nominal_machine(kinematics, **{search.where.name: 0.0})
    )


def scene_at(machine: Machine, pose: Pose) -> Scene:
    """The scene of a machine at a pose."""
    mechanism = machine.kinematics.mechanism
    values = values_at(machine, pose)
    return (loop_scene if mechanism.chain is None else chain_scene)(mechanism, values, pose.tool)


def _choices(machine: Machine, drawn: Pose, other: Machine | None) -> Iterator[Choice]:
    """The choice of every branch: both bytes at the same tool frame. If one assembly mode has only one of them, the
    other byte is drawn in the other mode.
    """
    branches = machine.kinematics.mechanism.branches
    shown_branches = [k for k, branch in enumerate(branches) if not branch.is_crossing]
    found = _pairs(machine, drawn, shown_branches, machine)
    missing = [k for k in shown_branches if k not in found]
    changed = {} if other is None or not missing else _pairs(machine, drawn, missing, other)
    for index, branch in enumerate(branches):
        scenes, is_first = (found | changed).get(index, (None, True))
        modes = machine.kinematics.mechanism.assembly.names if index in changed else None  # type: ignore[union-attr]
        yield Choice(branch.name, branch.names, scenes, modes if modes is None or is_first else modes[::-1])


def _pairs(machine: Machine, drawn: Pose, shown_branches: list[int], other: Machine) -> dict[int, _Pair]:
    """Both bytes of these branches: a pose of the machine, and one of the other machine with the other byte."""
    found: dict[int, _Pair] = {}
    for axes in _candidates(machine, drawn):
        missing = [k for k in shown_branches if k not in found]
        if missing and (pose := pose_at(machine, axes)) is not None:
            scene = cache(partial(scene_at, machine, pose))
            pairs = {k: _pair(scene, pose, k, other) for k in missing if pose.configuration[k] != 3}
            found |= {k: pair for k, pair in pairs.items() if pair is not None}
    return found


def _reassembled(kinematics: Kinematics) -> Machine | None:
    """The machine in its other assembly mode; None if it has one mode, or its home pose decides the mode."""
    assembly = kinematics.mechanism.assembly
    if assembly is None or kinematics.mechanism.is_platform:
        return None
    return nominal_machine(kinematics, **{assembly.parameter: 1.0})


def _candidates(machine: Machine, drawn: Pose) -> Iterator[Reals]:
    """Candidates for the pose of a choice: near the drawn pose for a loop, and with every rotary axis turned."""
    mechanism = machine.kinematics.mechanism
    if mechanism.is_platform:  # the other branch must be in the assembly mode of the machine, too
        around = np.random.default_rng(1).uniform(-_AROUND, _AROUND, (_TRIED, len(drawn.axes)))
        yield from (tuple(row) for row in (np.array(drawn.axes) + around).tolist())
    for part in (0.0, 0.4, -0.4, 0.8, 1.2):
        turned = zip(mechanism.joints, drawn.axes, (*_ANGLES,) * 2, strict=False)
        if part or not drawn.is_zero or mechanism.chain is None:
            scale = part if mechanism.chain is None else 2.5 * part
            yield tuple(axis + (scale * angle if joint.axis_is_angle else 0.0) for joint, axis, angle in turned)
    if mechanism.drives or (mechanism.chain is None and not mechanism.is_platform):
        sampled = sample_axes(mechanism, dict(machine.values), _SAMPLED, seed=5)
        shown = zip(mechanism.joints, drawn.axes, strict=True)  # beside loops in its chain a machine is seen as before
        columns = [sampled[j.axis.name] if j.loops or not mechanism.drives else np.full(_SAMPLED, a) for j, a in shown]
        rows = np.round(np.stack(columns, axis=1), 1)
        yield from fitted(machine, [tuple(row) for row in rows.tolist()])


def _pair(scene: Callable[[], Scene], pose: Pose, index: int, into: Machine) -> _Pair | None:
    """A pose with its scene, and one of a machine with the other byte of this branch; None if there is none."""
    mechanism = into.kinematics.mechanism
    count = len(mechanism.branches)
    first = pose.configuration[index] == 1
    other = [3 - byte if k == index else byte for k, byte in enumerate(pose.configuration[:count])]
    periods = (0,) * (len(pose.configuration) - count)
    _, solutions, statuses = branches(into, pose.frame, (*other, *periods), pose.axes)
    flipped = pose_at(into, solutions[0]) if statuses[0] is Status.OK else None
    if mechanism.is_platform and statuses[0] is Status.OK:  # forward kinematics may not find this pose from home
        flipped = Pose(solutions[0], pose.frame, (*other, *periods))
    if flipped is None:
        return None
    one, two = scene(), scene_at(into, flipped)
    scenes = _different(*((one, two) if first else (two, one)))
    return scenes and (scenes, first)


def _assembly(kinematics: Kinematics, drawn: Pose) -> Choice | None:
    """The two assembly modes at the same axis values."""
    assembly = kinematics.mechanism.assembly
    if assembly is None:
        return None
    machine = nominal_machine(kinematics, **{assembly.parameter: 1.0})
    other = pose_at(machine, drawn.axes)
    scenes = None if other is None else (scene_at(nominal_machine(kinematics), drawn), scene_at(machine, other))
    return Choice(assembly.name, assembly.names, scenes and _different(*scenes))


def _different(one: Scene, other: Scene) -> tuple[Scene, Scene] | None:
    turned = [a for a, b in zip(one.turns, other.turns, strict=True) if is_turned_round(a, b)]
    return (one, other) if turned or not looks_alike(one, other) else None


def looks_alike(one: Scene, other: Scene) -> bool:
    """Whether no body of two scenes stands visibly elsewhere."""
    return _apart(one.segments, other.segments) <= _VISIBLE * max(one.size, other.size)


def is_turned_round(one: Turn, other: Turn) -> bool:
    """Whether the axis of a joint points elsewhere in another scene, as that of a wrist that flips."""
    return float(np.dot(one.axis, other.axis)) < _TURNED


def _apart(one: tuple[Segment, ...], other: tuple[Segment, ...]) -> float:
    ends = [np.array([(s.start, s.end) for s in segments]) for segments in (one, other)]
    return float(np.max(np.abs(ends[0] - ends[1]))) if ends[0].shape == ends[1].shape and ends[0].size else 0.0
