"""The syntax tree of Structured Text, by what its nodes stand for."""

from .declarations import (
    Block,
    Declaration,
    Enumeration,
    Globals,
    Interface,
    Parameter,
    PropertyDeclaration,
    Routine,
    Section,
    Structure,
    VariableDeclaration,
)
from .expressions import (
    AddressOf,
    Argument,
    ArrayValues,
    Binary,
    Call,
    Dereference,
    Expression,
    Index,
    Literal,
    Member,
    Name,
    Super,
    This,
    Unary,
)
from .statements import Assign, Branch, CallStatement, Case, CaseBranch, Exit, For, If, Label, Return, Statement, While
from .types import ArrayText, NamedType, PointerText, StringText, TypeText

__all__ = [
    "AddressOf", "Argument", "ArrayText", "ArrayValues", "Assign", "Binary", "Block", "Branch", "Call", "CallStatement",
    "Case", "CaseBranch", "Declaration", "Dereference", "Enumeration", "Exit", "Expression", "For", "Globals", "If",
    "Index", "Interface", "Label", "Literal", "Member", "Name", "NamedType", "Parameter", "PointerText",
    "PropertyDeclaration", "Return", "Routine", "Section", "Statement", "StringText", "Structure", "Super", "This",
    "TypeText", "Unary", "VariableDeclaration", "While",
]  # fmt: skip
