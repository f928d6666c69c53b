"""What LinuxCNC did, judged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from prove.linuxcnc.machines import LETTERS, Stand
from prove.linuxcnc.session import BESIDE, Record, Stage
from prove.linuxcnc.twin import Rows, Twin, greatest

ALIKE = 1e-9
"""Degrees and millimetres: two programs that compute the same differ by rounding, on values up to a thousand."""
SPEEDS_ALIKE = 1e-3
"""Speeds are differences over two periods, in which joints and pose are accelerated."""
ON_THE_WAY = 0.01
"""Millimetres and degrees that the motors may leave the programmed way: they follow a spline."""
JUMP = 5.0
"""Degrees or millimetres that no joint moves within one period."""
FEWEST = 500
"""Rows that a program gives at least: fewer would say that it did not run."""
REFUSED = "fails kinematicsInverse"
STOPPED = "kinematicsInverse failed"
"""LinuxCNC's words."""
TOLD = "_kins: "
"""How a module begins what it says of a parameter."""
_NAN = float("nan")

Findings = Iterator[str]
"""What is wrong, one sentence each."""


@dataclass(frozen=True)
class Verdict:
    """A line of the table."""

    says: str
    samples: int
    joints: float
    """Greatest difference of a joint from the package's inverse kinematics."""
    poses: float
    """Greatest difference of a pose from the package's forward kinematics, where joints were moved one by one."""
    speeds: float
    """Greatest difference of a joint's speed from the package's Jacobian, as a part of the greatest speed."""
    off_the_way: float
    """How far the motors left the programmed way."""
    elbow_kept: bool | None
    """None where there is but one configuration."""
    refused: bool
    seconds: float
    faults: tuple[str, ...]
    """Empty where all is proven."""


def verdict(twin: Twin, record: Record) -> Verdict:
    """All questions about what a machine did."""
    says, stages = twin.machine.says, record.stages
    if record.fault:
        return Verdict(says, 0, _NAN, _NAN, _NAN, _NAN, False, False, record.seconds, (record.fault,))
    programs = [(stages["first"], twin.machine.first), (stages["second"], twin.machine.second)]
    joints, refusals = zip(*(twin.inverse_differs(*part, _in_program(part[0])) for part in programs), strict=True)
    ways, ends = zip(*(twin.way_differs(*part) for part in programs), strict=True)
    speeds = max(twin.speeds_differ(stage, _within_program(stage)) for stage, _ in programs)
    poses, impossible = twin.forward_differs(stages["bring"], _one_by_one(stages["bring"]))
    left = list(_leaving(twin, programs))
    reached = list(_reaching(twin, stages))
    faults = [
        *_bad(record.lost, "periods were not recorded"),
        *(fault for stage, _ in programs for fault in _incomplete(stage)),
        *_bad(sum(refusals), "poses of the programs are refused by the package"),
        *_bad(impossible, "joint values between the configurations have no pose"),
        *_above(max(joints), ALIKE, "a joint differs"),
        *_above(poses, ALIKE, "a pose differs"),
        *_above(speeds, SPEEDS_ALIKE, "a speed differs from that by the Jacobian"),
        *_above(max(ways), ON_THE_WAY, "the motors leave the programmed way"),
        *_above(max(ends), ON_THE_WAY, "the end of a line is missed"),
        *_ill_jogged(twin, stages["jog"]),
        *_spoilt(twin, stages),
        *_not_identical(twin, stages["identity"], BESIDE),
        *_not_identical(twin, stages["identity back"], -BESIDE),
        *_another_pose(stages["right parameter"], stages["kinematics again"]),
        *left,
        *reached,
    ]
    kept = not left if twin.robot.BRANCHES else None
    samples = sum(len(_in_program(stage)) for stage, _ in programs)
    return Verdict(
        says, samples, max(joints), poses, speeds, max(ways), kept, not reached, record.seconds, tuple(faults)
    )  # fmt: skip


def _bad(count: int, what: str) -> Findings:
    if count:
        yield f"{count} {what}"


def _above(value: float, most: float, what: str) -> Findings:
    if not value <= most:
        yield f"{what} by {value:.1e}"


def _in_program(stage: Stage) -> Rows:
    """The rows in which a program moves."""
    return np.flatnonzero(stage.in_program)


def _within_program(stage: Stage) -> Rows:
    """The rows before and behind which the program moves the joints."""
    moving = _moving(stage)
    return moving[np.isin(moving + 1, moving)]


def _moving(stage: Stage) -> Rows:
    """The rows in which a program moves the joints."""
    return np.flatnonzero(stage.in_program[1:] & _changes(stage)) + 1


def _changes(stage: Stage) -> NDArray[np.bool_]:
    """Where a row differs from the one before, without the first (N - 1,)."""
    changes: NDArray[np.bool_] = np.abs(np.diff(stage.joints, axis=0)).max(axis=1, initial=0.0) > 0.0
    return changes


def _one_by_one(stage: Stage) -> Rows:
    """The rows in which joints move one by one."""
    return np.flatnonzero(~(stage.in_program | stage.in_world)[1:] & _changes(stage)) + 1


def _incomplete(stage: Stage) -> Findings:
    """What says that a program did not run to its end."""
    if stage.said:
        yield f"the {stage.name} program: {'; '.join(stage.said)}"
    if len(_in_program(stage)) < FEWEST:
        yield f"the {stage.name} program has {len(_in_program(stage))} samples alone"
    yield from _above(greatest(np.diff(stage.joints, axis=0)), JUMP, f"the {stage.name} program: a joint jumps")


def _leaving(twin: Twin, programs: Iterable[tuple[Stage, Stand]]) -> Findings:
    """What says that a chosen configuration was not kept."""
    for stage, stand in programs:
        if twin.leaves_branches(stage, stand):
            yield f"the configuration changes in the {stage.name} program"
    if twin.robot.BRANCHES and twin.branches(twin.machine.first) == twin.branches(twin.machine.second):
        yield "both programs are in the same configuration"


def _reaching(twin: Twin, stages: Mapping[str, Stage]) -> Findings:
    """What says that an unreachable end was not refused, or that the machine did not go on behind it."""
    asked = stages["unreachable"]
    if not any(REFUSED in words for words in asked.said):
        yield f"what cannot be reached is not refused: {asked.said}"
    if np.ptp(asked.joints, axis=0).max() > 0.0:
        yield "the machine moves when it is asked for what it cannot reach"
    if not (asked.after["on"] and asked.after["homed"]):
        yield "asking for what it cannot reach switches the machine off"
    yield from _stuck(stages["behind it"])
    if twin.machine.through is not None:
        yield from _not_stopped(stages)


def _ill_jogged(twin: Twin, stage: Stage) -> Findings:
    """What says that joints do not follow where the pose is jogged."""
    rows = np.flatnonzero(stage.in_world[1:] & _changes(stage)) + 1
    differs, refusals = twin.inverse_differs(stage, twin.machine.second, rows)
    yield from _above(differs, ALIKE, "the pose is jogged: a joint differs")
    yield from _bad(refusals, "poses are refused by the package where the pose is jogged")
    yield from _stuck(stage)


def _spoilt(twin: Twin, stages: Mapping[str, Stage]) -> Findings:
    """What says that a parameter that is not allowed changed the machine, or was not told."""
    for name, is_told in (("wrong parameter", True), ("right parameter", False), ("kinematics again", False)):
        stage = stages[name]
        if stage.after["parameters refused"] != is_told:
            yield f"{name}: the pin parameters-refused says {stage.after['parameters refused']}"
        differs, refusals = twin.inverse_differs(stage, twin.machine.second, _moving(stage))
        yield from _above(differs, ALIKE, f"{name}: a joint differs")
        yield from _bad(refusals, f"poses are refused by the package, {name}")
        yield from _stuck(replace(stage, said=[words for words in stage.said if not is_told or TOLD not in words]))


def _not_identical(twin: Twin, stage: Stage, by: float) -> Findings:
    """What says that letters are not joints where identity is chosen."""
    columns = [LETTERS.index(letter) for letter in twin.machine.letters]
    rows = _moving(stage)
    yield from _above(greatest(stage.poses[rows][:, columns] - stage.joints[rows]), ALIKE, "identity: a joint differs")
    moved = np.array(stage.after["joints"]) - np.array(stage.before["joints"])
    yield from _above(greatest(moved - by), ON_THE_WAY, "identity: a joint misses its end")


def _another_pose(before: Stage, back: Stage) -> Findings:
    """What says that the machine has other words for its pose when it comes back from identity to the same joints."""
    moved = greatest(np.array(back.before["pose"]) - np.array(before.after["pose"]))
    yield from _above(moved, ON_THE_WAY, "back from identity, the pose differs")


def _not_stopped(stages: Mapping[str, Stage]) -> Findings:
    """What says that the machine did not stop at the edge of its workspace, or did not go on behind that."""
    asked = stages["through"]
    if STOPPED not in asked.said:
        yield f"a line that leaves the workspace is not stopped: {asked.said}"
    yield from _above(float(np.abs(np.diff(asked.joints, axis=0)).max()), JUMP, "a joint jumps at the edge")
    if not asked.after["homed"]:
        yield "the machine loses its home at the edge of the workspace"
    yield from _stuck(stages["behind that"])


def _stuck(stage: Stage) -> Findings:
    """What says that the line behind a refusal was not run."""
    moved = np.abs(np.array(stage.after["pose"]) - np.array(stage.before["pose"])).max() > 1.0
    if stage.said or not moved:
        yield f"{stage.name} the machine does not go on: {'; '.join(stage.said)}"
