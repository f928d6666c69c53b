"""Reference calls: the answers of the methods of a block, by the reference interpreter, rounded."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from derive.equations.rotation_repair import rotation_program
from derive.ir.constants import COINCIDENT, EDGE, LARGEST, TIE
from derive.ir.interpret import Array, evaluate, repeats_counted, run
from derive.ir.one_row import Repeats
from derive.ir.program import Program, Status
from derive.ir.symbols import MAX_MISS, ROTATION_ENTRIES, branch_sign
from derive.kinematics.kinematics import Bytes, Kinematics, Reals
from derive.kinematics.parameters import TIE_OF_LENGTHS
from derive.kinematics.sampling import size_of
from derive.plate.plate import home_position, home_rotation

FRAME = ("x", "y", "z", *(r.name for r in ROTATION_ENTRIES))
_DECIMALS, _ROTATION_DECIMALS = 6, 9
"""Far coarser than rounding, and fine enough that a rotation is still one."""
_HIGHEST_BYTE = 3
_SMALL, _USUAL = 1, 100.0
"""A machine smaller than a usual one, a hundred units large, by more than so many powers of ten is given in metres."""


_KEPT = 1000
"""The number of cached answers: the self-test asks for an answer, and then for its effort."""


@dataclass(frozen=True, eq=False)
class Machine:
    """A machine: its parameters, the answer of Initialize, and the values that programs then read, by name."""

    kinematics: Kinematics
    given: Mapping[str, float]
    status: Status
    values: Mapping[str, Array]

    @cached_property
    def smaller(self) -> int:
        """The powers of ten by which the machine is smaller than a usual one."""
        size = 0.0 if self.status is not Status.OK else size_of(self.kinematics.mechanism, self.values, 0.0)
        return max(0, math.ceil(math.log10(_USUAL / size))) if size > 0.0 else 0

    @property
    def iterations(self) -> int:
        """The number of decimals that lengths need more than in millimetres, where the machine is given in metres."""
        return self.smaller if self.smaller > _SMALL else 0

    def rounded(self, values: Sequence[float], decimals: int = _DECIMALS) -> Reals:
        """Lengths as they are written: far coarser than rounding, without a negative zero."""
        return _rounded(values, decimals + self.iterations)

    @property
    def home(self) -> Reals:
        """Axis values of a platform at its home pose, in the branches that the parameters state."""
        mechanism = self.kinematics.mechanism
        position = (float(evaluate(v, self.values)) for v in home_position(mechanism))
        frame = (*position, *(float(evaluate(entry, self.values)) for entry in home_rotation(mechanism)))
        at_home = {b.name: self.given.get(b.home_flag, 0.0) for b in mechanism.branches}
        chosen = tuple(1 + int(at_home[b.name]) for b in mechanism.branches)
        configuration = (*chosen, *(0,) * len(mechanism.period_joints))
        return branches(self, frame, configuration, (0.0,) * len(mechanism.joints))[1][0]


def machine_with(kinematics: Kinematics, given: Mapping[str, float]) -> Machine:
    """The machine with these parameters."""
    values = {name: np.asarray(value, dtype=float) for name, value in given.items()}
    constants, status = run(kinematics.setup, values)
    return Machine(kinematics, dict(given), Status(status[()]), values | constants)


def forward(machine: Machine, axes: Reals) -> tuple[Status, Reals, Bytes]:
    """AxesToCartesian: position and rotation by rows, configuration."""
    return forward_counted(machine, axes)[0]


@lru_cache(_KEPT)
def forward_counted(machine: Machine, axes: Reals) -> tuple[tuple[Status, Reals, Bytes], Repeats]:
    """`forward`, and how often loops ran for it."""
    with repeats_counted() as repeats:
        return _forward(machine, axes), repeats


def _forward(machine: Machine, axes: Reals) -> tuple[Status, Reals, Bytes]:
    return forward_at(machine, [axes])[0]


def forward_at(machine: Machine, poses: Sequence[Reals]) -> list[tuple[Status, Reals, Bytes]]:
    """`forward` at several axis values, in one run."""
    kinematics = machine.kinematics
    found, status = _run(kinematics.forward, machine, _axes(machine, poses))
    order = {joint.name: index for index, joint in enumerate(kinematics.mechanism.joints)}
    periods = [(order[j.name], float(evaluate(j.turns, machine.values))) for j in kinematics.period_joints]

    def at(k: int) -> tuple[Status, Reals, Bytes]:
        if status[k] is not Status.OK:
            return status[k], (0.0,) * len(FRAME), (0,) * kinematics.configuration_size
        position, rotation = [float(found[n][k]) for n in FRAME[:3]], [float(found[n][k]) for n in FRAME[3:]]
        branches = (_branch_byte(float(found[f"branch_{b.name}"][k])) for b in kinematics.branches)
        turns = (_period(poses[k][i] * each) for i, each in periods)
        return Status.OK, (*machine.rounded(position), *_rounded(rotation, _ROTATION_DECIMALS)), (*branches, *turns)

    return [at(k) for k in range(len(poses))]


def inverse(machine: Machine, frame: Reals, configuration: Bytes, reference: Reals) -> tuple[Status, Reals]:
    """CartesianToAxes: the solution nearest to the reference, of the branches that the configuration admits."""
    return inverse_counted(machine, frame, configuration, reference)[0]


@lru_cache(_KEPT)
def inverse_counted(
    machine: Machine, frame: Reals, configuration: Bytes, reference: Reals
) -> tuple[tuple[Status, Reals], Repeats]:
    """`inverse`, and how often loops ran for it."""
    with repeats_counted() as repeats:
        return _inverse(machine, frame, configuration, reference), repeats


def _inverse(machine: Machine, frame: Reals, configuration: Bytes, reference: Reals) -> tuple[Status, Reals]:
    kinematics = machine.kinematics
    nothing = (0.0,) * len(reference)
    if any(byte > _HIGHEST_BYTE for byte in configuration[: len(kinematics.branches)]):
        return Status.BAD_INPUT, nothing
    _, solutions, statuses = branches(machine, frame, configuration, reference)
    solved = [found for found, status in zip(solutions, statuses, strict=True) if status is Status.OK]
    if not solved:
        return statuses[0], nothing
    chosen = _nearest(machine, solved, reference)
    limits = _run(kinematics.limits, machine, _axes(machine, [chosen]))[1][0]
    return (Status.OK, chosen) if limits is Status.OK else (limits, nothing)


def branches(
    machine: Machine, frame: Reals, configuration: Bytes, reference: Reals
) -> tuple[list[Bytes], list[Reals], list[Status]]:
    """Every branch that the configuration admits: its bytes, its axis values and its status, limits not tested."""
    count = len(machine.kinematics.branches)
    choices = [(1, 2) if byte in (0, 3) else (byte,) for byte in configuration[:count]]
    slots = sorted(product(*choices), key=lambda slot: slot[::-1])  # the first branch counts fastest
    given = [np.asarray(value) for value in (*frame, *reference, *map(float, configuration[count:]))]
    return slots, *_solved(machine, slots, given)


def branches_at(
    machine: Machine, frames: Sequence[Reals], slots: Sequence[Bytes], references: Sequence[Reals]
) -> tuple[list[Reals], list[Status]]:
    """The axis values and the status of one branch at each of several frames, in one run, without turns."""
    turns = [np.zeros(len(slots))] * len(machine.kinematics.period_joints)
    return _solved(machine, slots, [*np.array(frames).T, *np.array(references).T, *turns])


def _solved(machine: Machine, slots: Sequence[Bytes], given: Sequence[Array]) -> tuple[list[Reals], list[Status]]:
    """Axis values and status of every row. given: frame, references and turns, of all rows or of each."""
    kinematics, joints = machine.kinematics, machine.kinematics.mechanism.joints
    names = (*FRAME, *(j.reference.name for j in joints), *(j.turn.name for j in kinematics.period_joints))
    values, refused = dict(zip(names, given, strict=True)), np.full(len(slots), Status.OK, dtype=object)
    if kinematics.reads_rotation:
        made, refused[:] = run(rotation_program(), {n: values[n] for n in FRAME[3:]})
        values |= made
    signs = 3.0 - 2.0 * np.array(slots).reshape(len(slots), -1)
    values |= {branch_sign(b.name).name: signs[:, k] for k, b in enumerate(kinematics.branches)}
    nothing = (0.0,) * len(joints)
    if not np.any(refused == Status.OK):
        return [nothing] * len(slots), list(refused)
    found, status = _run(kinematics.branch, machine, values | {"": np.zeros(len(slots))})
    status = np.where(refused == Status.OK, status, refused)
    rows = [[float(found[j.axis.name][k]) for j in joints] for k in range(len(slots))]
    return [machine.rounded(r) if s is Status.OK else nothing for r, s in zip(rows, status, strict=True)], list(status)


def fitted(machine: Machine, poses: Sequence[Reals]) -> list[Reals]:
    """Axis values at which surplus rods fit the pose of the others, where there is one: those of a loop without any are
    unchanged.
    """
    kinematics = machine.kinematics
    surplus = [j in kinematics.mechanism.surplus_joints for j in kinematics.mechanism.joints]
    if not any(surplus):
        return list(poses)
    loose = with_any_miss(machine)
    found = [(k, *pose) for k, (status, *pose) in enumerate(forward_at(loose, poses)) if status is Status.OK]
    if not found:
        return list(poses)
    rows, frames, own = zip(*found, strict=True)
    slots = [configuration[: len(kinematics.branches)] for configuration in own]
    axes, statuses = branches_at(loose, frames, slots, [poses[k] for k in rows])
    lengths = {k: row for k, row, status in zip(rows, axes, statuses, strict=True) if status is Status.OK}
    chosen = (zip(lengths.get(k, pose), pose, surplus, strict=True) for k, pose in enumerate(poses))
    return [tuple(length if is_surplus else value for length, value, is_surplus in one) for one in chosen]


def with_any_miss(machine: Machine) -> Machine:
    """The machine with surplus rods that may have any length."""
    if not machine.kinematics.mechanism.surplus:
        return machine
    return machine_with(machine.kinematics, {**machine.given, MAX_MISS: float(LARGEST)})


def are_inside(machine: Machine, axes: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Whether axis values, by the names that programs have for them, are inside the limits of the machine."""
    status = _run(machine.kinematics.limits, machine, axes)[1]
    return np.asarray(status == Status.OK, dtype=bool)


def margins(machine: Machine, poses: Sequence[Reals]) -> Array:
    """The margins of IsSingularity by rows, a column for every pose; NaN if there is none."""
    kinematics = machine.kinematics
    found, status = _run(kinematics.singularity, machine, _axes(machine, poses))
    rows = [found[m.name] for m in kinematics.margins] or [np.ones(len(poses))]
    return np.where(np.asarray(status == Status.OK, dtype=bool), np.stack(rows), np.nan)


def _nearest(machine: Machine, solved: Sequence[Reals], reference: Reals) -> Reals:
    """The nearest solution; of equally near ones, that of the lowest slot."""
    kinematics, tie = machine.kinematics, float(machine.values.get(TIE_OF_LENGTHS.name, TIE))
    compared = [k for k, j in enumerate(kinematics.mechanism.joints) if j in kinematics.distance_joints]
    best, least = solved[0], np.inf
    for solution in solved:
        distance = sum((solution[k] - reference[k]) ** 2 for k in compared)
        if distance < least - tie:
            best, least = solution, distance
    return best


def _run(
    program: Program, machine: Machine, values: Mapping[str, Array]
) -> tuple[dict[str, Array], NDArray[np.object_]]:
    return run(program, {**machine.values, **values})


def _axes(machine: Machine, poses: Sequence[Reals]) -> dict[str, Array]:
    """Axis values by name, a row for every pose, also of a mechanism without axes."""
    columns = np.array(poses, dtype=float).reshape(len(poses), -1)
    return {j.axis.name: columns[:, k] for k, j in enumerate(machine.kinematics.mechanism.joints)} | {
        "": np.zeros(len(poses))
    }


def _branch_byte(margin: float) -> int:
    return 3 if abs(margin) <= float(COINCIDENT) else 1 if margin > 0 else 2


def _period(axis: float) -> int:
    turns = int(np.floor((axis + 180.0 + float(EDGE)) / 360.0))
    number = turns + 1 if turns >= 0 else turns
    return number if abs(number) <= 127 else 0


def _rounded(values: Sequence[float], decimals: int = _DECIMALS) -> Reals:
    return tuple(round(v, decimals) + 0.0 for v in values)  # without a negative zero
