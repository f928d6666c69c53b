"""Arguments of calls: their names, their number, their types, and which of them are passed by reference."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import ast
from . import st_types as types
from .facts import BoundCall
from .faults import StError
from .writes import check_write, is_place, root

if TYPE_CHECKING:
    from .check_expressions import Expressions


def bind(
    expressions: Expressions,
    node: ast.Call,
    callee: types.Routine | types.Block,
    name: str,
    parameters: tuple[types.Variable, ...],
) -> None:
    """Check the arguments of a call and note them in the order of the parameters."""
    given: dict[str, ast.Expression] = {}
    positional = [p for p in parameters if p.scope != "VAR_OUTPUT"]
    for position, argument in enumerate(node.arguments):
        if argument.name is None:
            if position >= len(positional):
                raise StError(argument.at, f"too many arguments for {name}")
            parameter = positional[position]
        else:
            parameter = _named(argument, name, parameters)
        if parameter.name.lower() in given:
            raise StError(argument.at, f"{parameter.name} of {name} is given twice")
        _check(expressions, argument, parameter)
        given[parameter.name.lower()] = argument.value
    bound = []
    for parameter in parameters:
        value = given.get(parameter.name.lower())
        if value is None and _is_needed(parameter, callee):
            raise StError(node.at, f"argument {parameter.name} of {name} is missing")
        bound.append((parameter, value))
    expressions.facts.calls[node] = BoundCall(callee, bound)


def _is_needed(parameter: types.Variable, callee: types.Routine | types.Block) -> bool:
    if parameter.scope == "VAR_IN_OUT":
        return True
    # An instance keeps the inputs it got before.
    return parameter.scope == "VAR_INPUT" and parameter.initial is None and isinstance(callee, types.Routine)


def _named(argument: ast.Argument, name: str, parameters: tuple[types.Variable, ...]) -> types.Variable:
    for parameter in parameters:
        if parameter.name.lower() == str(argument.name).lower():
            if argument.is_output != (parameter.scope == "VAR_OUTPUT"):
                arrow = "=>" if parameter.scope == "VAR_OUTPUT" else ":="
                raise StError(argument.at, f"{parameter.name} of {name} needs {arrow}")
            return parameter
    raise StError(argument.at, f"{name} has no parameter {argument.name}")


def _check(expressions: Expressions, argument: ast.Argument, parameter: types.Variable) -> None:
    value, facts = argument.value, expressions.facts
    if parameter.scope == "VAR_INPUT":
        expressions.must_fit(value, parameter.type)
        return
    given = expressions.type_of(value)
    if not is_place(value, facts):
        raise StError(argument.at, f"{parameter.name} needs a variable")
    if not _same(given, parameter.type):
        raise StError(argument.at, f"{parameter.name} is a {parameter.type.name}, not a {given.name}")
    variable = root(value, facts)
    if parameter.constant:
        _refuse_no_variable(argument, variable, parameter)
    else:
        check_write(value, expressions.scope, facts)
    if variable is not None and types.is_scalar(variable.type):
        facts.boxed.add(variable)


def _refuse_no_variable(argument: ast.Argument, variable: types.Variable | None, parameter: types.Variable) -> None:
    """Refuse for a VAR_IN_OUT CONSTANT what compilers disagree on: it takes a variable, its member or its element, and
    no constant, no result and nothing behind a pointer.
    """
    if variable is None or variable.scope == "RESULT":
        raise StError(argument.at, f"{parameter.name} needs a variable, its member or its element")
    if variable.constant and not variable.is_reference:
        raise StError(argument.at, f"{parameter.name} needs a variable: {variable.name} is a constant")


def _same(given: types.Type, wanted: types.Type) -> bool:
    if isinstance(given, types.Block) and isinstance(wanted, types.Block):
        return given.is_a(wanted)
    return given == wanted
