"""The programs of a machine as functions, once for all languages without blocks: summary, arguments and results.

Arguments and results are arrays; a shape names the values in one, nested as the array is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from derive.equations.limits import value_of
from derive.equations.rotation_repair import rotation_program
from derive.ir.passes import normalise
from derive.ir.program import Output, Program, reason_expressions
from derive.ir.symbols import branch_sign, symbols_of
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.search.loop.find import FIND_ROOT

Shape = str | tuple["Shape", ...]
Arrays = tuple[tuple[str, tuple[Shape, ...]], ...]
"""Arrays by their names."""


def rotation_of(prefix: str = "") -> tuple[Shape, ...]:
    """The names of the entries of a rotation, by rows."""
    return tuple(tuple(f"{prefix}r{row}{column}" for column in "123") for row in "123")


POSITION: tuple[Shape, ...] = ("x", "y", "z")
ROTATION = rotation_of()
BIAS = "The acceleration of the rows of the Jacobian where the axes keep their speeds, per radian."
POSE: Arrays = (("position", POSITION), ("rotation", ROTATION))


@dataclass(frozen=True)
class Entry:
    """A program as a function."""

    key: str
    """Its name among the programs of a machine; empty if only other programs call it."""
    summary: str
    program: Program
    arguments: Arrays
    results: Arrays = ()
    """Nothing if the program only refuses."""

    @property
    def given(self) -> frozenset[str]:
        """The names of its arguments, besides the constants of the machine."""
        return frozenset(name for _, shape in self.arguments for name in names(shape))


def names(shape: Shape) -> Iterator[str]:
    """The names of a shape, in order."""
    if isinstance(shape, str):
        yield shape
    else:
        for part in shape:
            yield from names(part)


def read_by(program: Program) -> set[str]:
    """The names that a program itself reads, without those that only its called programs read."""
    return names_in(program) - {s.name for s in program.bound()}


def names_in(program: Program) -> set[str]:
    """The names that stand in the expressions of a program."""
    values = [e for s in program.body for e in (*s.children(), *reason_expressions(s))] + [
        o.value for o in program.outputs
    ]
    return {s.name for value in values for s in symbols_of(value)}


def search_of(kin: Kinematics) -> Program:
    """The program that finds a root, of a machine whose joint is searched."""
    return next(program for program in kin.shared if program.name == FIND_ROOT)


def axes_of(kin: Kinematics) -> Arrays:
    """The array of the axis values."""
    return (("axes", tuple(j.axis.name for j in kin.mechanism.joints)),)


def speeds_of(kin: Kinematics) -> Arrays:
    """The array of the speeds of the axes."""
    return (("speeds", tuple(j.speed.name for j in kin.mechanism.joints)),)


def margins_of(kin: Kinematics) -> Arrays:
    """The array of the signed margins of the branches."""
    return (("margins", tuple(f"branch_{b.name}" for b in kin.branches)),)


def choice_of(kin: Kinematics) -> Arrays:
    """The arrays that choose one solution: a sign for each branch, turns, and the reference."""
    return (
        ("signs", tuple(branch_sign(b.name).name for b in kin.branches)),
        ("turns", tuple(j.turn.name for j in kin.period_joints)),
        ("reference", tuple(j.reference.name for j in kin.mechanism.joints)),
    )


def matrix_of(kin: Kinematics, rows: int) -> tuple[Shape, ...]:
    """The entries of a matrix with a column for each axis."""
    return tuple(tuple(f"j{i}{k}" for k, _ in enumerate(kin.mechanism.joints, 1)) for i in range(1, rows + 1))


def rotation_entry() -> Entry:
    """The repair of a commanded rotation, which is the same for all mechanisms."""
    arguments, results = (("rotation", ROTATION),), (("repaired_rotation", ROTATION),)
    return Entry("", "The rotation as it is used.", rotation_program(), arguments, results)


def entries(kin: Kinematics) -> dict[str, Entry]:
    """The programs that a caller asks, by their keys, each behind those that it calls."""
    return {entry.key: entry for entry in _entries(kin)}


def _entries(kin: Kinematics) -> Iterator[Entry]:
    axes, choice = axes_of(kin), choice_of(kin)
    text = "Position, rotation and the signed margin of every branch."
    yield Entry("forward", text, kin.forward, axes, (*POSE, *margins_of(kin)))
    text = "The axes of one branch, on their turns; limits are not tested."
    yield Entry("branch", text, kin.branch, (*POSE, *choice), axes)
    yield Entry("limits", "The test of the limits.", kin.limits, axes)
    text = "The margins, each zero at its singularity."
    yield Entry("singularity", text, kin.singularity, axes, (("margins", tuple(m.name for m in kin.margins)),))
    rows = (("rows", matrix_of(kin, len(kin.rows))),)
    yield Entry("jacobian", "The Jacobian by rows, per radian.", kin.jacobian, axes, rows)
    accelerations = (("accelerations", tuple(o.name for o in kin.bias.outputs)),)
    yield Entry("bias", BIAS, kin.bias, (*axes, *speeds_of(kin)), accelerations)
    if kin.limited:
        values = [value_of(quantity) for quantity in kin.limited]
        program = normalise("quantities", kin.limits.lets(), [Output(v.name, v) for v in values])
        text = "The quantities beside the axes that have limits."
        yield Entry("quantities", text, program, axes, (("values", tuple(v.name for v in values)),))
    if kin.search_given is not None and kin.from_joints is not None:
        given = (("given", tuple(o.name for o in kin.search_given.outputs)),)
        yield Entry("search_given", "Arguments of the search.", kin.search_given, (*POSE, *choice), given)
        joints = (("joints", tuple(j.symbol.name for j in kin.mechanism.joints)),)
        yield Entry("from_joints", "The axis values of joint values.", kin.from_joints, (*joints, *choice[1:]), axes)


def shared_entries(kin: Kinematics, programs: Sequence[Program]) -> list[Entry]:
    """Programs that others call, each before its callers: argument and result are one array each."""
    found = [(program, tuple(o.name for o in program.outputs)) for program in programs]
    return [Entry("", f"{p.summary}.", p, (("given", arguments_of(p, kin)),), (("found", out),)) for p, out in found]


def arguments_of(program: Program, kin: Kinematics) -> tuple[str, ...]:
    """The inputs of a program that are no constants of the machine."""
    constants = {o.name for o in kin.setup.outputs}
    return tuple(s.name for s in program.inputs if s.name not in constants)
