"""All programs of a mechanism, with fewer operations: the same for every language."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from derive.ir.graph import Graph, Node
from derive.ir.passes import calling
from derive.ir.program import Let, Program
from derive.lowering.dividing import Dividing
from derive.lowering.draft import Draft, Effect, Reader, changed
from derive.lowering.factoring import Factoring
from derive.lowering.hoisting import Constant, Gathering, hoisted
from derive.lowering.sharing import Sharing
from derive.lowering.writing import read_values, written


def lowered(programs: Sequence[Program], constants: Collection[str]) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs, and what they read of constants alone. A program that others call comes before them."""
    reader = Reader()
    graph, constant = reader.graph, Constant(constants)
    drafts = [_shorter(reader.draft(p), graph, constant) for p in programs]
    names, lets = hoisted(drafts, constant, constants)
    taken = {*constants, *(let.name.name for let in lets)}
    done: dict[str, Program] = {}
    for draft in drafts:
        draft.items[:] = [replace(i, statement=calling(i.statement, done)) if isinstance(i, Effect) else i for i in draft.items]
        done[draft.program.name] = written(draft, names, taken)
    return tuple(done.values()), lets


def _shorter(draft: Draft, graph: Graph, constant: Constant) -> Draft:
    draft = changed(draft, Gathering(graph, constant))
    draft = changed(draft, Factoring(graph, draft.names, constant))
    draft = changed(draft, Gathering(graph, constant))
    draft = changed(draft, Sharing(graph, nodes_of(draft), constant))
    return changed(draft, Dividing(graph, nodes_of(draft), constant))


def nodes_of(draft: Draft) -> set[Node]:
    """All nodes that a draft reads."""
    found: set[Node] = set()
    pending = [v.node for item in draft.items for v in read_values(item)] + [v.node for v in draft.outputs]
    while pending:
        node = pending.pop()
        if node not in found:
            found.add(node)
            pending += node.sources()
    return found
