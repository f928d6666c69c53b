"""The self-test of a function block: tables of calls and expected answers, and the program that runs all self-tests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.description.mechanism import Parameter, Role
from derive.emit.softmotion.block import Block
from derive.emit.softmotion.inputs import inputs, parameter_input
from derive.emit.st.expression import literal
from derive.emit.st.layout import INSIDE, WIDTH, packed
from derive.ir.program import Status
from derive.kinematics.kinematics import Called, Case, Kinematics, Reals, SelfTest

FOLDER = "selftest"
PROGRAM = "PRG_SoftkinSelfTest"
TOLERANCE = 2e-6
"""The tolerance of a number that is rounded to 6 decimals."""
_NUMBERS = {status: number for number, status in enumerate(Status)}
_NO_FRAME = (0.0,) * 12
_LINE, _LINE_OF_A_CALL = WIDTH - 2 * INSIDE - len("];"), WIDTH - 3 * INSIDE
"""The columns of a line of values in a declaration, and of inputs in a call."""


@dataclass(frozen=True)
class Table:
    """A constant array with the lines of its values."""

    name: str
    type: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Test:
    """The values that the template of a self-test reads."""

    name: str
    block: str
    count: int
    axes: int
    bytes: int
    inputs: tuple[str, ...]
    """The lines of the call that gives a machine its inputs: those that differ between machines, or from their
    defaults."""
    tables: tuple[Table, ...]


def test_of(kinematics: Kinematics, block: Block) -> Test | None:
    """The self-test of a block; None if no cases were made."""
    found = kinematics.self_test
    if found is None:
        return None
    axes, size = len(block.axes), kinematics.configuration_size
    given = _given(kinematics.parameters, inputs(kinematics).names, found)
    differing = [values for values in given.values() if len(set(values)) > 1]
    machines = [_table("MACHINES", "LREAL", list(zip(*differing, strict=True)))] if differing else []
    return Test(
        name=f"{block.name}_SelfTest",
        block=block.name,
        count=len(found.cases),
        axes=axes,
        bytes=size,
        inputs=tuple(_inputs(given)),
        tables=(*machines, *_tables(found.cases, axes, size)),
    )


def _given(parameters: Sequence[Parameter], names: Mapping[str, str], test: SelfTest) -> dict[str, tuple[str, ...]]:
    """The inputs that a machine sets, each with its values in all machines. All but numbers are the same in all."""
    found = {}
    for parameter in parameters:
        given = parameter_input(parameter, names[parameter.name])
        values = tuple(stated(parameter, machine) for machine in test.machines)
        if set(values) != {given.default}:
            found[given.name] = values
    return found


def _inputs(given: Mapping[str, tuple[str, ...]]) -> list[str]:
    """The lines of the call with these inputs."""
    pieces, column = [], 0
    for name, values in given.items():
        if len(set(values)) == 1:
            pieces.append(f"{name} := {values[0]}")
        else:
            pieces.append(f"{name} := MACHINES[entries[MACHINE], {column}]")
            column += 1
    return packed([f"{piece}," for piece in pieces[:-1]] + [f"{piece});" for piece in pieces[-1:]], _LINE_OF_A_CALL)


def stated(parameter: Parameter, machine: Mapping[str, float]) -> str:
    """The value that a machine gives a parameter, as a literal."""
    value = machine[parameter.name]
    if parameter.role is Role.FLAG:
        return "TRUE" if value else "FALSE"
    return str(int(value)) if parameter.role is Role.SIGN else literal(value)


def _tables(cases: Sequence[Case], axes: int, size: int) -> Iterator[Table]:
    """The table of cases, which refer to rows of the tables behind it; equal rows of values are stored once."""
    nothing = (0.0,) * axes
    poses: list[Reals] = list(dict.fromkeys(row or nothing for c in cases for row in (c.axes, c.reference)))
    frames: list[Reals] = list(dict.fromkeys(c.frame or _NO_FRAME for c in cases))
    rows = []
    for case in cases:
        answer = int(case.is_singular) if case.called is Called.SINGULARITY else _NUMBERS[case.status]
        places = poses.index(case.axes or nothing), poses.index(case.reference or nothing)
        frame, data = frames.index(case.frame or _NO_FRAME), case.configuration or (0,) * size
        numbers = case.called.value, case.machine, answer, *places, frame, case.budget
        rows.append([str(number) for number in (*numbers, *(byte % 256 for byte in data))])
    yield _table("CASES", "UDINT", rows)
    if axes:
        yield _table("AXIS_VALUES", "LREAL", [tuple(map(literal, row)) for row in poses])
    yield _table("FRAMES", "LREAL", [tuple(map(literal, row)) for row in frames])


def _table(name: str, kind: str, rows: Sequence[Sequence[str]]) -> Table:
    """A table with as many whole rows in every line as fit, two spaces apart; if none fits, its values fill the
    lines."""
    whole = [", ".join(row) for row in rows]
    together = (_LINE + 2) // (max(map(len, whole)) + 3)
    if together:
        lines = [",  ".join(whole[at : at + together]) for at in range(0, len(whole), together)]
        lines = [f"{line}," for line in lines[:-1]] + lines[-1:]
    else:
        lines = packed(", ".join(whole).split(" "), _LINE)
    return Table(name, f"ARRAY[0..{len(rows) - 1}, 0..{len(rows[0]) - 1}] OF {kind}", tuple(lines))
