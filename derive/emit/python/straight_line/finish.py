"""The last steps of all branches: every axis on its turn, and inside its limits."""

from __future__ import annotations

from dataclasses import dataclass

from derive.description.mechanism import Joint
from derive.emit.python.layout import tuple_of
from derive.ir.program import Program
from derive.kinematics.kinematics import Kinematics
from derive.optimize.without_periods import turns_that_count


@dataclass(frozen=True)
class Function:
    """A function or a method: its name, arguments and result, its docstring, its statements."""

    name: str
    arguments: str
    kind: str
    summary: str
    body: list[str]
    constants: list[str]
    """The constants of the machine that it reads."""


def finish(kin: Kinematics, trusted: Program) -> Function | None:
    """The function that turns axes from trusted input into answers: it chooses turns and tests limits.

    trusted: one branch for such input. None if an axis value alone determines neither its turn nor its limits: with
    gear coupling the reference is compared joint by joint, and a limited quantity depends on several axes.
    """
    if kin.limited or any(joint.coupling != 0 or joint.is_geared for joint in kin.period_joints):
        return None
    joints = kin.mechanism.joints
    counted = {s.name for s in turns_that_count(trusted)}
    open_joints = [joint for joint in joints if joint.multi_turn and joint.axis.name not in counted]
    text = "Every slot of `branches` with the axes on their turns, or the number of its status; limits are tested."
    arguments = "found: tuple[Reals | int, ...], reference: Reals"
    body = [*_near(kin, open_joints), *_every_slot(joints, open_joints)]
    constants = [f"{word}_{joint.key}" for joint in open_joints for word in ("single", "mid")]
    constants += [f"{word}_{joint.key}" for joint in joints for word in ("lowest", "highest")]
    return Function("finish", arguments, "tuple[Reals | int, ...]", text, body, constants)


def _near(kin: Kinematics, open_joints: list[Joint]) -> list[str]:
    """The values next to which turns are chosen: the reference, or the middle of limits that hold one value."""
    if not open_joints:
        return []
    targets = [joint.reference.name if joint in open_joints else "_" for joint in kin.mechanism.joints]
    chosen = (f"near_{j.key} = mid_{j.key} if single_{j.key} else {j.reference.name}" for j in open_joints)
    return [f"{', '.join(targets)}{',' if len(targets) == 1 else ''} = reference", *chosen]


def _every_slot(joints: tuple[Joint, ...], open_joints: list[Joint]) -> list[str]:
    names = [joint.axis.name for joint in joints]
    turned: list[str] = []
    for joint in open_joints:
        axis, near = joint.axis.name, f"near_{joint.key}"
        turned += [
            f"if not FIRST_TURN <= {axis} - {near} < SECOND_TURN:",
            f"    {axis} = nearest_period({axis}, {near})",
        ]
    inside = " and ".join(f"lowest_{joint.key} <= {joint.axis.name} <= highest_{joint.key}" for joint in joints)
    every = [
        f"{', '.join(names)}{',' if len(names) == 1 else ''} = axes",
        *turned,
        f"if {inside}:",
        f"    axes = {tuple_of(names)}",
        "else:",
        "    axes = UNREACHABLE",
    ]
    return [
        "every: list[Reals | int] = []",
        "for axes in found:",
        "    if not isinstance(axes, int):",
        *(f"        {line}" for line in every),
        "    every.append(axes)",
        "return tuple(every)",
    ]
