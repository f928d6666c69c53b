"""The syntax tree of Structured Text: expressions, types as they are written, statements, and declarations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar, dataclass_transform

from .faults import Place

_Node = TypeVar("_Node")


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(field,))
def node(made: type[_Node]) -> type[_Node]:
    """Nodes compare by identity, so a node can be the key of what is known about it."""
    return dataclass(frozen=True, eq=False, slots=True)(made)


@node
class Placed:
    """What stands at a place of its own."""

    at: Place = field(kw_only=True)


@node
class Literal(Placed):
    value: bool | int | float | str


@node
class Name(Placed):
    text: str


@node
class Member(Placed):
    object: Expression
    name: str


@node
class Index(Placed):
    object: Expression
    indices: tuple[Expression, ...]


@node
class Dereference(Placed):
    pointer: Expression


@node
class This(Placed): ...


@node
class Super(Placed): ...


@node
class AddressOf(Placed):
    operand: Expression


@node
class Unary(Placed):
    operator: str
    operand: Expression


@node
class Binary(Placed):
    operator: str
    left: Expression
    right: Expression


@node
class Argument(Placed):
    name: str | None
    value: Expression
    is_output: bool


@node
class Call(Placed):
    function: Expression
    arguments: tuple[Argument, ...]


@node
class ArrayValues(Placed):
    """An initial value of an array, repetitions already written out."""

    values: tuple[Expression, ...]


Expression = (
    Literal | Name | Member | Index | Dereference | This | Super | AddressOf | Unary | Binary | Call | ArrayValues
)


@node
class NamedType(Placed):
    text: str


@node
class StringText(Placed):
    text: str
    length: int


@node
class ArrayText(Placed):
    text: str
    bounds: tuple[tuple[Expression, Expression], ...]
    element: TypeText


@node
class PointerText(Placed):
    text: str
    target: TypeText


TypeText = NamedType | StringText | ArrayText | PointerText


@node
class Assign(Placed):
    target: Expression
    value: Expression


@node
class CallStatement(Placed):
    call: Call


@node
class Branch:
    condition: Expression
    body: tuple[Statement, ...]


@node
class If(Placed):
    branches: tuple[Branch, ...]
    otherwise: tuple[Statement, ...]


@node
class CaseBranch:
    labels: tuple[Expression, ...]
    body: tuple[Statement, ...]


@node
class Case(Placed):
    subject: Expression
    branches: tuple[CaseBranch, ...]
    otherwise: tuple[Statement, ...]


@node
class For(Placed):
    control: Expression
    start: Expression
    stop: Expression
    step: Expression | None
    body: tuple[Statement, ...]


@node
class Exit(Placed): ...


@node
class Return(Placed): ...


Statement = Assign | CallStatement | If | Case | For | Exit | Return


@node
class VariableDeclaration(Placed):
    name: str
    type: TypeText
    initial: Expression | None
    pragmas: tuple[str, ...]
    comment: str


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
class PropertyDeclaration(Placed):
    name: str
    access: str
    type: TypeText
    getter: Routine
    pragmas: tuple[str, ...]
    comment: str


@node
class Block(_Object, HasSections):
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
