"""Programs that several methods share: each is a private method, and calling it is a statement.

Its arguments are inputs and its results are outputs; many results stand in a structure of the caller, and the pose at
which it begins in another one. A value in a structure (`a.a0`) is passed with the whole structure.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit.braced import indented
from derive.emit.st.contract import Contract, Parameter, Signature
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import packed
from derive.emit.st.names import capitalized, parameter_name, type_name
from derive.emit.st.refusal import Refusal
from derive.ir.program import Call, Program, Status
from derive.ir.symbols import ROTATION_ENTRIES, is_condition, is_count
from derive.ir.types import type_of

OUTCOME = "outcome"
"""The variable that holds the error that a call returns."""

_AXES = "a."
"""How the spelling of an axis value begins, which is handed on with all others."""
_OWN = ("axes[", "home.")
"""How the spellings of constants begin that structures of the block hold: of an axis, and the home pose."""
_MOST_OUTPUTS = 12
"""The most results that are outputs of their own: more than a position and a rotation stand in a structure."""
_ROTATION = frozenset(r.name for r in ROTATION_ENTRIES)
_START, TYPE_OF_START, FILLED = "start", "Softkin_Start", "startPose"
"""The parameter that holds the pose at which a program begins, its type, and the variable that a caller fills."""


@dataclass(frozen=True)
class Structure:
    """The structure that holds the results of a shared program: vectors, a rotation, and further values."""

    variable: str
    """The parameter, and the variable of every method that calls the program."""
    fields: Mapping[str, str]
    """The spelling of every result in the structure, by its neutral name."""
    types: Mapping[str, str]
    """The types of the fields by their names; `vector` as the contract spells it."""

    def type_in(self, block: str) -> str:
        """The name of its type, given that of the block."""
        return f"{block}_{capitalized(self.variable)}"


def structure_of(program: Program) -> Structure | None:
    """The structure of a shared program: `platform.v.dX` for `found_x` of `find_platform`. None for few results."""
    if len(program.outputs) <= _MOST_OUTPUTS:
        return None
    variable = program.name.split("_", 1)[-1]
    short = {o.name: re.sub(f"^(found|{variable})_", "", o.name) for o in program.outputs}
    fields, types = dict[str, str](), dict[str, str]()
    for output in program.outputs:
        name = short[output.name]
        stem, axis = name[:-1].rstrip("_"), name[-1]
        if {*short.values()} >= {name[:-1] + c for c in "xyz"}:
            field, part, kind = parameter_name(stem or "v"), f".d{axis.upper()}", "vector"
        elif name in _ROTATION and {*short.values()} >= _ROTATION:
            field, part, kind = "rot", f"[{name[1]}, {name[2]}]", "ARRAY[1..3, 1..3] OF LREAL"
        else:
            field, part, kind = parameter_name(name), "", type_name(type_of(output.value))
        fields[output.name], types[field] = field + part, kind
    return Structure(parameter_name(variable), fields, types)


def structures_of(programs: Iterable[Program]) -> tuple[tuple[Program, Structure], ...]:
    """The programs that hand over a structure, each with it."""
    found = ((program, structure_of(program)) for program in programs)
    return tuple((program, structure) for program, structure in found if structure is not None)


def method_name(program: Program) -> str:
    """`find_platform` → `FindPlatform`."""
    return capitalized(program.name)


def signature_of(program: Program, spelled: Mapping[str, str], contract: Contract, block: str = "") -> Signature:
    """The signature of the private method of a shared program, given the spelling of what all methods can read.
    block: the name of the block, which stands in the type of a structure.
    """
    parts = {spelled.get(s.name, s.name) for s in program.inputs}
    whole = {re.split(r"\W", text)[0] for text in parts if not (text.isidentifier() or text.startswith(_OWN))}
    axes = contract.signatures["Jacobian"].parameters[1]
    if not whole <= {axes.name}:
        raise TypeError(
            f"{program.name}: a shared program reads axis values and its own arguments, not {sorted(whole)}"
        )
    starts = fields_of_start(program)
    arguments = [
        Parameter("VAR_INPUT", parameter_name(s.name), type_name(type_of(s)))
        for s in program.inputs
        if s.name not in spelled and s.name not in starts
    ]
    start = [Parameter("VAR_IN_OUT CONSTANT", _START, TYPE_OF_START)] if starts else []
    given = (*([axes] if whole else []), *start, *arguments)
    results = [Parameter("VAR_OUTPUT", parameter_name(o.name), type_name(type_of(o.value))) for o in program.outputs]
    parameters = (*given, *results)
    if (structure := structure_of(program)) is not None:
        parameters = (Parameter("VAR_IN_OUT", structure.variable, structure.type_in(block)), *given)
    return Signature(method_name(program), contract.spelling["types"]["error"], parameters, "PRIVATE")


def own_names(program: Program, spelled: Mapping[str, str]) -> dict[str, str]:
    """The spelling of the arguments and the results of a shared program, which are parameters of its method."""
    arguments = {s.name: parameter_name(s.name) for s in program.inputs if s.name not in spelled}
    start = {name: f"{_START}{field}" for name, field in fields_of_start(program).items()}
    return arguments | start | result_names(program)


def fields_of_start(program: Program) -> dict[str, str]:
    """The fields of a pose by the names of the arguments that are one; empty without a part of a rotation."""
    fields = {f"begin_{c}": f".v.d{c.upper()}" for c in "xyz"}
    fields |= {f"begin_{r.name}": f".rot[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}
    names = {s.name for s in program.inputs}
    is_pose = not names.isdisjoint(f"begin_{name}" for name in _ROTATION)
    return {name: field for name, field in fields.items() if is_pose and name in names}


def fills_start(program: Program, printer: StructuredText) -> bool:
    """Whether a call in a program begins at a pose that no structure holds: a variable of the caller is filled."""
    return any(_start(call, printer)[1] for call in program.calls())


def _start(call: Call, printer: StructuredText) -> tuple[str, list[str]]:
    """The structure that holds the pose at which a call begins, and the lines that fill it; empty if it has no pose."""
    fields = fields_of_start(call.program)
    texts = {fields[s.name]: printer.value(s, value) for s, value in call.given if s.name in fields}
    held = {text.removesuffix(field) for field, text in texts.items() if text.endswith(field)}
    if len(held) == 1 and all(text.endswith(field) for field, text in texts.items()):
        return held.pop(), []
    lines = [f"{FILLED}{field} := {text};" for field, text in texts.items() if text != "0.0"]  # it begins with zeros
    return (FILLED if fields else ""), lines


def result_names(program: Program) -> dict[str, str]:
    """The spelling of the results of a shared program: outputs, or fields of a structure."""
    if (structure := structure_of(program)) is None:
        return {o.name: parameter_name(o.name) for o in program.outputs}
    return {name: f"{structure.variable}.{field}" for name, field in structure.fields.items()}


def call_lines(call: Call, printer: StructuredText, refusal: Refusal) -> Iterator[str]:
    """The lines that call the method where it is wanted, and refuse if it does. Where it is not called its results are
    false and zeros, as a structure is from the begin.
    """
    structure = structure_of(call.program)
    whole = [f"{structure.variable} := {structure.variable}"] if structure is not None else []
    start, filled = _start(call, printer)
    of_start = fields_of_start(call.program)
    given = [_argument(name, value, printer) for name, value in call.given if name.name not in of_start]
    arguments = list(dict.fromkeys((*whole, *given, *([f"{_START} := {start}"] if start else []))))
    yield from filled
    outputs = call.names if structure is None else ()
    results = [f"{parameter_name(name.name)} => {printer.name(name)}" for name in outputs]
    refused = [
        f"IF {OUTCOME} <> {refusal.errors[Status.OK.name]} THEN",
        *indented(refusal.of_call(call, OUTCOME)),
        "END_IF",
    ]
    refuses, name = call.program.refuses, method_name(call.program)
    lines = _packed(f"{OUTCOME} := {name}(" if refuses else f"{name}(", arguments, results)
    lines += refused if refuses else []
    if not call.is_conditional:
        yield from lines
        return
    for name in outputs:
        yield f"{printer.name(name)} := {'FALSE' if is_condition(name) else '0' if is_count(name) else '0.0'};"
    yield from (f"IF {printer.print(call.wanted)} THEN", *indented(lines), "END_IF")


def _argument(name: sp.Symbol, value: sp.Expr, printer: StructuredText) -> str:
    text = printer.value(name, value)
    if value == name and text.startswith(_AXES):
        whole = _AXES[:-1]
        return f"{whole} := {whole}"
    return f"{parameter_name(name.name)} := {text}"


def _packed(head: str, arguments: Sequence[str], results: Sequence[str]) -> list[str]:
    """The lines of a call, with inputs and outputs on separate lines."""
    lines = [*packed([f"{a}," for a in arguments]), *packed([f"{r}," for r in results])]
    lines[-1] = lines[-1].removesuffix(",") + ");"
    return [head, *indented(indented(lines))]
