"""The calls with which CartesianToAxes and its offset variant solve one branch by a private method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.softmotion.block import Block
from derive.emit.st.contract import Parameter, Signature
from derive.emit.st.expression import is_size_test, literal
from derive.emit.st.layout import INSIDE, WIDTH, indented, wrapped
from derive.emit.st.names import parameter_name, stored_name
from derive.emit.st.stretches import shares_of
from derive.ir.constants import (
    LARGEST,
    TIE,
)
from derive.ir.passes import with_inputs
from derive.ir.program import (
    Call,
    Let,
    Program,
    Require,
    shared,
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
    named: tuple[Argument, ...]
    """The arguments of the call where the configuration names every branch."""
    is_named: tuple[str, ...]
    """The lines of the condition that it does; none where there are no branches."""
    shares: tuple[tuple[str, str], ...]
    """The arrays through which branches share what they have in common, with their types."""
    checks: tuple[str, ...]
    """The lines of the condition under which an input is refused, once a call; none where no input is read."""
    refuses: bool
    """Whether a branch may have no solution."""
    admitted: tuple[str, ...]
    """The lines of the condition under which the branches of a slot are solved."""
    distance: tuple[str, ...]
    """The lines that compute the squared distance from the reference."""
    tie: str
    """The difference up to which two squared distances count as equal."""


def branch_call(
    public: Signature, program: Program, kinematics: Kinematics, block: Block, tests: tuple[str, ...]
) -> BranchCall:
    """The call of one branch in a public method. The private method has the parameters that its program reads."""
    checked, read = ({symbol.name for symbol in p.reads()} for p in (program, without_checks(program)))
    axes, *constant = (p for p in public.parameters if p.name != "cd")
    reads_matrix = any(f"r{r}{c}" in read for r in (1, 2, 3) for c in (1, 2, 3))
    if reads_matrix:
        constant.append(Parameter("VAR_IN_OUT CONSTANT", "rot", "ARRAY[1..3, 1..3] OF LREAL"))
    if not any(j.reference.name in read for j in kinematics.mechanism.joints):
        constant = [p for p in constant if p.name != "aRef"]
    if not read & {"x", "y", "z"}:
        constant = [p for p in constant if p.name not in ("f", "v_MCS")]
    inputs = [a for a in _open_inputs(kinematics, block) if a[0] in read]
    of_bytes = {f"sigma_{b.name}": f"3 - 2*BYTE_TO_INT(cd.abyData[{b.byte}])" for b in block.branches}
    numbers = [Parameter("VAR_INPUT", parameter_name(name), "INT") for name, _ in inputs]
    arrays = () if (shares := shares_of(without_checks(program))) is None else shares.parameters
    arguments, named = (
        tuple(Argument(name, name) for name, _ in arrays)
        + tuple(Argument(p.name, p.name) for p in constant)
        + tuple(Argument(parameter_name(name), v) for name, v in given)
        for given in (inputs, [(name, of_bytes.get(name, value)) for name, value in inputs])
    )
    method = "SolveOffsetBranch" if public.name.endswith("_Offset") else "SolveBranch"
    passed = (Parameter("VAR_IN_OUT", name, kind) for name, kind in arrays)
    signature = Signature(method, public.returns, (axes, *passed, *constant, *numbers), "PRIVATE")
    return BranchCall(
        method=method,
        signature=signature,
        arguments=arguments,
        reads_matrix=reads_matrix,
        named=named,
        is_named=_is_named(block),
        shares=arrays,
        checks=tests,
        refuses=_refuses(without_checks(program)),
        admitted=_admitted(block),
        distance=_distance(kinematics, block, checked),
        tie=_tie(kinematics),
    )


def checks(program: Program) -> tuple[Require, ...]:
    """The first conditions of a program, that its inputs are numbers: they are tested once a call."""
    sizes = (isinstance(s, Require) and all(map(is_size_test, sp.And.make_args(s.condition))) for s in program.body)
    count = next((place for place, is_size in enumerate(sizes) if not is_size), len(program.body))
    return tuple(s for s in program.body[:count] if isinstance(s, Require))


def _refuses(program: Program) -> bool:
    """Whether a program, or one that it calls, may refuse."""
    return any(not isinstance(s, Let) for p in (program, *shared([program])) for s in p.body if not isinstance(s, Call))


def without_checks(program: Program) -> Program:
    """The program behind these conditions."""
    return with_inputs(replace(program, body=program.body[len(checks(program)) :]))


def _open_inputs(kinematics: Kinematics, block: Block) -> Iterator[tuple[str, str]]:
    for branch in block.branches:
        yield f"sigma_{branch.name}", f"3 - 2*{branch.choice}"
    for joint, period in zip(kinematics.period_joints, block.periods, strict=True):
        yield joint.turn.name, f"Softkin_PeriodOfByte(cd.abyData[{period.byte}])"


def _is_named(block: Block) -> tuple[str, ...]:
    parts = [f"(cd.abyData[{b.byte}] = {number})" for b in block.branches for number in (1, 2)]
    pairs = [f"({one} OR {other})" for one, other in zip(parts[::2], parts[1::2], strict=True)]
    if len(pairs) == 1:
        return (f"IF {pairs[0][1:-1]} THEN",)
    return tuple(wrapped(f"IF {' AND '.join(pairs)} THEN")) if pairs else ()


def _admitted(block: Block) -> tuple[str, ...]:
    parts = [f"Softkin_AdmitsBranch(cd.abyData[{b.byte}], {b.choice})" for b in block.branches]
    return tuple(wrapped(f"IF {' AND '.join(parts)} THEN", WIDTH - 2 * INSIDE))  # inside of ELSE and FOR


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
    largest = literal(float(LARGEST))
    numbers = " AND ".join(f"({reference} >= -{largest}) AND ({reference} <= {largest})" for reference in unread)
    return (*wrapped(f"IF {numbers} THEN", WIDTH - 4 * INSIDE), *indented(lines), "END_IF")
