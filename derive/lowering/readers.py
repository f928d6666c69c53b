"""The readers of every value in a draft: other values, and statements."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from derive.ir.graph import Node
from derive.lowering.draft import Draft, Effect, values_of

Readers: TypeAlias = Mapping[Node, tuple[Node | None, ...]]
"""For each node: the nodes that read it, and None for each statement or output that reads it."""


def readers_of(draft: Draft) -> Readers:
    """The readers of all nodes of a draft; the amount of a reason is a reader, too."""
    found: dict[Node, list[Node | None]] = {}
    pending: list[Node] = []

    def read(node: Node, reader: Node | None) -> None:
        if node not in found:
            found[node] = []
            pending.append(node)
        found[node].append(reader)

    refused = (value for item in draft.items if isinstance(item, Effect) for _, value in item.refused)
    for value in (*values_of(draft), *refused):
        read(value.node, None)
    while pending:
        reader = pending.pop()
        for node in reader.read:
            read(node, reader)
    return {node: tuple(readers) for node, readers in found.items()}
