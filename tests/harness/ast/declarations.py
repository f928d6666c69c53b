"""Declarations: what a text defines, from a variable to a function block."""

from ..faults import Place
from .expressions import Expression
from .node import node
from .statements import Statement
from .types import TypeText


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
class Routine(HasSections):
    """A FUNCTION, a METHOD, or the GET part of a PROPERTY."""

    kind: str
    name: str
    access: str
    returns: TypeText | None
    sections: tuple[Section, ...]
    body: tuple[Statement, ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


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
class Block(HasSections):
    """A FUNCTION_BLOCK or a PROGRAM."""

    kind: str
    name: str
    extends: str | None
    implements: tuple[str, ...]
    sections: tuple[Section, ...]
    methods: tuple[Routine, ...]
    properties: tuple[PropertyDeclaration, ...]
    body: tuple[Statement, ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Interface:
    """An INTERFACE: its methods have no statements."""

    kind: str
    name: str
    extends: tuple[str, ...]
    methods: tuple[Routine, ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Structure:
    kind: str
    name: str
    fields: tuple[VariableDeclaration, ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Enumeration:
    kind: str
    name: str
    members: tuple[tuple[str, int | None], ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


@node
class Globals:
    """A VAR_GLOBAL list; its name is the name of the text that holds it."""

    kind: str
    name: str
    constant: bool
    variables: tuple[VariableDeclaration, ...]
    pragmas: tuple[str, ...]
    comment: str
    at: Place


Declaration = Routine | Block | Interface | Structure | Enumeration | Globals
