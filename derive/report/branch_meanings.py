"""The meanings of branches and assembly modes that no description names: in words, and at one frame of the nominal
machine, or at one set of axis values.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from derive.description.mechanism import Branch, Mechanism
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics, Reals
from derive.report.reference_calls import Machine, branches_at, forward, forward_at, machine_with
from derive.work import stage

_ANGLES = (25.0, 60.0, -40.0, 35.0, 50.0, 20.0, -30.0)
_AROUND, _TRIED, _FEW = 60.0, 200, 4
"""The range of the axis values that are drawn, in degrees, their number, and that of those which are tried before."""
_APART = 1e-3
"""Axis values closer than this are the same."""
_REGULAR = (1, 2)


@stage("the search for an example of its branches")
def with_meanings(kinematics: Kinematics) -> Kinematics:
    """The kinematics with a note for every branch that its description does not name, and for its assembly choice."""
    notes = tuple(
        f"The description does not name the branch {branch.name}. In {branch.names[0]} {branch.meanings[0]}; in "
        f"{branch.names[1]} {branch.meanings[1]}{_example(kinematics, index)}."
        for index, branch in enumerate(kinematics.branches)
        if branch.meanings[0]
    )
    notes += tuple(_assembly(kinematics))
    if not notes:
        return kinematics
    mechanism = kinematics.mechanism
    return replace(kinematics, mechanism=replace(mechanism, notes=(*mechanism.notes, *notes)))


def meanings_of_crossing(mechanism: Mechanism, branch: Branch) -> tuple[str, str]:
    """What the byte of a root search means, by its two names: how the residual, or the Jacobian, is at the root."""
    assert mechanism.search is not None
    of = f"the residual {{}} with {mechanism.search.joint.name} at the root", ("rises", "falls")
    if mechanism.search.is_eliminated:
        of = "the determinant of the Jacobian is {}", ("positive", "negative")
    text, (above, below) = of
    first, second = (above, below) if branch.signs[0] > 0 else (below, above)
    return text.format(first), text.format(second)


def _assembly(kinematics: Kinematics) -> Iterator[str]:
    """The notes on the two positions of a loop, where the description does not name them."""
    way = kinematics.mechanism.assembly
    if way is None or not way.meanings[0]:
        return
    first, second = way.meanings
    yield (
        f"The description does not name the two positions of the tool at the same axes: {way.parameter} chooses the "
        f"second. In {way.names[0]} {first}; in {way.names[1]} {second}{_positions(kinematics, way.parameter)}."
    )


def _positions(kinematics: Kinematics, parameter: str) -> str:
    """Both positions of the nominal machine at the same axes; empty if no such axes were found."""
    nominal = kinematics.unlimited_values
    if kinematics.mechanism.surplus:  # a surplus rod fits one of both at most
        return ""
    machines = [machine_with(kinematics, nominal | {parameter: second}) for second in (0.0, 1.0)]
    for axes in _candidates(machines[0]):
        found = [forward(machine, axes) for machine in machines]
        if all(status is Status.OK for status, _, _ in found):
            joints = zip(kinematics.mechanism.joints, axes, strict=True)
            at = ", ".join(f"{joint.name} {value:.1f}" for joint, value in joints)
            shown = [
                ", ".join(f"{c.upper()} {frame['xyz'.index(c)]:.1f}" for c in kinematics.mechanism.task.position)
                for _, frame, _ in found
            ]
            return f". At {at} of the nominal machine the first is at {shown[0]}, the second at {shown[1]}"
    return ""


def _example(kinematics: Kinematics, index: int) -> str:
    pair = pair_at_one_frame(kinematics, index)
    if pair is None:
        return ""
    moved = [
        (joint.name, *values)
        for joint, *values in zip(kinematics.mechanism.joints, *pair, strict=True)
        if abs(values[0] - values[1]) > _APART
    ]
    sides = (", ".join(f"{name} {values[side]:.1f}" for name, *values in moved) for side in (0, 1))
    first, second = sides
    names = kinematics.branches[index].names
    what = (
        "orientation" if kinematics.mechanism.is_orientation else "frame" if kinematics.reads_rotation else "position"
    )
    return f". For one {what} of the nominal machine {names[0]} has {first}, and {names[1]} has {second}"


def pair_at_one_frame(kinematics: Kinematics, index: int) -> tuple[Reals, Reals] | None:
    """Axis values of the nominal machine that differ in one branch and have the frame in common; the first byte first.

    None if no such pair was found.
    """
    machine = machine_with(kinematics, kinematics.unlimited_values)
    candidates = _candidates(machine)
    few = list(islice(candidates, _FEW))
    return _first_pair(machine, index, few) or _first_pair(machine, index, list(candidates))


def _first_pair(machine: Machine, index: int, candidates: Sequence[Reals]) -> tuple[Reals, Reals] | None:
    """The pair of the first candidate that has one. All are solved in one run: a root search takes as many passes for
    one row as for all.
    """
    count = len(machine.kinematics.branches)
    regular = [
        (axes, frame, own[:count])
        for axes, (status, frame, own) in zip(candidates, forward_at(machine, candidates), strict=True)
        if status is Status.OK and all(byte in _REGULAR for byte in own[:count])
    ]
    if not regular:
        return None
    every, frames, configurations = zip(*regular, strict=True)
    others = [(*own[:index], 3 - own[index], *own[index + 1 :]) for own in configurations]
    solutions = branches_at(machine, frames, others, every)
    for axes, own, found, status in zip(every, configurations, *solutions, strict=True):
        if status is Status.OK and max(abs(a - b) for a, b in zip(axes, found, strict=True)) > _APART:
            return (axes, found) if own[index] == 1 else (found, axes)
    return None


def _candidates(machine: Machine) -> Iterator[Reals]:
    """Axis values near the nominal ones, or near the home pose of a loop that turns its platform."""
    mechanism = machine.kinematics.mechanism
    start = machine.home if mechanism.home else tuple(j.nominal for j in mechanism.joints)
    turned = [_ANGLES[k % len(_ANGLES)] if j.axis_is_angle else 0.0 for k, j in enumerate(mechanism.joints)]
    for part in (1.0, 0.5, -1.0, 0.0):
        yield tuple(float(a + part * b) for a, b in zip(start, turned, strict=True))
    size = sum(abs(p.nominal) for p in mechanism.parameters if p.unit == "u") or 500.0
    spread = [_AROUND if j.axis_is_angle else 0.2 * size for j in mechanism.joints]
    for row in np.random.default_rng(1).uniform(-1.0, 1.0, (_TRIED, len(start))).tolist():
        yield tuple(float(a + r * s) for a, r, s in zip(start, row, spread, strict=True))
