"""All branches as one C function: each statement once for the branches that share it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.description.mechanism import Joint
from derive.emit.braced import block
from derive.emit.c.functions import FRAME
from derive.emit.c.printer import C, status, type_of
from derive.emit.c.program import Body, Refusals, function_of, taken
from derive.emit.every_branch import EveryBranch, every_branch, is_unrolled, signs, without_doubts
from derive.emit.interface import read_by
from derive.ir.program import Require, Status
from derive.ir.symbols import REFUSAL, choices, suffixed, symbols_of
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import structured
from derive.report.reasons import Reasons

NAME = "find_every_branch"
MOST_SLOTS = 16
"""With more branches a straight line is long, and no longer the fastest way."""
_SUMMARY = (
    "Every branch on its turns, of good input; false where digits may be lost: there a branch by itself has an answer."
)
_HEAD = (
    "const void *machine, const softkin_frame *frame, const double *reference, softkin_status *statuses, double *axes"
)


@kept_by_identity(10)
def straight_line(kin: Kinematics) -> EveryBranch | None:
    """The program of all branches. None if each branch is solved by itself: without a straight line, or if a turn
    moves several axes.
    """
    if not is_unrolled(kin) or 2 ** len(kin.branches) > MOST_SLOTS:
        return None
    if any(joint.coupling != 0 or joint.is_geared for joint in kin.period_joints):
        return None
    return every_branch(kin, NAME)


def open_joints(kin: Kinematics, found: EveryBranch) -> list[Joint]:
    """The joints whose axes are still to be put on their turns."""
    return [j for j in kin.mechanism.joints if j.multi_turn and j.axis not in found.counted]


def constants_of_branches(kin: Kinematics) -> set[str]:
    """The constants of the machine that the function reads."""
    found = straight_line(kin)
    if found is None:
        return set()
    own = read_by(found.program) | {s.name for part in found.parts for s in symbols_of(part.value)}
    turns = {f"{word}_{joint.key}" for joint in open_joints(kin, found) for word in ("single", "mid")}
    return (own | turns) - {part.name.name for part in found.parts} - _given(kin).keys()


def every_branch_lines(kin: Kinematics, machine: str, stored: Mapping[str, str], reasons: Reasons) -> list[str]:
    """The function; nothing if there is no straight line."""
    found = straight_line(kin)
    if found is None:
        return []
    places, opened = _given(kin), open_joints(kin, found)
    members = {name: text for name, text in stored.items() if name not in places}
    printer = C(members)
    body = Body(_OfAll(reasons, printer, 2 ** len(kin.branches)))
    types = {s.name: type_of(s) for s in found.program.inputs}
    turned = {joint.reference.name: "double" for joint in opened}
    read = read_by(found.program) | turned.keys()
    inner = [
        f"const {machine} *k = machine;",
        *taken([(n, place) for n, place in places.items() if n in read], turned | types),
        *body.lines(found.parts),
        *body.lines(structured(found.program)),
        *(_near(joint, printer) for joint in opened),
        *_slots(kin, found, opened, printer),
        "return true;",
    ]
    if not any("k->" in line for line in inner):
        inner = inner[1:]
    return function_of(_SUMMARY, f"static bool {NAME}({_HEAD})", inner)


@dataclass(frozen=True)
class _OfAll(Refusals):
    """The refusals of a function in which each refuses all slots."""

    slots: int

    def lines(self, requires: Sequence[Require]) -> list[str]:
        return [line for require in requires for line in self._all(require)]

    def _all(self, require: Require) -> list[str]:
        answer = f"return softkin_refuse_all({status(require.otherwise)}, statuses, {self.slots});"
        if require.otherwise is Status.OK:
            answer = "return false;"
        return block(f"if (!({self.printer.conjunction([require.condition])}))", [answer])


def _given(kin: Kinematics) -> dict[str, str]:
    reference = {joint.reference.name: f"reference[{i}]" for i, joint in enumerate(kin.mechanism.joints)}
    return FRAME | reference


def _near(joint: Joint, printer: C) -> str:
    """The value next to which the turn of an axis is chosen: the reference, or the middle of narrow limits."""
    single, middle = (printer.members[f"{word}_{joint.key}"] for word in ("single", "mid"))
    return f"const double near_{joint.key} = {single} ? {middle} : {joint.reference.name};"


def _slots(kin: Kinematics, found: EveryBranch, opened: Sequence[Joint], printer: C) -> Iterator[str]:
    """The status and the axes of every slot."""
    values = {o.name: o.value for o in found.program.outputs}
    own = signs(without_doubts(kin))
    for slot, choice in enumerate(choices(len(own))):
        refusal = values[suffixed(REFUSAL, own, choice)]
        text = status(Status.OK) if refusal == 0 else f"(softkin_status)({printer.whole(refusal)})"
        yield f"statuses[{slot}] = {text};"
        for place, joint in enumerate(kin.mechanism.joints):
            axis = printer.print(values[suffixed(joint.axis.name, own, choice)])
            axis = f"softkin_on_turn({axis}, near_{joint.key})" if joint in opened else axis
            yield f"axes[{slot * len(kin.mechanism.joints) + place}] = {axis};"
