"""The pose that is drawn: the zero pose where the mechanism usually stands like this, else a nominal one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from derive.description.mechanism import DescriptionError, Mechanism
from derive.drawing.labels import Values
from derive.drawing.scene import Frame, frame_of
from derive.equations.axes import joint_lets
from derive.ir.interpret import evaluate, run
from derive.ir.passes import normalise
from derive.ir.program import Output, Status
from derive.kinematics.kinematics import Bytes, Kinematics, Reals
from derive.kinematics.parameters import shown_values
from derive.kinematics.sampling import sample_axes
from derive.report.reference_calls import FRAME, Machine, are_inside, fitted, forward, machine_with, margins

_SAMPLES, _SEED = 3000, 3
_DECIMALS = 3
"""The decimals of axis values at a pose that is found by sampling."""


@dataclass(frozen=True)
class Pose:
    """One pose of a machine: axis values, the frame from forward kinematics, and the configuration there."""

    axes: Reals
    frame: Reals
    configuration: Bytes

    @property
    def is_zero(self) -> bool:
        """Whether every axis is at zero."""
        return not any(self.axes)

    @property
    def tool(self) -> Frame:
        """The frame at the end of the mechanism."""
        return frame_of(self.frame)


def nominal_machine(kinematics: Kinematics, **changed: float) -> Machine:
    """The machine with nominal dimensions, no offsets, and the limits of the description."""
    return machine_with(kinematics, shown_values(kinematics.mechanism) | changed)


def pose_at(machine: Machine, axes: Reals) -> Pose | None:
    """The pose at these axis values; None if there is none."""
    status, frame, configuration = forward(machine, axes)
    return Pose(axes, frame, configuration) if status is Status.OK else None


def drawn_pose(machine: Machine) -> Pose:
    """The pose that is drawn: the first of its candidates inside the limits; if there is none, the first of them.

    Raises `DescriptionError` if the nominal joint values of a closed loop fit no pose.
    """
    beyond: list[Pose] = []
    for found in filter(None, _candidates(machine)):
        if is_inside(machine, found):
            return found
        beyond.append(found)
    if not beyond:
        raise DescriptionError("no pose can be drawn: the nominal values of its joints fit no pose of the mechanism")
    return beyond[0]


def is_inside(machine: Machine, pose: Pose) -> bool:
    """Whether no axis of a pose is beyond the limits of the machine."""
    axes = zip(machine.kinematics.mechanism.joints, pose.axes, strict=True)
    return bool(are_inside(machine, {joint.axis.name: np.asarray(value) for joint, value in axes}))


def _candidates(machine: Machine) -> Iterator[Pose | None]:
    """The poses in which the machine may be drawn, the best first; None for axis values at which it has no pose."""
    mechanism = machine.kinematics.mechanism
    if mechanism.home:
        yield pose_at(machine, machine.home)
        return
    zero = pose_at(machine, (0.0,) * len(mechanism.joints))
    if zero is not None and (mechanism.chain is not None or _is_usual(machine, zero)):
        yield zero
    yield pose_at(machine, *fitted(machine, [tuple(j.shown for j in mechanism.joints)]))
    yield _most_regular(machine)


def _most_regular(machine: Machine) -> Pose | None:
    """The sampled pose that is farthest from singular ones; None if no pose is possible."""
    mechanism = machine.kinematics.mechanism
    drawn = sample_axes(mechanism, dict(machine.values), _SAMPLES, _SEED)
    axes = np.stack([np.round(drawn[j.axis.name], _DECIMALS) for j in mechanism.joints], axis=1)
    rows = fitted(machine, [tuple(row) for row in axes.tolist()])
    least = np.min(np.abs(margins(machine, rows)), axis=0)
    if np.isnan(least).all():
        return None
    return pose_at(machine, rows[int(np.nanargmax(least))])


def _is_usual(machine: Machine, pose: Pose) -> bool:
    """Whether the mechanism is in its first configuration, and no joint that is a length is zero."""
    mechanism = machine.kinematics.mechanism
    values = values_at(machine, pose)
    bars = mechanism.bars or mechanism.rods
    whole = all(float(evaluate(bar.length, values)) > 0 for bar in bars)
    return whole and 2 not in pose.configuration[: len(mechanism.branches)]


def values_at(machine: Machine, pose: Pose) -> Values:
    """The values of a description by name: parameters, joint values, and the pose of the tool."""
    mechanism = machine.kinematics.mechanism
    values = dict(machine.values)
    if mechanism.drives:
        values |= _joints_of(mechanism, values, pose)
    for joint, axis in zip(mechanism.joints, pose.axes, strict=True):
        if joint.loops:
            continue
        motor = np.asarray(axis * float(evaluate(joint.unit, values)))
        values[joint.motor.name] = motor
        values[joint.symbol.name] = np.asarray(motor * evaluate(joint.ratio, values) + evaluate(joint.coupling, values))
    return values | {name: np.asarray(value) for name, value in zip(FRAME, pose.frame, strict=True)}


def _joints_of(mechanism: Mechanism, values: Values, pose: Pose) -> Values:
    """The values of joints that loops move, and of what is between these."""
    names = {s for j in mechanism.joints for loop in j.loops for s in (loop.moved, loop.by)}
    outputs = [Output(s.name, s) for s in sorted(names, key=str)]
    axes = {j.axis.name: np.asarray(axis) for j, axis in zip(mechanism.joints, pose.axes, strict=True)}
    found, _ = run(normalise("joints", joint_lets(mechanism), outputs), {**values, **axes})
    return found
