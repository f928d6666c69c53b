"""The translation of a text with a note before every statement: which ones run is known at the cost of an
assignment each.
"""

import ast
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import CodeType, FunctionType
from typing import Any

RAN = "_ran"
"""The name of the flags of the lines in the translation."""


def marked_code(source: str, filename: str) -> dict[str, CodeType]:
    """The code of every function of a translation by its qualified name, with a note of the line before every
    statement.
    """
    tree = ast.parse(source, filename)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            _mark(node)
    found: dict[str, CodeType] = {}
    _collect(compile(tree, filename, "exec"), found)
    return found


def _mark(node: ast.AST) -> None:
    """Put notes into the bodies of a statement, and of the statements in them."""
    for name in ("body", "orelse", "finalbody"):
        statements = getattr(node, name, None)
        if isinstance(statements, list):
            for statement in statements:
                if not isinstance(statement, ast.FunctionDef):
                    _mark(statement)
            setattr(node, name, [part for statement in statements for part in (_note(statement), statement)])


def _note(statement: ast.stmt) -> ast.stmt:
    at = {name: getattr(statement, name) for name in ("lineno", "col_offset", "end_lineno", "end_col_offset")}
    line = ast.Constant(statement.lineno, **at)
    flag = ast.Subscript(ast.Name(RAN, ast.Load(), **at), line, ast.Store(), **at)
    return ast.Assign([flag], ast.Constant(True, **at), **at)


def _collect(code: CodeType, found: dict[str, CodeType]) -> None:
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            found[constant.co_qualname] = constant
            _collect(constant, found)


@contextmanager
def marked(names: dict[str, Any], codes: Mapping[str, CodeType], ran: list[bool]) -> Iterator[None]:
    """The functions among the names of a translation, and those of its classes, with these codes;
    afterwards as before. Each line that runs sets its flag.
    """
    before = {function: function.__code__ for function in _functions(names) if function.__code__.co_qualname in codes}
    names[RAN] = ran
    for function in before:
        function.__code__ = codes[function.__code__.co_qualname]
    try:
        yield
    finally:
        for function, code in before.items():
            function.__code__ = code


def _functions(names: Mapping[str, Any]) -> Iterator[FunctionType]:
    """The functions that were defined in a translation: their globals are its names."""
    for value in list(names.values()):
        members = list(vars(value).values()) if isinstance(value, type) else [value]
        for member in members:
            if isinstance(member, FunctionType) and member.__globals__ is names:
                yield member
