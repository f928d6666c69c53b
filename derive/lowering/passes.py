"""The one list of all passes, in their order, and which languages take them.

    DERIVED          every language: an inverse, as soon as it is derived
    EVERY            every language: all programs of a machine together, as values in one graph
    SIDES            Structured Text, C with LinuxCNC, JavaScript, Python on plain numbers, the page: one side of a
                     choice is run, and the first refusal ends the program
    UNCONVERTED      Python, in front of these: it converts whole numbers by itself
    ARRAYS           Python on arrays, in place of SIDES: both sides of a choice are computed, in refused rows, too
    TRUSTED          Python and C: one branch for trusted input; then ANY_TURN
    STRAIGHT_LINE    Python and C, behind these: all branches at once, and one branch, as values in one graph
    WRITTEN_SHORT    Python, behind WITHOUT_SQUARES and UNCONVERTED, in place of SIDES: the text of these functions
    LANES            C, several poses at a time: SPECIALISED, ANY_TURN, REGULAR, and LANES for all branches

A pass rewrites a program, a draft (its values in a graph) or a tree (its statements, with choices that have sides), and
gives the same answers. `tests/unit/passes` has a folder for each, with programs before it and behind it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Generic, NamedTuple, TypeVar

import sympy as sp

from derive.ir.graph import Graph, Node, reached
from derive.ir.program import Let, Program
from derive.ir.symbols import Sign
from derive.ir.tree import Item, Tree
from derive.kept import kept_by_identity
from derive.lowering.cutting import cut
from derive.lowering.draft import Draft, Reader, changed, values_of
from derive.lowering.factoring import Dividing, Factoring, collected, opened
from derive.lowering.hoisting import Constant, Gathering, hoisted
from derive.lowering.scheduling import decided, refused_late, scheduled, together, with_reasons_on_sides
from derive.lowering.sharing import Sharing
from derive.lowering.symmetry import Mirrored, Symmetry
from derive.lowering.unrolling import unrolled
from derive.lowering.writing import written
from derive.optimize.angle_addition import with_added_angles
from derive.optimize.coalesce import coalesced
from derive.optimize.directions import added, unscaled
from derive.optimize.inline import inlined, squares_where_read, without_conversions
from derive.optimize.joining import joined
from derive.optimize.regular import regular
from derive.optimize.rotation_identities import with_rotation_identities
from derive.optimize.simplify import turned_back, without_signs
from derive.optimize.without_periods import specialised, without_chosen_turns

Subject = TypeVar("Subject")
Context = TypeVar("Context")


class Pass(NamedTuple, Generic[Subject, Context]):
    """A change of a program, a draft or a tree."""

    name: str
    change: Callable[[Subject, Context], Subject]


def applied(passes: Iterable[Pass[Subject, Context]], subject: Subject, given: Context) -> Subject:
    """The result of passes in their order."""
    for one in passes:
        subject = one.change(subject, given)
    return subject


@dataclass(frozen=True)
class Given:
    """What passes know besides the program."""

    constants: frozenset[str] = frozenset()
    """The names of the constants of the machine."""
    inputs: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The values of inputs that are known."""
    signs: tuple[Sign, ...] = ()
    """The signs of the branches that are unrolled."""


NOTHING = Given()


@dataclass(frozen=True)
class Shared:
    """What the drafts of all programs have in common, because they share values."""

    graph: Graph
    constant: Constant
    gathering: Gathering
    branches: Mapping[str, tuple[Sign, ...]]
    """The signs of the branches of a program that is unrolled, by its name."""


def _itself(change: Callable[[Subject], Subject]) -> Pass[Subject, Given]:
    """A pass that needs the program alone."""
    return Pass(change.__name__, lambda subject, _: change(subject))


def _nodes(draft: Draft) -> list[Node]:
    """All nodes that a draft reads."""
    return list(reached(value.node for value in values_of(draft)))


def _all_branches(draft: Draft, shared: Shared) -> Draft:
    """The draft of all branches; first the sharing within a branch, then that between branches."""
    signs = shared.branches.get(draft.program.name)
    return draft if signs is None else unrolled(applied(SHORTER, draft, shared), shared.graph, signs)


@dataclass(frozen=True)
class OnDrafts:
    """Passes on the drafts of all programs: within a stage one program after the other."""

    stages: tuple[tuple[Pass[Draft, Shared], ...], ...]
    modulo_turns: bool = False
    """Whether an angle may be a turn more or less, unless something takes its value as a real number."""


OnPrograms = tuple[Pass[Program, Given], ...]
OnTrees = tuple[Pass[Tree, Given], ...]

DERIVED: OnPrograms = (*map(_itself, (turned_back, without_signs, added, unscaled)),)

_GATHERING: Pass[Draft, Shared] = Pass("gathering", lambda draft, shared: changed(draft, shared.gathering))
SHORTER: tuple[Pass[Draft, Shared], ...] = (
    _GATHERING,
    Pass("factoring", lambda draft, shared: changed(draft, Factoring(shared.graph, draft.names, shared.constant))),
    _GATHERING,
    Pass("collected", lambda draft, shared: collected(draft, shared.graph, shared.constant)),
    Pass("opened", lambda draft, shared: opened(draft, shared.graph, shared.constant)),
    Pass("sharing", lambda draft, shared: changed(draft, Sharing(shared.graph, _nodes(draft), shared.constant))),
)
_UNROLLED: Pass[Draft, Shared] = Pass("unrolled", _all_branches)
_MIRRORED: Pass[Draft, Shared] = Pass(
    "mirrored", lambda draft, shared: changed(draft, Mirrored(shared.graph, _nodes(draft)))
)
_SYMMETRY: Pass[Draft, Shared] = Pass(
    "symmetry",
    lambda draft, shared: changed(draft, Symmetry(shared.graph, [v.node for v in values_of(draft)], draft.names)),
)
_DIVIDING: Pass[Draft, Shared] = Pass(
    "dividing", lambda draft, shared: changed(draft, Dividing(shared.graph, _nodes(draft), shared.constant))
)
EVERY = OnDrafts((SHORTER, (_DIVIDING,)))
STRAIGHT_LINE = OnDrafts(((_UNROLLED,), (_MIRRORED,), (_SYMMETRY,), SHORTER), modulo_turns=True)
LANES = replace(STRAIGHT_LINE, stages=(*STRAIGHT_LINE.stages, (_DIVIDING,)))
"""A division there takes longer than several multiplications, and in Python not."""

SIDES: OnTrees = (
    Pass("together", lambda tree, _: Tree.of(together(tree.program))),
    Pass("decided", lambda tree, _: Tree.of(decided(tree.program))),
    Pass("scheduled", lambda tree, _: tree.with_items(scheduled(tree.items, tree.wanted))),
    Pass("with_reasons_on_sides", lambda tree, _: tree.with_items(with_reasons_on_sides(tree.items, tree.program))),
)
_SCHEDULED = SIDES[2]
UNCONVERTED: OnPrograms = (_itself(without_conversions),)
ARRAYS: OnTrees = (Pass("refused_late", lambda tree, _: tree.with_items(refused_late(tree.program.body))), _SCHEDULED)

ANY_TURN: OnPrograms = (_itself(without_chosen_turns),)
SPECIALISED: OnPrograms = (Pass("specialised", lambda program, given: specialised(program, given.inputs)),)
TRUSTED: OnPrograms = (
    *SPECIALISED,
    Pass("with_added_angles", lambda program, given: with_added_angles(program, given.constants)),
    _itself(with_rotation_identities),
)
REGULAR: Pass[Program | None, Given] = Pass("regular", lambda one, given: one and regular(one, given.constants))
WITHOUT_SQUARES: OnPrograms = (_itself(squares_where_read),)
WRITTEN_SHORT: OnTrees = (
    _SCHEDULED,
    Pass("joined", lambda tree, _: tree.with_items(joined(tree.items, tree.wanted))),
    Pass("inlined", lambda tree, _: tree.with_items(*inlined(tree.items, tree.wanted))),
    Pass("coalesced", lambda t, given: t.with_items(*coalesced(t.items, t.wanted, given.signs)) if given.signs else t),
)


@kept_by_identity(400)
def structured(program: Program) -> tuple[Item, ...]:
    """A program for a language that returns at the first refusal, and executes only one side of a choice."""
    return applied(SIDES, Tree.of(program), NOTHING).items


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
        draft.items[:] = [item.calling(done) for item in draft.items]
        short = cut(draft, graph, names)
        done[draft.program.name] = written(short, names, taken, modulo_turns=passes.modulo_turns)
    return tuple(done.values()), lets
