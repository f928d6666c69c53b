"""Mirrored directions: an angle whose turn nobody counts is the negative of the angle of the mirrored direction.

angle_up = atan2(-s, c)   where   angle_down = atan2(s, c)     →     angle_up = -angle_down
"""

from __future__ import annotations

from collections.abc import Iterable

from derive.ir.graph import Graph, Node, Value, reached
from derive.ir.primitives import Atan2, Wrap
from derive.lowering.draft import Rewriting


class Mirrored(Rewriting):
    """Takes the minus sign of a sine in front of the angle, unless something takes the value of the angle."""

    def __init__(self, graph: Graph, nodes: Iterable[Node]) -> None:
        super().__init__(graph)
        self._counted = set(reached(node for node in nodes if node.head is Wrap))

    def rewritten(self, node: Node, parts: tuple[Value, ...]) -> Value:
        """An angle with a sine that has no minus sign."""
        if node.head is not Atan2 or node in self._counted or parts[0].sign > 0:
            return super().rewritten(node, parts)
        return -self.graph.apply(Atan2, (-parts[0], parts[1]))
