"""Expressions: what has a value."""

from __future__ import annotations

from ..faults import Place
from .node import node


@node
class Literal:
    value: bool | int | float | str
    at: Place


@node
class Name:
    text: str
    at: Place


@node
class Member:
    object: Expression
    name: str
    at: Place


@node
class Index:
    object: Expression
    indices: tuple[Expression, ...]
    at: Place


@node
class Dereference:
    pointer: Expression
    at: Place


@node
class This:
    at: Place


@node
class Super:
    at: Place


@node
class AddressOf:
    operand: Expression
    at: Place


@node
class Unary:
    operator: str
    operand: Expression
    at: Place


@node
class Binary:
    operator: str
    left: Expression
    right: Expression
    at: Place


@node
class Argument:
    name: str | None
    value: Expression
    is_output: bool
    at: Place


@node
class Call:
    function: Expression
    arguments: tuple[Argument, ...]
    at: Place


@node
class ArrayValues:
    """An initial value of an array, repetitions already written out."""

    values: tuple[Expression, ...]
    at: Place


Expression = (
    Literal | Name | Member | Index | Dereference | This | Super | AddressOf | Unary | Binary | Call | ArrayValues
)
