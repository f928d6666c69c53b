"""Programs that several methods share: each is a private method, and calling it is a statement.

Its arguments are inputs and its results are outputs. A value in a structure (`a.a0`) is passed with the whole
structure.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

import sympy as sp

from derive.emit.braced import indented
from derive.emit.st.contract import Contract, Parameter, Signature
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import packed
from derive.emit.st.names import capitalized, parameter_name, type_name
from derive.emit.st.refusal import Refusal
from derive.ir.program import Call, Program, Status
from derive.ir.symbols import is_condition, is_count
from derive.ir.types import type_of

OUTCOME = "outcome"
"""The variable that holds the error that a call returns."""

_OWN_AXES = "axes["
"""How the spelling of a constant begins that a structure of an axis holds."""


def method_name(program: Program) -> str:
    """`find_platform` → `FindPlatform`."""
    return capitalized(program.name)


def signature_of(program: Program, spelled: Mapping[str, str], contract: Contract) -> Signature:
    """The signature of the private method of a shared program, given the spelling of what all methods can read."""
    parts = {spelled.get(s.name, s.name) for s in program.inputs}
    whole = {re.split(r"\W", text)[0] for text in parts if not (text.isidentifier() or text.startswith(_OWN_AXES))}
    axes = contract.signatures["Jacobian"].parameters[1]
    if not whole <= {axes.name}:
        raise TypeError(
            f"{program.name}: a shared program reads axis values and its own arguments, not {sorted(whole)}"
        )
    arguments = [
        Parameter("VAR_INPUT", parameter_name(s.name), type_name(type_of(s)))
        for s in program.inputs
        if s.name not in spelled
    ]
    results = [Parameter("VAR_OUTPUT", parameter_name(o.name), type_name(type_of(o.value))) for o in program.outputs]
    given = (axes, *arguments) if whole else tuple(arguments)
    return Signature(method_name(program), contract.spelling["types"]["error"], (*given, *results), "PRIVATE")


def own_names(program: Program, spelled: Mapping[str, str]) -> dict[str, str]:
    """The spelling of the arguments and the results of a shared program, which are parameters of its method."""
    own = [s.name for s in program.inputs if s.name not in spelled] + [o.name for o in program.outputs]
    return {name: parameter_name(name) for name in own}


def call_lines(call: Call, printer: StructuredText, refusal: Refusal) -> Iterator[str]:
    """The lines that call the method where it is wanted, and refuse if it does."""
    arguments = list(dict.fromkeys(_argument(name, value, printer) for name, value in call.given))
    results = [f"{parameter_name(name.name)} => {printer.name(name)}" for name in call.names]
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
    for name in call.names:  # where the method is not called
        yield f"{printer.name(name)} := {'FALSE' if is_condition(name) else '0' if is_count(name) else '0.0'};"
    yield from (f"IF {printer.print(call.wanted)} THEN", *indented(lines), "END_IF")


def _argument(name: sp.Symbol, value: sp.Expr, printer: StructuredText) -> str:
    text = printer.value(name, value)
    if value == name and "." in text and not text.startswith(_OWN_AXES):
        whole = text.split(".")[0]
        return f"{whole} := {whole}"
    return f"{parameter_name(name.name)} := {text}"


def _packed(head: str, arguments: Sequence[str], results: Sequence[str]) -> list[str]:
    """The lines of a call, with inputs and outputs on separate lines."""
    lines = [*packed([f"{a}," for a in arguments]), *packed([f"{r}," for r in results])]
    lines[-1] = lines[-1].removesuffix(",") + ");"
    return [head, *indented(indented(lines))]
