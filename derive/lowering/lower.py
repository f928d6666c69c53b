"""All programs of a mechanism, with fewer operations: the same for every language."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from derive.ir.program import Let, Program
from derive.ir.symbols import Sign
from derive.lowering.cutting import cut
from derive.lowering.draft import Effect, Reader
from derive.lowering.hoisting import Constant, Gathering, hoisted
from derive.lowering.passes import EVERY, OnDrafts, Shared, applied
from derive.lowering.writing import written


def lowered(
    programs: Sequence[Program],
    constants: Collection[str],
    passes: OnDrafts = EVERY,
    *,
    branches: Mapping[str, tuple[Sign, ...]] = MappingProxyType({}),
    known: Iterable[Let] = (),
) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs, and the bindings of their constants. A program that others call comes before them.

    branches: for the name of a program, the signs whose branches are unrolled; known: the bindings of constants that
    are computed from others.
    """
    reader = Reader()
    graph, constant = reader.graph, Constant(constants)
    given = dict(reader.constant(let) for let in known)
    drafts = [reader.draft(p) for p in programs]
    shared = Shared(graph, constant, Gathering(graph, constant), branches)
    for stage in passes.stages:
        drafts = [applied(stage, draft, shared) for draft in drafts]
    names, lets = hoisted(drafts, constant, constants, given)
    taken = {*constants, *(let.name.name for let in lets)}
    done: dict[str, Program] = {}
    for draft in drafts:
        draft.items[:] = [
            replace(i, statement=i.statement.calling(done)) if isinstance(i, Effect) else i for i in draft.items
        ]
        short = cut(draft, graph, names)
        done[draft.program.name] = written(short, names, taken, modulo_turns=passes.modulo_turns)
    return tuple(done.values()), lets
