"""A page of a machine and the index of all pages, as text: HTML that is well-formed XML, without a script."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import sympy as sp
from jinja2 import Environment

from derive.description.mechanism import Mechanism
from derive.emit.language import environment
from derive.emit.page import tables
from derive.emit.page.jacobian import factored, jacobian_of, matrices_of
from derive.emit.page.lines import Line, Lines, steps_by_name
from derive.emit.page.names import Spelling, has_block, inputs_of, spelling_of
from derive.emit.page.pictures import maps, pictured, singularities
from derive.emit.page.steps import Stated, product_of, route_of, signs_of, tree_of
from derive.emit.st.shared import method_name
from derive.ir.passes import needed_for
from derive.ir.program import Let, Program
from derive.ir.symbols import real
from derive.kinematics.kinematics import Kinematics, Margin
from derive.kinematics.margins import Factor
from derive.lowering.passes import structured
from derive.report.branch_stretches import stretches_of
from derive.report.derived import Derived, derived_of
from derive.report.reasons import workspace

_FOLDER = "html"
_SHARED = "A program that others call"
_BESIDE = 54
"""The letters of a line beside a picture."""


@dataclass(frozen=True)
class Page:
    """A page: its file, and its entry in the index."""

    file: str
    title: str
    family: str
    summary: str
    text: str


@dataclass(frozen=True)
class ShownProgram:
    """A program on the page: its names in the block and in Python, its lines, its outputs."""

    anchor: str
    title: str
    lines: tuple[Line, ...]
    outputs: tuple[Line, ...] = ()


def page_of(mechanism: Mechanism, kinematics: Kinematics, has_pictures: bool = True, viewer: str = "") -> Page:
    """The page of a machine. kinematics: the result of the build, with the witness's measurements where it has any.

    has_pictures: with the drawing, the machine in its singular poses, and maps; without, the formulas alone.
    viewer: the file that shows the machine in the browser, from where this page stands; empty if there is none.
    """
    derived, spelling = derived_of(kinematics.solution), spelling_of(kinematics)
    lines, plain = Lines(spelling, _numbered(derived)), Lines(spelling)
    names = {p.name: f"{p.nominal:g}" for p in kinematics.mechanism.parameters} | dict(inputs_of(kinematics))
    found = pictured(kinematics, names) if has_pictures else None
    body, entries = jacobian_of(kinematics, lines)
    factors = {f.name: f for f in derived.factors}
    singular = {} if found is None else dict(singularities(found, derived, names))
    block = kinematics.mechanism.block_name
    text = (
        _templates()
        .get_template("machine.html.j2")
        .render(
            title=block,
            mechanism=kinematics.mechanism,
            derived=derived,
            viewer=viewer,
            names=names,
            has_block=has_block(kinematics),
            found=found,
            axes=list(tables.axes(kinematics)),
            dimensions=list(tables.parameters(kinematics, spelling, is_own=True)),
            settings=list(tables.parameters(kinematics, spelling, is_own=False)),
            signs=list(signs_of(kinematics, lines)),
            numbers=list(tables.numbers(kinematics, spelling)),
            places=_places(spelling),
            chain=() if kinematics.mechanism.chain is None else product_of(kinematics.mechanism.chain.factors, lines),
            stated=list(_stated(derived.mechanism, lines)),
            routes=[route_of(route, derived.mechanism, plain) for route in derived.inverse],
            forward=None if derived.forward is None else route_of(derived.forward, derived.mechanism, plain),
            tree=tree_of(derived),
            slots=2 ** len(kinematics.branches),
            programs=list(_programs(kinematics, lines)),
            matrices=matrices_of(derived, lines),
            jacobian=ShownProgram("jacobian-program", "", tuple(body)),
            entries=entries,
            rows=kinematics.rows,
            factored=factored(kinematics.margins),
            margins=[(m, _margin(m, factors, lines), singular.get(m.name)) for m in kinematics.margins],
            singularity=_program(kinematics.singularity, "singularity-program", "", lines),
            workspace=[f"{bound}." for bound in workspace(kinematics)],
            maps=[] if found is None else list(maps(found)),
            measured=list(tables.measured(kinematics)),
            cost_head=tables.COST_HEAD,
            operations=list(tables.operations(kinematics)),
            bounds=list(tables.bounds(kinematics)),
            notes=[spelling.text(note) for note in kinematics.mechanism.all_notes],
        )
    )
    text = text.replace(_FUNCTIONS, _rows(text))
    own = kinematics.mechanism
    return Page(f"{block}.html", block, own.family, own.summary, text)


_FUNCTIONS = "<!-- functions -->"


def _rows(text: str) -> str:
    """The table of the functions that a page has."""
    return _templates().get_template("functions.html.j2").render(functions=list(tables.functions(text)))


def index_of(pages: Sequence[Page]) -> str:
    """The page that lists all others, by families."""
    families: dict[str, list[Page]] = {}
    for page in pages:
        families.setdefault(page.family, []).append(page)
    return _templates().get_template("index.html.j2").render(families=dict(sorted(families.items())))


@cache
def _templates() -> Environment:
    return environment(_FOLDER, is_page=True)


def _numbered(derived: Derived) -> Mapping[str, int]:
    """The steps by the names that they bind; none of a searched machine, whose program has other names."""
    if derived.searched is not None:
        return {}
    return steps_by_name([(step.number, step.statements) for step in derived.inverse[-1].steps])


def _places(spelling: Spelling) -> list[tuple[str, str]]:
    return sorted(set(spelling.places))


def _stated(mechanism: Mechanism, lines: Lines) -> list[Stated]:
    """The equations as the description states them."""
    labels = [f"equation {k}" for k, _ in enumerate(mechanism.closure, 1)]
    labels += [f"guide {g.name}" for g in mechanism.guides] + [f"rod {r.name}" for r in mechanism.rods]
    pairs = zip(labels, mechanism.equations, strict=True)
    return [Stated(label, lines.math.equation(value, sp.Integer(0))) for label, value in pairs]


def _programs(kinematics: Kinematics, lines: Lines) -> list[ShownProgram]:
    """Constants and both directions, line by line as the block has them."""
    stretches = stretches_of(kinematics.branch)
    items = [item for stretch in stretches for item in stretch.items]
    asked = (kinematics.branch, kinematics.forward, kinematics.jacobian, kinematics.singularity)
    read = {s.name for program in asked for s in program.reads()}
    setup = kinematics.setup_less_windows
    parameters = {p.name for p in kinematics.parameters}
    wanted = [o for o in setup.outputs if o.name in read and o.name not in parameters]
    constants = [s for s in needed_for(setup.body, [o.value for o in wanted]) if isinstance(s, Let)]
    bound = {s.name.name for s in constants}
    own = [Let(real(o.name), o.value) for o in wanted if o.name not in bound and o.value != real(o.name)]
    solved = [Let(real(o.name), o.value) for o in kinematics.branch.outputs if o.value != real(o.name)]
    found = [ShownProgram("constants", "Constants", tuple(lines.of((*constants, *own))))]
    for inner in kinematics.shared:
        shown = _program(inner, f"shared-{inner.name}", f"{inner.summary or _SHARED}: {method_name(inner)}", lines)
        found.append(shown)
    found.append(ShownProgram("inverse-program", "Inverse kinematics", tuple(lines.of(items)), tuple(lines.of(solved))))
    return [*found, _program(kinematics.forward, "forward-program", "Forward kinematics", lines)]


def _program(program: Program, anchor: str, title: str, lines: Lines) -> ShownProgram:
    items = structured(program)
    outputs = [Let(real(o.name), o.value) for o in program.outputs if str(o.value) != o.name]
    outputs = [let for let in outputs if not let.value.is_number]
    return ShownProgram(anchor, title, tuple(lines.of(items)), tuple(lines.of(outputs)))


def _margin(margin: Margin, factors: Mapping[str, Factor], lines: Lines) -> tuple[str, ...]:
    """The formula of a margin, in the names of the derivation; empty for a determinant without a derived formula."""
    factor = factors.get(margin.name)
    return () if factor is None else lines.math.lines(factor.value, _BESIDE)
