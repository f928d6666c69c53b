"""The self-test of a function block: tables of calls and expected answers, and the program that runs all self-tests."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.description.mechanism import Parameter, Role
from derive.emit.softmotion.block import Block
from derive.emit.softmotion.inputs import inputs, parameter_input
from derive.emit.st.expression import literal
from derive.emit.st.layout import packed
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.reference_cases import Bytes, Called, Case, Reals, SelfTest

FOLDER = "selftest"
PROGRAM = "PRG_SoftkinSelfTest"
_TOLERANCE = 2e-6
"""The tolerance of a number that is rounded to 6 decimals."""
_NUMBERS = {status: number for number, status in enumerate(Status)}
_NO_FRAME = (0.0,) * 12


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
    tolerance: str
    fields: tuple[str, ...]
    bytes: int
    machines: tuple[tuple[tuple[str, str], ...], ...]
    """For every machine the values of the inputs that differ between machines, or from their defaults."""
    tables: tuple[Table, ...]


def test_of(kinematics: Kinematics, block: Block) -> Test | None:
    """The self-test of a block; None where no cases were made."""
    found = kinematics.self_test
    if found is None:
        return None
    size = kinematics.configuration_size
    return Test(
        name=f"{block.name}_SelfTest",
        block=block.name,
        count=len(found.cases),
        tolerance=literal(_TOLERANCE),
        fields=tuple(axis.field for axis in block.axes),
        bytes=size,
        machines=tuple(_inputs(kinematics.parameters, inputs(kinematics).names, found)),
        tables=tuple(_tables(found.cases, len(block.axes), size)),
    )


def _inputs(
    parameters: Sequence[Parameter], names: Mapping[str, str], test: SelfTest
) -> Iterator[tuple[tuple[str, str], ...]]:
    """The inputs of every machine with their values: each machine sets all inputs that any machine sets."""
    spelled = [{p.name: _value(p, machine) for p in parameters} for machine in test.machines]
    given = [p for p in parameters if any(values[p.name] != parameter_input(p, "").default for values in spelled)]
    for values in spelled:
        yield tuple((names[p.name], values[p.name]) for p in given)


def _value(parameter: Parameter, machine: Mapping[str, float]) -> str:
    value = machine[parameter.name]
    if parameter.role is Role.FLAG:
        return "TRUE" if value else "FALSE"
    return str(int(value)) if parameter.role is Role.SIGN else literal(value)


def _tables(cases: Sequence[Case], axes: int, size: int) -> Iterator[Table]:
    """The table of cases, which refer to rows of the tables behind it; equal rows of values are stored once."""
    nothing = (0.0,) * axes
    poses: list[Reals] = list(dict.fromkeys(row or nothing for c in cases for row in (c.axes, c.reference)))
    frames: list[Reals] = list(dict.fromkeys(c.frame or _NO_FRAME for c in cases))
    data: list[Bytes] = list(dict.fromkeys(c.configuration or (0,) * size for c in cases))
    rows = []
    for case in cases:
        answer = int(case.is_singular) if case.called is Called.SINGULARITY else _NUMBERS[case.status]
        places = poses.index(case.axes or nothing), poses.index(case.reference or nothing)
        more = frames.index(case.frame or _NO_FRAME), data.index(case.configuration or (0,) * size)
        rows.append(tuple(map(str, (case.called.value, case.machine, answer, *places, *more))))
    yield _table("CASES", "INT", rows)
    yield _column("OPERATIONS", "UDINT", [str(case.operations) for case in cases])
    if axes:
        yield _table("AXIS_VALUES", "LREAL", [tuple(map(literal, row)) for row in poses])
    yield _table("FRAMES", "LREAL", [tuple(map(literal, row)) for row in frames])
    if size:
        yield _table("CONFIGURATIONS", "BYTE", [tuple(str(byte % 256) for byte in row) for row in data])


def _table(name: str, kind: str, rows: Sequence[Sequence[str]]) -> Table:
    """A table in which every row begins on a new line."""
    lines = [line for row in rows for line in packed([f"{value}," for value in row])]
    lines[-1] = lines[-1].removesuffix(",")
    return Table(name, f"ARRAY[0..{len(rows) - 1}, 0..{len(rows[0]) - 1}] OF {kind}", tuple(lines))


def _column(name: str, kind: str, values: Sequence[str]) -> Table:
    """A table of one value a row."""
    lines = packed([f"{value}," for value in values])
    lines[-1] = lines[-1].removesuffix(",")
    return Table(name, f"ARRAY[0..{len(values) - 1}] OF {kind}", tuple(lines))
