"""What makes a class a node of the syntax tree."""

from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

_Node = TypeVar("_Node")


@dataclass_transform(frozen_default=True, eq_default=False)
def node(made: type[_Node]) -> type[_Node]:
    """Nodes compare by identity, so a node can be the key of what is known about it."""
    return dataclass(frozen=True, eq=False, slots=True)(made)
