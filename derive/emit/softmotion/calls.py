"""The calls with which CartesianToAxes and its offset variant solve one branch by a private method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from derive.emit.softmotion.block import Block
from derive.emit.st.contract import Parameter, Signature
from derive.emit.st.expression import literal
from derive.emit.st.layout import indented, wrapped
from derive.emit.st.names import parameter_name, stored_name
from derive.ir.constants import (
    TIE,
)
from derive.ir.program import (
    Program,
)
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import TIE_OF_LENGTHS, chooses_by_lengths


@dataclass(frozen=True)
class Argument:
    """A named argument of the call; the axes that the call writes are not among them."""

    name: str
    value: str


@dataclass(frozen=True)
class BranchCall:
    """The private method, its call, and the choice among its solutions."""

    method: str
    signature: Signature
    arguments: tuple[Argument, ...]
    reads_matrix: bool
    admitted: tuple[str, ...]
    """The lines of the condition under which the branches of a slot are solved."""
    distance: tuple[str, ...]
    """The lines that compute the squared distance from the reference."""
    tie: str
    """The difference up to which two squared distances count as equal."""


def branch_call(public: Signature, program: Program, kinematics: Kinematics, block: Block) -> BranchCall:
    """The call of one branch in a public method. The private method has the parameters that its program reads."""
    read = {symbol.name for symbol in program.reads()}
    axes, *constant = (p for p in public.parameters if p.name != "cd")
    reads_matrix = any(f"r{r}{c}" in read for r in (1, 2, 3) for c in (1, 2, 3))
    if reads_matrix:
        constant.append(Parameter("VAR_IN_OUT CONSTANT", "rot", "ARRAY[1..3, 1..3] OF LREAL"))
    if not any(j.reference.name in read for j in kinematics.mechanism.joints):
        constant = [p for p in constant if p.name != "aRef"]
    if not read & {"x", "y", "z"}:
        constant = [p for p in constant if p.name not in ("f", "v_MCS")]
    inputs = [a for a in _open_inputs(kinematics, block) if a[0] in read]
    numbers = [Parameter("VAR_INPUT", parameter_name(name), "INT") for name, _ in inputs]
    arguments = [Argument(p.name, p.name) for p in constant]
    arguments += [Argument(parameter_name(name), value) for name, value in inputs]
    method = "SolveOffsetBranch" if public.name.endswith("_Offset") else "SolveBranch"
    signature = Signature(method, public.returns, (axes, *constant, *numbers), "PRIVATE")
    distance, tie = _distance(kinematics, block, read), _tie(kinematics)
    return BranchCall(method, signature, tuple(arguments), reads_matrix, _admitted(block), distance, tie)


def _open_inputs(kinematics: Kinematics, block: Block) -> Iterator[tuple[str, str]]:
    for branch in block.branches:
        yield f"sigma_{branch.name}", f"3 - 2*{branch.choice}"
    for joint, period in zip(kinematics.period_joints, block.periods, strict=True):
        yield joint.turn.name, f"Softkin_PeriodOfByte(cd.abyData[{period.byte}])"


def _admitted(block: Block) -> tuple[str, ...]:
    parts = [f"Softkin_AdmitsBranch(cd.abyData[{b.byte}], {b.choice})" for b in block.branches]
    return tuple(wrapped(f"IF {' AND '.join(parts)} THEN"))


def _tie(kinematics: Kinematics) -> str:
    lengths = chooses_by_lengths(kinematics.mechanism)
    return stored_name(TIE_OF_LENGTHS.name) if lengths else literal(float(TIE))


def _distance(kinematics: Kinematics, block: Block, read: set[str]) -> tuple[str, ...]:
    """The lines that compute the distance from the reference. They refuse a reference that is no number, unless the
    branch has done so.
    """
    fields = {axis.name: axis.field for axis in block.axes}
    differences = [f"(candidate.{fields[j.name]} - aRef.{fields[j.name]})" for j in kinematics.distance_joints]
    if not differences:
        return ()  # one branch: there is nothing to choose
    first, *more = [f"{d}*{d}" for d in differences]
    lines = [f"distance := {first}", *(f"    + {term}" for term in more)]
    lines[-1] += ";"
    unread = [f"aRef.{fields[j.name]}" for j in kinematics.distance_joints if j.reference.name not in read]
    if not unread:
        return tuple(lines)
    numbers = " AND ".join(f"Softkin_IsNumber({reference})" for reference in unread)
    return (*wrapped(f"IF {numbers} THEN"), *indented(lines), "END_IF")
