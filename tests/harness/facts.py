"""The facts about a text that the checker establishes; the translator relies on them."""

from __future__ import annotations

from dataclasses import dataclass, field

from . import ast
from . import st_types as types
from .faults import StError
from .universe import Universe


@dataclass(eq=False)
class BoundCall:
    """A call with its arguments brought into the order of the parameters."""

    callee: types.Routine | types.Block | types.Builtin
    arguments: list[tuple[types.Variable, ast.Expression | None]]


@dataclass
class Facts:
    type_of: dict[ast.Expression, types.Type] = field(default_factory=dict)
    meanings: dict[ast.Expression, types.Meaning] = field(default_factory=dict)
    scopes: dict[ast.Routine, Scope] = field(default_factory=dict)
    calls: dict[ast.Call, BoundCall] = field(default_factory=dict)
    # Scalars handed on by reference: they need a cell of their own instead of a bare value.
    boxed: set[types.Variable] = field(default_factory=set)


@dataclass
class Scope:
    """The names one body sees, and what it may write."""

    universe: Universe
    block: types.Block | None
    owner: str
    locals: dict[str, types.Variable]
    result: types.Variable | None
    is_method: bool
    result_assigned: bool = False

    def find(self, name: str) -> types.Meaning | None:
        key = name.lower()
        if key in self.locals:
            return self.locals[key]
        if self.block is not None:
            own = self.block.variable(key) or self.block.property(key) or self.block.method(key)
            if own is not None:
                return own
        return self.universe.find(name)

    def meaning(self, node: ast.Expression) -> types.Meaning | None:
        """What a name or a dotted path of names means, as far as no value is involved."""
        if isinstance(node, ast.Name):
            return self.find(node.text)
        if isinstance(node, ast.Member) and isinstance(node.object, (ast.Name, ast.Member)):
            owner = self.meaning(node.object)
            if isinstance(owner, (types.Namespace, types.Enum)):
                return self.member(owner, node)
        return None

    @staticmethod
    def member(owner: types.Namespace | types.Enum, node: ast.Member) -> types.Meaning:
        key = node.name.lower()
        if isinstance(owner, types.Namespace) and key in owner.entries:
            return owner.entries[key]
        if isinstance(owner, types.Enum) and key in owner.members:
            return types.EnumMember(owner, owner.members[key])
        raise StError(node.at, f"{owner.name} has no member {node.name}")
