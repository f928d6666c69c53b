"""All programs of a mechanism, with fewer operations: the same for every language."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

from derive.ir.graph import Node, reached
from derive.ir.program import Let, Program
from derive.ir.symbols import Sign
from derive.lowering.coefficients import collected
from derive.lowering.cutting import cut
from derive.lowering.draft import Draft, Effect, Reader, changed, values_of
from derive.lowering.factoring import Dividing, Factoring
from derive.lowering.hoisting import Constant, Gathering, hoisted
from derive.lowering.opening import opened
from derive.lowering.sharing import Sharing
from derive.lowering.symmetry import Mirrored, Symmetry
from derive.lowering.unrolling import unrolled
from derive.lowering.writing import written


def lowered(
    programs: Sequence[Program],
    constants: Collection[str],
    *,
    modulo_turns: bool = False,
    inverts: bool = True,
    branches: Mapping[str, Sequence[Sign]] | None = None,
    known: Iterable[Let] = (),
) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs, and the bindings of their constants. A program that others call comes before them.

    modulo_turns: whether an angle may be a turn more or less, unless something takes its value as a real number;
    inverts: whether a division takes longer than several multiplications; branches: for the name of a program, the
    signs whose branches are unrolled; known: the bindings of constants that are computed from others.
    """
    reader = Reader()
    graph, constant = reader.graph, Constant(constants)
    given = dict(reader.constant(let) for let in known)
    drafts = [reader.draft(p) for p in programs]
    signs, gathering = branches or {}, Gathering(graph, constant)
    for place, draft in enumerate(drafts):
        if draft.program.name in signs:  # first the sharing within a branch, then that between branches
            drafts[place] = unrolled(_shorter(draft, gathering), graph, signs[draft.program.name])
    if modulo_turns:
        drafts = [changed(draft, Mirrored(graph, _nodes(draft))) for draft in drafts]
        drafts = [changed(draft, Symmetry(graph, [v.node for v in values_of(draft)], draft.names)) for draft in drafts]
    drafts = [_shorter(draft, gathering) for draft in drafts]
    if inverts:
        drafts = [changed(draft, Dividing(graph, _nodes(draft), constant)) for draft in drafts]
    names, lets = hoisted(drafts, constant, constants, given)
    taken = {*constants, *(let.name.name for let in lets)}
    done: dict[str, Program] = {}
    for draft in drafts:
        draft.items[:] = [
            replace(i, statement=i.statement.calling(done)) if isinstance(i, Effect) else i for i in draft.items
        ]
        short = cut(draft, graph, names)
        done[draft.program.name] = written(short, names, taken, modulo_turns=modulo_turns)
    return tuple(done.values()), lets


def _shorter(draft: Draft, gathering: Gathering) -> Draft:
    """The draft with fewer operations. gathering: one object for all programs, because they share values."""
    graph, constant = gathering.graph, gathering.constant
    draft = changed(draft, gathering)
    draft = changed(draft, Factoring(graph, draft.names, constant))
    draft = changed(draft, gathering)
    draft = collected(draft, graph, constant)
    draft = opened(draft, graph, constant)
    return changed(draft, Sharing(graph, _nodes(draft), constant))


def _nodes(draft: Draft) -> list[Node]:
    """All nodes that a draft reads."""
    return list(reached(value.node for value in values_of(draft)))
