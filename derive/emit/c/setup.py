"""The setup program: it computes the constants of a machine from its parameters, or refuses these.

The shared source tests the range of each parameter, and computes the range of each axis.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from derive.description.mechanism import Role
from derive.emit.braced import block
from derive.emit.c.printer import C, member, number, type_of
from derive.emit.c.program import Body, Refusals, function_of
from derive.emit.inputs import Inputs
from derive.emit.setup import setup_of
from derive.equations.windows import Window
from derive.ir.constants import TIE
from derive.ir.program import Require
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import CHECK_LIMITS, TIE_OF_LENGTHS, WARNING_DISTANCE, chooses_by_lengths
from derive.report.reasons import Reasons

SEARCHED = "searched"
"""The constant that says whether the machine needs a root scan, where this depends on a parameter."""


@dataclass(frozen=True)
class Setup:
    """The function, and the constants that it computes: name → type."""

    lines: list[str]
    constants: Mapping[str, str]


def constants_read(kin: Kinematics) -> set[str]:
    """The constants that a machine needs besides those that its programs read."""
    found = {TIE_OF_LENGTHS.name} if chooses_by_lengths(kin.mechanism) else set()
    found |= {str(j.turns) for j in kin.period_joints if j.is_geared and not j.turns.is_number}
    return found | ({SEARCHED} if _may_be_searched(kin) else set())


def setup(kin: Kinematics, prefix: str, read: Collection[str], inputs: Inputs) -> Setup:
    """The function. read: the constants that other functions read; inputs: what the parameters are called."""
    found, printer = setup_of(kin, read), C(_members(kin, inputs))
    body = Body(Refusals(Reasons({}), printer))
    lines: list[str] = []
    values: dict[str, tuple[str, str]] = {}
    for step in found.steps():
        if isinstance(step, Window):
            lines += _window(found.windows.index(step), step, inputs, printer)
            values |= _window_values(step, read)
        elif isinstance(step, Require):
            lines += body.refusals.of_parameters(step, inputs)
        else:
            lines += body.lines([step])
    values |= {o.name: (type_of(o.value), printer.value(o.value, o.value)) for o in found.outputs()}
    head = [f"const {prefix}_parameters *p = parameters;", f"{prefix}_machine made;"]
    writes = [f"made.{member(name)} = {value};" for name, (_, value) in values.items()]
    tail = [f"made.softkin = (softkin_base){{{', '.join(_base(kin, values, inputs))}}};"]
    inner = [*head, *lines, *writes, *tail, f"*({prefix}_machine *)machine = made;", "return SOFTKIN_OK;"]
    name = "static softkin_status fill_machine(void *machine, const void *parameters, softkin_refusal *why)"
    summary = "The values that depend on the parameters alone, or why the parameters are refused."
    return Setup(function_of(summary, name, inner), {n: kind for n, (kind, _) in values.items()})


def _members(kin: Kinematics, inputs: Inputs) -> dict[str, str]:
    """The spelling of the parameters: real numbers, a flag that is not 0, a sign that is -1 or 1."""
    forms = {Role.FLAG: "(p->{} != 0.0)", Role.SIGN: "(int)p->{}"}
    return {p.name: forms.get(p.role, "p->{}").format(inputs.names[p.name]) for p in kin.parameters}


def _may_be_searched(kin: Kinematics) -> bool:
    return kin.mechanism.search is not None and kin.mechanism.search.where is not None


def _base(kin: Kinematics, values: Mapping[str, tuple[str, str]], inputs: Inputs) -> Iterator[str]:
    """The lines for the members that the structs of all machines begin with."""
    yield "0"
    yield f"p->{inputs.names[CHECK_LIMITS]} != 0.0"
    if _may_be_searched(kin):
        yield values[SEARCHED][1]
    else:
        yield "true" if kin.search_given is not None else "false"
    yield f"p->{inputs.names[WARNING_DISTANCE]}"
    yield values[TIE_OF_LENGTHS.name][1] if chooses_by_lengths(kin.mechanism) else number(TIE)


def _window(index: int, window: Window, inputs: Inputs, printer: C) -> list[str]:
    """The range of an axis. Invalid limits are refused, even where no program reads the range."""
    name, otherwise, lines = f"window_of_{window.key}", "NULL", list[str]()
    if window.fallback:
        condition, low, high = window.fallback[-1]
        lines.append(f"const double range_of_{window.key}[] = {{{printer.print(low)}, {printer.print(high)}}};")
        otherwise = f"range_of_{window.key}"
        if condition != sp.true:
            otherwise = f"{printer.print(condition)} ? {otherwise} : NULL"
    turns = printer.print(window.turns) if window.has_turns and window.turns != 1 else "0.0"
    lower, upper = (f"p->{inputs.names[end]}" for end in window.given)
    given = [f"&LIMITS[{index}]", lower, upper, f"p->{inputs.names[CHECK_LIMITS]} != 0.0", otherwise, turns,
             f"&{name}", f"&made.ends[{index}]", "why"]  # fmt: skip
    call = f"if (softkin_window_of({', '.join(given)}) != SOFTKIN_OK)"
    return [*lines, f"softkin_window {name};", *block(call, ["return SOFTKIN_NOT_INITIALIZED;"])]


def _window_values(window: Window, read: Collection[str]) -> dict[str, tuple[str, str]]:
    words = ("lowest", "highest", "single", "middle")
    return {
        output.name: ("bool" if word == "single" else "double", f"window_of_{window.key}.{word}")
        for word, output in zip(words, window.outputs, strict=False)
        if output.name in read
    }
