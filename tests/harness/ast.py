"""The syntax tree of Structured Text: expressions, types as they are written, statements, and declarations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

from .faults import Place

_Node = TypeVar("_Node")


@dataclass_transform(frozen_default=True, eq_default=False)
def node(made: type[_Node]) -> type[_Node]:
    """Nodes compare by identity, so a node can be the key of what is known about it."""
    return dataclass(frozen=True, eq=False, slots=True)(made)


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


@node
class NamedType:
    text: str
    at: Place


@node
class StringText:
    text: str
    length: int
    at: Place


@node
class ArrayText:
    text: str
    bounds: tuple[tuple[Expression, Expression], ...]
    element: TypeText
    at: Place


@node
class PointerText:
    text: str
    target: TypeText
    at: Place


TypeText = NamedType | StringText | ArrayText | PointerText


@node
class Assign:
    target: Expression
    value: Expression
    at: Place


@node
class CallStatement:
    call: Call
    at: Place


@node
class Branch:
    condition: Expression
    body: tuple[Statement, ...]


@node
class If:
    branches: tuple[Branch, ...]
    otherwise: tuple[Statement, ...]
    at: Place


@node
class Label:
    """A value of a CASE, or a range of values when upper is given."""

    lower: Expression
    upper: Expression | None
    at: Place


@node
class CaseBranch:
    labels: tuple[Label, ...]
    body: tuple[Statement, ...]


@node
class Case:
    subject: Expression
    branches: tuple[CaseBranch, ...]
    otherwise: tuple[Statement, ...]
    at: Place


@node
class For:
    control: Expression
    start: Expression
    stop: Expression
    step: Expression | None
    body: tuple[Statement, ...]
    at: Place


@node
class While:
    condition: Expression
    body: tuple[Statement, ...]
    at: Place


@node
class Exit:
    at: Place


@node
class Return:
    at: Place


Statement = Assign | CallStatement | If | Case | For | While | Exit | Return


@node
class VariableDeclaration:
    name: str
    type: TypeText
    initial: Expression | None
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Section:
    scope: str  # "VAR_INPUT", "VAR_IN_OUT", ...
    constant: bool
    variables: tuple[VariableDeclaration, ...]

    @property
    def title(self) -> str:
        return f"{self.scope} CONSTANT" if self.constant else self.scope


@node
class Parameter:
    scope: str  # as Section.title
    name: str
    type: str
    declaration: VariableDeclaration


class HasSections:
    __slots__ = ()
    sections: tuple[Section, ...]

    @property
    def params(self) -> tuple[Parameter, ...]:
        """The variables a caller sees, in the order of declaration."""
        return tuple(
            Parameter(section.title, variable.name, variable.type.text, variable)
            for section in self.sections
            if section.scope in ("VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT")
            for variable in section.variables
        )


@node
class _Object:
    """What every object of a text has."""

    kind: str
    name: str
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Routine(_Object, HasSections):
    """A FUNCTION, a METHOD, or the GET part of a PROPERTY."""

    access: str
    returns: TypeText | None
    sections: tuple[Section, ...]
    body: tuple[Statement, ...]


@node
class PropertyDeclaration:
    name: str
    access: str
    type: TypeText
    getter: Routine
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Block(_Object, HasSections):
    """A FUNCTION_BLOCK or a PROGRAM."""

    extends: str | None
    implements: tuple[str, ...]
    sections: tuple[Section, ...]
    methods: tuple[Routine, ...]
    properties: tuple[PropertyDeclaration, ...]
    body: tuple[Statement, ...]


@node
class Interface(_Object):
    """An INTERFACE: its methods have no statements."""

    extends: tuple[str, ...]
    methods: tuple[Routine, ...]


@node
class Structure(_Object):
    fields: tuple[VariableDeclaration, ...]


@node
class Enumeration(_Object):
    members: tuple[tuple[str, int | None], ...]


@node
class Globals(_Object):
    """A VAR_GLOBAL list; its name is the name of the text that holds it."""

    constant: bool
    variables: tuple[VariableDeclaration, ...]


Declaration = Routine | Block | Interface | Structure | Enumeration | Globals
