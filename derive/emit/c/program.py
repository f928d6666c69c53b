"""A program as a C function with early returns, which writes its results at its end."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from derive.emit.braces import block, indented
from derive.emit.c.functions import Function, function_name
from derive.emit.c.layout import comment, commented
from derive.emit.c.printer import C, list_of, names_of, spelled, type_of
from derive.emit.c.refusal import Refusals
from derive.emit.interface import names_in, read_by
from derive.ir.primitives import Select
from derive.ir.program import Call, FindRoot, Iterate, Let, Program, Require, Solve, binds
from derive.ir.symbols import PLACE
from derive.ir.tree import If, Item, grouped
from derive.lowering.decided import decided
from derive.lowering.scheduling import structured
from derive.report.reasons import Reasons

_PLACES = {name.name: f"place->{name.name}" for name in PLACE}


def function_lines(function: Function, machine: str, constants: Mapping[str, str], reasons: Reasons) -> list[str]:
    """The function. machine: the type of the struct of the machine; constants: the spelling of its members."""
    program, read = function.program, read_by(function.program)
    printer = C({name: text for name, text in constants.items() if name not in function.given})
    body = Body(printer, reasons, names_in(program))
    types = {s.name: type_of(s) for s in program.inputs}
    own = [(name, place) for name, place in function.given.items() if name in read]
    arguments = taken(own, types)
    lines = body.lines(structured(program))
    values = {o.name: body.printer.print(o.value) for o in decided(program).outputs}
    writes = [f"{place} = {values[name]};" for name, place in function.results]
    inner = [*arguments, *lines, *writes, "return SOFTKIN_OK;"]
    if function.is_of_machine:
        inner = [f"const {machine} *k = machine;", *inner] if _reads("k", inner) else inner
    given = f"const void *machine, {function.parameters}" if function.is_of_machine else function.parameters
    head = f"static softkin_status {function.name}({given}, softkin_refusal *why)"
    return function_of(function.entry.summary, head, inner)


def function_of(summary: str, head: str, inner: Sequence[str]) -> list[str]:
    """A function; parameters that it does not read are named as such."""
    given = re.sub(r"\[\w*\]", "", head.partition("(")[2].removesuffix(")"))
    names = [re.findall(r"\w+", part)[-1] for part in given.split(",")]
    unread = [f"(void){name};" for name in names if not _reads(name, inner)]
    return [*comment(summary), *block(head, [*unread, *inner])]


def _reads(name: str, lines: Iterable[str]) -> bool:
    return any(re.search(rf"\b{name}\b", re.sub(r"/\*.*|\"(\\.|[^\"])*\"", "", line)) for line in lines)


def taken(own: Sequence[tuple[str, str]], types: Mapping[str, str]) -> list[str]:
    """Variables for values in arrays and structs, with those of one type on one line."""
    lines = []
    for kind in ("double", "int", "bool"):
        names = [(spelled(name), place) for name, place in own if types[name] == kind]
        if names:
            lines.append(f"const {kind} {', '.join(f'{name} = {converted(kind, place)}' for name, place in names)};")
    return lines


def converted(kind: str, place: str) -> str:
    """A value of an array of real numbers, or of bytes, in a type."""
    if kind == "bool":
        return f"{place} != 0.0"
    is_byte = place.startswith(("signs[", "turns["))
    return f"(int){place}" if kind == "int" and not is_byte else place


@dataclass
class Body:
    """The statements of one function."""

    printer: C
    reasons: Reasons
    read: Collection[str] | None = None
    """The names that are read; None where that is not known."""
    declared: set[sp.Symbol] = field(default_factory=set)
    """The names that are declared before the choice that gives them."""
    numbered: dict[str, int] = field(default_factory=dict)
    """For each word, the number of arrays with a name made of it."""

    @property
    def refusals(self) -> Refusals:
        """The refusals of the function."""
        return Refusals(self.reasons, self.printer)

    def lines(self, items: Sequence[Item]) -> list[str]:
        """Statements, choices with their sides."""
        return [line for item, same in grouped(items) for line in self._item(item, same)]

    def let(self, let: Let, *, declares: bool = True) -> list[str]:
        """A variable, or what is assigned to one."""
        word = f"const {type_of(let.name)} " if declares and let.name not in self.declared else ""
        value = without_brackets(let.value, self.printer.value(let.name, let.value))
        return commented(f"{word}{spelled(let.name.name)} = {value};", let.comment)

    def solve(self, system: Solve, *, declares: bool = True) -> list[str]:
        """Linear equations: the matrix with its right-hand sides in one array, which then holds the solution."""
        size, columns = system.size, system.columns
        array, word = self.array("system"), "const double " if declares else ""
        rows = [
            [*system.matrix[i * size : (i + 1) * size], *system.right[i * columns : (i + 1) * columns]]
            for i in range(size)
        ]
        printed = list_of(list_of(map(self.printer.print, row)) for row in rows)
        call = f"softkin_solve(&{array}[0][0], {size}, {columns});"
        target = "" if system.determinant is None else f"{word}{spelled(system.determinant.name)} = "
        found = [
            f"{spelled(name.name)} = {array}[{i // columns}][{size + i % columns}]"
            for i, name in enumerate(system.names)
            if self.read is None or name.name in self.read
        ]
        if declares:
            writes = [f"const double {', '.join(found)};"] if found else []
        else:
            writes = [f"{one};" for one in found]
        return [
            *comment(system.note), f"double {array}[{size}][{size + columns}] = {printed};", f"{target}{call}", *writes,
        ]  # fmt: skip

    def array(self, word: str) -> str:
        """The name of another array."""
        self.numbered[word] = self.numbered.get(word, 0) + 1
        count = self.numbered[word]
        return word if count == 1 else f"{word}_of_{count}"

    def _item(self, item: Item, same: tuple[Require, ...]) -> list[str]:
        if isinstance(item, Require):
            return self.refusals.lines(same)
        if isinstance(item, If):
            return self._choice(item)
        if isinstance(item, Let):
            return self.let(item)
        if isinstance(item, Solve):
            return self.solve(item)
        if isinstance(item, Iterate):
            return self._loop(item)
        return self._call(item) if isinstance(item, Call) else self._search(item)

    def _choice(self, arms: If) -> list[str]:
        own = [name for name in arms.names if name not in self.declared]
        head = declarations(own)
        self.declared.update(own)
        holds, fails = self.lines(arms.holds), self.lines(arms.fails)
        first = block(f"if ({self.refusals.condition([arms.condition])})", holds)
        return [*head, *first[:-1], "} else {", *indented(fails), "}"]

    def _loop(self, loop: Iterate) -> list[str]:
        """The step, then the end of the loop or the next state; the names of the step are read behind it, too."""
        step = [name for s in loop.step for name in binds(s)]
        start = zip(loop.state, self._values(loop, loop.start), strict=True)
        following = zip(names_of(loop.state), self._values(loop, loop.following), strict=True)
        refusal = "" if loop.otherwise is None else self.refusals.of_loop(loop.otherwise, loop)
        inner = [
            *(block(f"if (pass == {loop.limit})", [refusal]) if refusal else []),
            *(line for s in loop.step for line in self._step(s)),
            *block(f"if ({self.refusals.condition([loop.done])})", ["break;"]),
            *(f"{name} = {value};" for name, value in following),
        ]
        return [
            *comment(loop.note),
            *(f"{type_of(name)} {spelled(name.name)} = {value};" for name, value in start),
            *declarations(step),
            *block(f"for (int pass = 0;{'' if refusal else f' pass < {loop.limit}'}; pass += 1)", inner),
        ]

    def _step(self, statement: Let | Solve) -> list[str]:
        if isinstance(statement, Let):
            return self.let(statement, declares=False)
        return self.solve(statement, declares=False)

    def _values(self, loop: Iterate, values: Sequence[sp.Basic]) -> list[str]:
        return [self.printer.value(name, value) for name, value in zip(loop.state, values, strict=True)]

    def _call(self, call: Call) -> list[str]:
        values = dict(call.given)
        given = [self.printer.value(name, values[name]) for name in call.program.inputs if name in values]
        array, arguments = self.array("results"), self.array("arguments")
        status = self.array("status")
        names = {name.name: name for name in call.names}
        own = [(o.name, f"{array}[{i}]") for i, o in enumerate(call.program.outputs) if o.name in names]
        why = "why" if call.refusal is None else "NULL"
        lines = [
            f"const double {arguments}[] = {list_of(given or ['0.0'])};",
            f"const softkin_status {status} = {function_name(call.program)}(k, {arguments}, {array}, {why});",
            *block(f"if ({status} != SOFTKIN_OK)", [self.refusals.of_call(call, status)]),
        ]
        if call.is_conditional:
            lines = block(f"if ({self.refusals.condition([call.wanted])})", lines)
        return [
            *comment(call.note),
            f"double {array}[{len(call.program.outputs)}]{' = {0.0}' if call.is_conditional else ''};",
            *lines,
            *taken(own, {name: type_of(symbol) for name, symbol in names.items()}),
        ]

    def _search(self, search: FindRoot) -> list[str]:
        root = self.array("root")
        own = [(name.name, f"{root}[{i}]") for i, name in enumerate(search.names)]
        return [
            *comment(search.note),
            *self.search(search),
            f"double {root}[{len(search.names)}];",
            f"softkin_nearest_root(&search, {self.sought(search)}, {root});",
            *taken(own, {name.name: type_of(name) for name in search.names}),
        ]

    def search(self, search: FindRoot) -> list[str]:
        """The search as data."""
        names = ", ".join(f"{function_name(p)}_at" for p in (search.trial, search.finish))
        sides = [f"const int sides[] = {list_of(map(str, search.sides))};"] if search.is_listed else []
        listed = f"{'sides' if sides else 'NULL'}, {len(search.sides)}"
        sizes = f"{directions_of(search)}, {len(search.names)}, {listed}"
        return [
            f"const double arguments[] = {list_of(self.printer.name(s) for s in arguments_read(search))};",
            *sides,
            f"const softkin_search search = {{k, arguments, {names}, {sizes}}};",
        ]

    def sought(self, search: FindRoot) -> str:
        """The start of the scan, and whether the scan is wanted."""
        return f"{self.printer.print(search.start)}, {self.printer.print(search.wanted)}"


def directions_of(search: FindRoot) -> int:
    """The number of directions of a trial."""
    return 0 if search.is_listed else (len(search.trial.outputs) - 4) // 2


def arguments_read(search: FindRoot) -> list[sp.Symbol]:
    """The arguments that the trial or the end of a search reads."""
    given = {s for program in (search.trial, search.finish) for s in search.given(program)}
    return [name for name in search.arguments if name in given]


def of_search(search: FindRoot) -> list[list[str]]:
    """The functions through which the search calls its trial and its end."""
    found = []
    places = _PLACES | {name.name: f"arguments[{i}]" for i, name in enumerate(arguments_read(search))}
    given = "const void *machine, const double *arguments, const softkin_place *place, double *results"
    for program in (search.trial, search.finish):
        name = function_name(program)
        read = search.given(program)
        inner = [
            *([] if {*PLACE} & {*read} else ["(void)place;"]),
            f"const double given[] = {list_of(places[s.name] for s in read)};",
            f"return {name}(machine, given, results, NULL);",
        ]
        found.append(function_of("", f"static softkin_status {name}_at({given})", inner))
    return found


def searches(program: Program) -> list[FindRoot]:
    """The searches that a program makes."""
    return [s for s in program.body if isinstance(s, FindRoot)]


def declarations(names: Sequence[sp.Symbol]) -> list[str]:
    """Variables without a value, of one type a line."""
    lines = []
    for kind in ("double", "int", "bool"):
        own = [spelled(name.name) for name in names if type_of(name) == kind]
        lines += [f"{kind} {', '.join(own)};"] if own else []
    return lines


def without_brackets(value: sp.Basic, text: str) -> str:
    """A choice that is bound to a name needs no brackets."""
    return text[1:-1] if isinstance(value, Select) and text.startswith("(") else text
