"""A draft as a program: a named value is bound before it is first read, and so is a value that is read twice.

Statements keep their order; a binding stands just before the first statement that reads it.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean

from derive.ir.graph import ODD, PRODUCT, SUM, Node, Value, reached
from derive.ir.passes import with_inputs
from derive.ir.primitives import Atan2, Select
from derive.ir.program import Call, Let, Output, Program, Solve, Statement, rewritten
from derive.ir.symbols import Names, count, is_count
from derive.lowering.cutting import LONGEST, SHORT, letters
from derive.lowering.draft import Draft, Effect, Item, Named, read_values
from derive.lowering.wording import name_for

_WHOLE = count("whole")
"""A representative of all integers, from which the type of a computed value is found."""


def written(
    draft: Draft, constants: Mapping[Node, Named], taken: Iterable[str] = (), *, modulo_turns: bool = False
) -> Program:
    """The program of a draft. constants: values bound elsewhere; taken: names in use; modulo_turns: see `lowered`."""
    elsewhere = {named.name.name for named in constants.values()}
    writer = _Writer(draft, dict(constants), Names({*taken, *elsewhere, *_names_in(draft)}), modulo_turns)
    body = tuple(writer.statements())
    outputs = tuple(Output(o.name, writer.text(v)) for o, v in zip(draft.program.outputs, draft.outputs, strict=True))
    return with_inputs(replace(draft.program, body=(*body, *writer.last), outputs=outputs))


def _names_in(draft: Draft) -> Iterator[str]:
    program = draft.program
    yield from (s.name for s in (*program.inputs, *program.bound()))
    yield from (named.name.name for named in draft.names.values())


@dataclass
class _Writer:
    draft: Draft
    constants: dict[Node, Named]
    free: Names
    modulo_turns: bool
    last: list[Statement] = field(default_factory=list)
    """The statements that only the outputs need."""

    def __post_init__(self) -> None:
        self.names = {n: named for n, named in self.draft.names.items() if n not in self.constants}
        self.bound: set[Node] = set(self.constants)
        self._texts: dict[Node, sp.Expr] = {n: named.sign * named.name for n, named in self.constants.items()}
        self._name_what_is_read_twice()

    # --- names

    def _name_what_is_read_twice(self) -> None:
        readers = Counter[Node]()
        first: dict[Node, Node | None] = {}
        seen: set[Node] = set()

        def count_readers(values: Iterable[Value], reader: Node | None) -> None:
            pending = [(value.node, reader) for value in reversed(tuple(values))]
            while pending:
                node, user = pending.pop()
                if node.is_leaf or node in self.constants:
                    continue
                readers[node] += 1
                first.setdefault(node, user)
                if node in seen:
                    continue
                seen.add(node)
                above = node if node in self.names else user
                pending += [(source, above) for source in reversed(node.read)]

        for item in self.draft.items:
            count_readers(read_values(item), None)
        count_readers(self.draft.outputs, None)
        for node in sorted((n for n, times in readers.items() if times > 1), key=lambda n: n.place):
            if node not in self.names and not is_condition(node) and not _is_slight(node, self.names):
                self.names[node] = self._new_name(node, first[node])
        self._name_what_is_long(first)

    def _name_what_is_long(self, first: Mapping[Node, Node | None]) -> None:
        """Name the longest parts of each value that is too long to be written out."""
        lengths: dict[Node, int] = {}
        for node in sorted(first, key=lambda n: n.place):
            parts = {n: letters(n, self.names) or letters(n, self.constants) or lengths[n] for n in node.read}
            whole = sum(parts[n] for n in node.read)
            for part in sorted(parts, key=lambda n: (-parts[n], n.place)):
                if whole <= LONGEST or parts[part] <= SHORT:
                    break
                if part in lengths and part not in self.names and not is_condition(part):
                    self.names[part] = self._new_name(part, first[part])
                    whole -= node.read.count(part) * (parts[part] - letters(part, self.names))
            lengths[node] = whole

    def _new_name(self, node: Node, reader: Node | None) -> Named:
        """A new name for a value, or for its negative where that has fewer minus signs."""
        known = None if reader is None else self.names.get(reader) or self.constants.get(reader)
        value = Value(node, self._better_sign(node))
        proposal = name_for(value, self._called, "" if known is None else known.name.name)
        order = len(self.draft.program.body) if known is None else known.order
        has_whole_sides = node.head is Select and known is not None and is_count(known.name)
        return Named(
            self.free.fresh(proposal, _WHOLE if has_whole_sides or node.is_whole else None), value.sign, "", order
        )

    def _called(self, node: Node) -> sp.Expr | None:
        """The name of a value; for a divisor that a choice keeps from zero, the name of the value in this choice."""
        for value in (_guarded(node), node):
            if isinstance(value.head, sp.Symbol):
                return value.head
            named = self.names.get(value) or self.constants.get(value)
            if named is not None:
                return named.sign * named.name
        return None

    # --- statements

    def statements(self) -> Iterator[Statement]:
        """The statements; those that only the outputs need are put in `last`."""
        for item in self.draft.items:
            yield from self._item(item)
        self.last = list(self._bindings(self.draft.outputs))

    def _item(self, item: Item) -> Iterator[Statement]:
        if isinstance(item, Effect):
            yield from self._effect(item)
            return
        yield from self._bindings(item.start)
        inside = set(item.statement.bound())
        outside = [n for n in self._needed(read_values(item)) if not any(r.head in inside for r in reached([n]))]
        yield from self._let(outside)
        step: list[Statement] = []
        for inner in item.step:
            if isinstance(inner, Effect):
                step += self._effect(inner)
            elif inner in self.names:
                step += self._bindings([Value(inner, 1)])
        step += self._bindings(item.ending)
        done, *following = map(self.text, item.ending)
        yield replace(
            item.statement,
            start=tuple(map(self.text, item.start)),
            step=tuple(s for s in step if isinstance(s, Let | Solve | Call)),
            done=done,
            following=tuple(following),
        )

    def _effect(self, effect: Effect) -> Iterator[Statement]:
        yield from self._bindings(effect.values)
        texts = {expression: self.text(value) for expression, value in (*effect.read, *effect.refused)}
        yield rewritten(effect.statement, texts.__getitem__)

    def _bindings(self, values: Iterable[Value]) -> Iterator[Statement]:
        """Bind all that the values need and that is not bound yet."""
        yield from self._let(self._needed(values))

    def _let(self, nodes: Iterable[Node]) -> Iterator[Statement]:
        for node in nodes:
            named = self.names[node]
            self.bound.add(node)
            yield Let(named.name, self._spelled(node, named.sign), named.note, named.turn_of)
            self._texts[node] = named.sign * named.name

    def _needed(self, values: Iterable[Value]) -> list[Node]:
        """The named nodes that the values need, in the order of the program, but each after those that it needs."""
        found: list[Node] = []
        begun: set[Node] = set()

        def provide(node: Node) -> None:
            for inner in sorted(self._named_below(node.read), key=self._order):
                visit(inner)

        def visit(node: Node) -> None:
            if node not in begun and node not in self.bound:
                begun.add(node)
                provide(node)
                found.append(node)

        for node in sorted(self._named_below(v.node for v in values), key=self._order):
            visit(node)
        return found

    def _order(self, node: Node) -> tuple[int, int]:
        return self.names[node].order, node.place

    def _named_below(self, nodes: Iterable[Node]) -> set[Node]:
        """The nearest named nodes that are read and not bound yet."""
        found = reached(nodes, lambda node: node in self.bound or node in self.names)
        return {node for node in found if node in self.names and node not in self.bound}

    # --- expressions

    def text(self, value: Value) -> sp.Basic:
        """A value as an expression of names."""
        known = self._texts.get(value.node)
        return self._spelled(*value) if known is None else -known if value.sign < 0 else known

    def _spelled(self, node: Node, sign: int) -> sp.Basic:
        """The expression of a node, or of its negative."""
        if node.is_leaf:
            return sign * node.head if sign < 0 else node.head
        if node.head is SUM:
            return sp.Add(*(self.text(Value(t.node, sign * t.sign)) for t in node.parts))
        if node.head is PRODUCT:
            return self._product(node, sign)
        if node.head is Select:
            condition, *sides = node.parts
            return Select(self.text(condition), *(self.text(Value(side.node, sign * side.sign)) for side in sides))
        if (
            node.head is Atan2
            and self.modulo_turns
            and sign < 0
            and self.text(node.parts[0]).could_extract_minus_sign()
        ):
            return Atan2(self.text(-node.parts[0]), self.text(node.parts[1]))
        if issubclass(node.head, Relational):
            return node.head(*map(self.text, node.parts), evaluate=False)  # nothing is left to simplify: see `Graph`
        whole = node.head(*map(self.text, node.parts))
        return -whole if sign < 0 else whole

    def _product(self, node: Node, sign: int) -> sp.Expr:
        """A product, each of its sums with the sign that gives it fewer minus signs."""
        above, below = [Value(f.node, self._better_sign(f.node)) for f in node.parts], list(node.divisors)
        for value in above:
            sign *= value.sign
        if sign < 0:  # a sum with as many minus signs as plus signs takes the minus
            place = next((k for k, v in enumerate(above) if self._is_open(v.node) and not self._surplus(v.node)), 0)
            above[place : place + 1] = [-above[place]] if above else []
        factors = [self.text(f) for f in above] + [1 / self.text(Value(d, 1)) for d in below]
        if sign < 0 and not above:
            factors[0] = -factors[0]
        numbers = [f for f in factors if f.is_number]
        if len(factors) == 2 and numbers and any(f.is_Add for f in factors):
            return sp.Mul(*sorted(factors, key=lambda f: not f.is_number), evaluate=False)  # else it would be expanded
        return sp.Mul(*factors)

    def _is_open(self, node: Node) -> bool:
        """Whether a node is a sum that is written out and not named."""
        return node.head is SUM and node not in self.names and node not in self.constants

    def _better_sign(self, node: Node) -> int:
        if node.head in ODD:
            named = self.names.get(node.parts[0].node)
            return 1 if named is None else named.sign
        if not self._is_open(node):
            return self._shown_sign(Value(node, 1))
        surplus = self._surplus(node)
        return -1 if surplus < 0 or (surplus == 0 and self._shown_sign(node.parts[0]) < 0) else 1

    def _surplus(self, node: Node) -> int:
        """The number of terms of a sum without a minus sign, less the number of terms with one."""
        return sum(map(self._shown_sign, node.parts))

    def _shown_sign(self, value: Value) -> int:
        """The sign in front of a term as it is written."""
        node, sign = value
        if node.head is not PRODUCT or node in self.names or node in self.constants:
            return sign * self._sign_of_name(node)
        if any(self._is_open(f.node) and not self._surplus(f.node) for f in node.parts):
            return 1
        return sign * math.prod(map(self._better_sign, (*(f.node for f in node.parts), *node.divisors)))

    def _sign_of_name(self, node: Node) -> int:
        """-1 where the name of a node stands for its negative, else +1."""
        named = self.names.get(node) or self.constants.get(node)
        return 1 if named is None else named.sign


def _guarded(node: Node) -> Node:
    """The value that a guarded divisor stands for: `length` in select(length > tolerance, length, 1)."""
    if node.head is not Select:
        return node
    _, first, second = node.parts
    return first.node if first.sign > 0 and second.sign > 0 and second.node.head == 1 else node


def is_condition(node: Node) -> bool:
    """Whether a value is true or false."""
    return isinstance(node.head, type) and issubclass(node.head, Boolean)


def _is_slight(node: Node, names: Container[Node]) -> bool:
    """Whether a value is as short as a name: the absolute value of a name, or a multiple of a name in the program."""
    sources = node.read
    if node.head is sp.Abs and sources[0] in names:
        return True
    if node.divisors or not all(n.is_leaf for n in sources):
        return False
    return node.head is sp.Abs or (node.head is PRODUCT and sum(not n.is_number for n in sources) < 2)
