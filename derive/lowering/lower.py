"""All programs of a mechanism, with fewer operations: the same for every language."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from derive.ir.graph import Graph, Node, reached
from derive.ir.passes import calling
from derive.ir.program import Let, Program
from derive.lowering.coefficients import collected, distributed
from derive.lowering.dividing import Dividing
from derive.lowering.draft import Draft, Effect, Reader, changed, values_of
from derive.lowering.factoring import Factoring
from derive.lowering.hoisting import Constant, Gathering, hoisted
from derive.lowering.opening import opened
from derive.lowering.sharing import Sharing
from derive.lowering.writing import written


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
    draft = distributed(collected(draft, graph, constant), graph, constant)
    draft = opened(draft, graph, constant)
    draft = changed(draft, Sharing(graph, _nodes(draft), constant))
    return changed(draft, Dividing(graph, _nodes(draft), constant))


def _nodes(draft: Draft) -> list[Node]:
    """All nodes that a draft reads."""
    return list(reached(value.node for value in values_of(draft)))
