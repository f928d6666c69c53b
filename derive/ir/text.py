"""Programs as plain text, for those who work on the compiler: `softkin explain --programs`, and the tests of passes.

branch(x, y, sigma_elbow: int)
    reach = Root(x**2 + y**2)  # length of the arm
    require reach > 1 else UNREACHABLE: QUANTITY reach OUT_OF_REACH, missing 1 - reach [u]
    if reach > 2:
        cos_q1 = x/reach
    else:
        cos_q1 = cos(free)
    return axis_a1 = Atan2(y, cos_q1)/DEGREE
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

import sympy as sp

from derive.ir.program import Iterate, Let, Output, Program, Require, Statement
from derive.ir.reason import Reason
from derive.ir.symbols import Flag, is_count
from derive.ir.tree import If, Item, Tree

_STEP = "    "


def text_of(program: Program) -> str:
    """A program as text."""
    return text_of_tree(Tree.of(program))


def text_of_tree(tree: Tree) -> str:
    """A program with choices as text."""
    head = f"{tree.program.name}({', '.join(map(_declared, tree.program.inputs))})"
    returned = (f"{_STEP}return {text}" for text in _returned(tree.program.outputs))
    return "\n".join([head, *_indented(tree.items), *returned, ""])


def _returned(outputs: Iterable[Output]) -> Iterator[str]:
    """The outputs; those that are values of their own names stand on one line."""
    for is_named, group in groupby(outputs, lambda output: output.name == str(output.value)):
        if is_named:
            yield ", ".join(output.name for output in group)
        else:
            yield from (f"{output.name} = {output.value}" for output in group)


def lines_of(item: Item) -> Iterator[str]:
    """The lines of a statement, or of a choice."""
    match item:
        case Let():
            yield _with_note(f"{_declared(item.name)} = {item.value}", item.comment)
        case Require():
            because = "" if item.reason is None else f": {_because(item.reason)}"
            yield _with_note(f"require {item.condition} else {item.otherwise.name}{because}", item.note)
        case If():
            yield from (f"if {item.condition}:", *_indented(item.holds), "else:", *_indented(item.fails))
        case Iterate():
            yield _with_note(f"repeat at most {item.limit} times, from {_bound_to(item.state, item.start)}:", item.note)
            yield from _indented(item.step)
            refusal = "" if item.otherwise is None else f" else {item.otherwise.name}"
            yield f"{_STEP}until {item.done}{refusal}, then {_bound_to(item.state, item.following)}"
        case _:
            yield _with_note(_any(item), item.note)


def _any(item: Statement) -> str:
    """A statement of any other kind: its names, its kind, its programs and its expressions."""
    given = (*(program.name for program in item.programs()), *map(str, item.children()))
    return f"{', '.join(map(_declared, item.bound()))} = {type(item).__name__}({', '.join(given)})"


def _indented(items: Iterable[Item]) -> Iterator[str]:
    return (f"{_STEP}{line}" for item in items for line in lines_of(item))


def _declared(name: sp.Symbol) -> str:
    return f"{name}: bool" if isinstance(name, Flag) else f"{name}: int" if is_count(name) else str(name)


def _with_note(line: str, note: str) -> str:
    return f"{line}  # {note}" if note else line


def _because(reason: Reason) -> str:
    subject, unit = reason.subject, f" [{reason.unit.value}]" if reason.unit.value else ""
    missing = "" if reason.amount is None else f", missing {reason.amount}{unit}"
    return f"{subject.kind.name} {subject.name} {reason.why.name}{missing}"


def _bound_to(names: Iterable[sp.Symbol], values: Iterable[sp.Expr]) -> str:
    return ", ".join(f"{_declared(name)} = {value}" for name, value in zip(names, values, strict=True))
