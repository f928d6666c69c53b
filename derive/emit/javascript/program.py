"""A program as a JavaScript function with early returns: a refusal returns a `Refusal`, anything else an array."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import sympy as sp

from derive.emit.braces import block, indented
from derive.emit.interface import Shape, names, read_by
from derive.emit.javascript.functions import Function
from derive.emit.javascript.layout import comment, commented
from derive.emit.javascript.printer import PRINTER, function_name, list_of, names_of, spelled
from derive.emit.javascript.refusal import Refusals, condition_of
from derive.ir.primitives import Select
from derive.ir.program import (
    Call,
    FindRoot,
    Iterate,
    Let,
    Require,
    Solve,
    binds,
)
from derive.ir.symbols import PLACE, is_condition
from derive.ir.tree import If, Item, grouped
from derive.lowering.decided import decided
from derive.lowering.scheduling import structured

_PLACE = "({ tried, side, freed, freed_angle }) => "


def function_lines(function: Function, refusals: Refusals) -> list[str]:
    """The function: it takes its arguments apart, then makes the statements of the program in their order."""
    read = read_by(function.program)
    constants = sorted(read - function.entry.given)
    head = [f"const {{ {', '.join(map(_taken, constants))} }} = k;"] if constants else []
    given = [(name, shape) for name, shape in function.arguments if read & set(names(shape))]
    head += [f"const {_target(shape, read)} = {name};" for name, shape in given]
    lines = _Body(refusals).lines(structured(function.program))
    values = {o.name: PRINTER.print(o.value) for o in decided(function.program).outputs}
    result = "null" if function.result is None else _value(function.result, values)
    taken = ", ".join(["k", *(name for name, _ in function.arguments)])
    text = block(f"function {function.name}({taken})", [*head, *lines, f"return {result};"])
    return [f"/** {function.entry.summary} */", *text]


def _taken(constant: str) -> str:
    return constant if spelled(constant) == constant else f"{constant}: {spelled(constant)}"


def _target(shape: Shape, read: set[str]) -> str:
    """A pattern that takes an array apart; values that are not read have no name."""
    if isinstance(shape, str):
        return spelled(shape) if shape in read else ""
    parts = [_target(part, read) if read & set(names(part)) else "" for part in shape]
    while parts and not parts[-1]:
        parts.pop()
    return list_of(parts)


def _value(shape: Shape, values: dict[str, str]) -> str:
    return values[shape] if isinstance(shape, str) else list_of(_value(part, values) for part in shape)


@dataclass
class _Body:
    """The statements of one function."""

    refusals: Refusals
    calls: int = 0
    """The number of results of calls that have a name."""
    declared: set[sp.Symbol] = field(default_factory=set)
    """The names that are declared before the choice that gives them."""

    def lines(self, items: Sequence[Item]) -> list[str]:
        """Statements, choices with their sides."""
        return [line for item, same in grouped(items) for line in self._item(item, same)]

    def _item(self, item: Item, same: tuple[Require, ...]) -> list[str]:
        if isinstance(item, Require):
            return self.refusals.lines(same)
        if isinstance(item, If):
            return self._choice(item)
        if isinstance(item, Let):
            return self._let(item)
        if isinstance(item, Solve):
            return [*comment(item.note), f"const {solved(item)};"]
        if isinstance(item, Iterate):
            return self._loop(item)
        return self._call(item) if isinstance(item, Call) else self._search(item)

    def _let(self, let: Let, *, declares: bool = True) -> list[str]:
        word = "const " if declares and let.name not in self.declared else ""
        value = without_brackets(let.value, PRINTER.value(let.name, let.value))
        return commented(f"{word}{spelled(let.name.name)} = {value};", let.comment)

    def _choice(self, arms: If) -> list[str]:
        own = [name for name in arms.names if name not in self.declared]
        head = [f"let {', '.join(names_of(own))};"] if own else []
        self.declared.update(own)
        holds, fails = self.lines(arms.holds), self.lines(arms.fails)
        first = block(f"if ({condition_of([arms.condition])})", holds)
        return [*head, *first[:-1], "} else {", *indented(fails), "}"]

    def _loop(self, loop: Iterate) -> list[str]:
        """The step, then the end of the loop or the next state; the names of the step are read behind it, too."""
        step = [name for s in loop.step for name in binds(s)]
        start = zip(names_of(loop.state), self._values(loop, loop.start), strict=True)
        following = zip(names_of(loop.state), self._values(loop, loop.following), strict=True)
        done = condition_of([loop.done])
        refusal = "" if loop.otherwise is None else self.refusals.of_loop(loop.otherwise, loop)
        inner = [
            *(block(f"if (pass === {loop.limit})", [refusal]) if refusal else []),
            *(line for s in loop.step for line in self._step(s)),
            f"if ({done}) break;",
            *(f"{name} = {value};" for name, value in following),
        ]
        return [
            *comment(loop.note),
            f"let {', '.join(f'{name} = {value}' for name, value in start)};",
            f"let {', '.join(names_of(step))};",
            *block(f"for (let pass = 0; {'' if refusal else f'pass < {loop.limit}'}; pass += 1)", inner),
        ]

    def _step(self, statement: Let | Solve) -> list[str]:
        if isinstance(statement, Let):
            return self._let(statement, declares=False)
        return [*comment(statement.note), f"{solved(statement)};"]

    @staticmethod
    def _values(loop: Iterate, values: Sequence[sp.Basic]) -> list[str]:
        return [PRINTER.value(name, value) for name, value in zip(loop.state, values, strict=True)]

    def _call(self, call: Call) -> list[str]:
        values = dict(call.given)
        given = [PRINTER.value(name, values[name]) for name in call.program.inputs if name in values]
        found = self._found()
        value = f"{function_name(call.program.name)}(k, {list_of(given)})"
        if call.is_conditional:
            nothing = list_of("false" if is_condition(o.value) else "0.0" for o in call.program.outputs)
            value = f"{condition_of([call.wanted])} ? {value} : {nothing}"
        wanted = {name.name for name in call.names}
        taken = _trimmed([spelled(o.name) if o.name in wanted else "" for o in call.program.outputs])
        tail = [f"const {list_of(taken)} = {found};"] if taken else []
        refused = self.refusals.of_call(call, found)
        return [*comment(call.note), f"const {found} = {value};", f"if ({found} instanceof Refusal) {refused}", *tail]

    def _search(self, search: FindRoot) -> list[str]:
        return [*comment(search.note), f"const {list_of(names_of(search.names))} = {looked_for(search)};"]

    def _found(self) -> str:
        self.calls += 1
        return "found" if self.calls == 1 else f"found{self.calls}"


def without_brackets(value: sp.Basic, text: str) -> str:
    """A choice that is bound to a name needs no brackets."""
    return text[1:-1] if isinstance(value, Select) and text.startswith("(") else text


def looked_for(search: FindRoot, function: str = "nearestRoot") -> str:
    """The call of the root scan, whose trials are functions of the place."""
    programs = [
        f"{_PLACE}{function_name(p.name)}(k, {list_of(_given(s) for s in search.given(p))})"
        for p in (search.trial, search.finish)
    ]
    values = [PRINTER.print(search.start), PRINTER.print(search.wanted), str(len(search.names))]
    values += [list_of(map(str, search.sides))] if search.is_listed else []
    return f"{function}({', '.join([*programs, *values])})"


def _given(name: sp.Symbol) -> str:
    """An argument of a trial: a part of the place, which the search sets, or a value."""
    return name.name if name in PLACE else PRINTER.name(name)


def solved(system: Solve) -> str:
    """`[determinant, x, y] = solveLinear(matrix, right)`, matrices by rows."""
    targets = ["" if system.determinant is None else spelled(system.determinant.name), *names_of(system.names)]
    matrix, right = _matrix(system.matrix, system.size), _matrix(system.right, system.columns)
    return f"{list_of(targets)} = solveLinear({matrix}, {right})"


def _matrix(entries: Sequence[sp.Expr], width: int) -> str:
    rows = [entries[i : i + width] for i in range(0, len(entries), width)] if entries else []
    return list_of(list_of(map(PRINTER.print, row)) for row in rows)


def _trimmed(targets: list[str]) -> list[str]:
    while targets and not targets[-1]:
        targets.pop()
    return targets
