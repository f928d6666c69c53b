"""Types as they are written."""

from __future__ import annotations

from ..faults import Place
from .expressions import Expression
from .node import node


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
