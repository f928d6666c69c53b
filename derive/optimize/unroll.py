"""Unroll: all branches of a program in one straight line.

A statement stands once for every assignment of the branch signs that it depends on:

    Let(cos_a1, x / reach)               →  cos_a1                       depends on no sign
    Let(sin_a2, root(s) * sigma_elbow)   →  sin_a2_right, and -sin_a2_right instead of another name
    Let(axis_a1, f(cos_a1, sin_a2))      →  axis_a1_right, axis_a1_left
    Require(c(sin_a2), UNREACHABLE)      →  refusal_right = 0, or the number of the status; likewise refusal_left

A condition that no sign influences stays a condition: it refuses all branches alike. Programs are total, so that a
branch that is refused disturbs no other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby, product

import sympy as sp

from derive.ir.names import Names
from derive.ir.passes import normalise, renamed
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Call,
    FindRoot,
    Iterate,
    Let,
    Output,
    Program,
    Require,
    Statement,
    Status,
    binds,
    reads,
    rewritten,
)
from derive.ir.symbols import (
    count,
    is_condition,
    real,
)
from derive.ir.verify import BrokenProgram

REFUSAL = "refusal"
"""The output of a branch that is 0, or the number of the status that refuses it: its place in `Status`."""

Choice = tuple[int, ...]
"""+1 or -1 for each of some signs."""


@dataclass(frozen=True)
class Sign:
    """A branch sign, and what its two values are called."""

    symbol: sp.Symbol
    words: tuple[str, str]
    """For +1 and for -1."""


def choices(count: int) -> Iterator[Choice]:
    """All assignments of that many signs, slot by slot: the first sign varies fastest, +1 before -1."""
    return (tuple(reversed(choice)) for choice in product((1, -1), repeat=count))


def suffixed(name: str, signs: Sequence[Sign], choice: Choice) -> str:
    """A name with the words of the signs behind it: `axis_a1_right`."""
    return "_".join([name, *(s.words[0] if value > 0 else s.words[1] for s, value in zip(signs, choice, strict=True))])


def without_words(name: str, signs: Sequence[Sign]) -> tuple[str, tuple[str, ...]]:
    """A name without the words of signs behind it, and these words."""
    found: list[str] = []
    for sign in reversed(signs):
        word = next((w for w in sign.words if name.endswith(f"_{w}")), None)
        if word is not None:
            name, found = name.removesuffix(f"_{word}"), [word, *found]
    return name, tuple(found)


def is_straight(program: Program) -> bool:
    """Whether a program can be unrolled: one that iterates takes longer on some branches, and a shared one has its
    names.
    """
    return not any(isinstance(s, Iterate | Call | FindRoot) for s in program.body)


def unroll(program: Program, signs: Sequence[Sign]) -> Program:
    """All branches at once; outputs are those of every slot, and its `REFUSAL`, with the words of the slot behind the
    name.
    """
    unroller = _Unroller(tuple(signs), Names(s.name for s in program.inputs))
    for statement in program.body:
        if not isinstance(statement, Require):
            unroller.add(statement)
    refusals = unroller.refusals(program.requires())
    outputs = []
    for choice in sorted(
        choices(len(signs)), reverse=True
    ):  # one branch after the other: what two share is nearest to both
        outputs.append(Output(suffixed(REFUSAL, signs, choice), refusals[choice]))
        values = unroller.values(choice)
        outputs += [Output(suffixed(o.name, signs, choice), o.value.xreplace(values)) for o in program.outputs]
    return normalise(program.name, unroller.body, outputs)


def specialised(program: Program, values: Mapping[sp.Symbol, sp.Expr]) -> Program:
    """The program with some inputs given: choices that this decides disappear."""
    body = [rewritten(s, lambda e: e.xreplace(dict(values))) for s in program.body]
    return normalise(program.name, body, [Output(o.name, o.value.xreplace(dict(values))) for o in program.outputs])


@dataclass
class _Unroller:
    signs: tuple[Sign, ...]
    taken: Names
    body: list[Statement] = field(default_factory=list)
    _support: dict[sp.Symbol, tuple[int, ...]] = field(default_factory=dict)
    """The signs that a name depends on, by index."""
    _names: dict[tuple[sp.Symbol, Choice], sp.Expr] = field(default_factory=dict)
    """What stands for a name where the signs of its support have these values."""
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    _values_of: dict[sp.Basic, sp.Expr] = field(default_factory=dict)
    """What the new names are bound to."""

    def __post_init__(self) -> None:
        for index, sign in enumerate(self.signs):
            self._support[sign.symbol] = (index,)
            for value in (1, -1):
                self._names[sign.symbol, (value,)] = sp.Integer(value)

    def add(self, statement: Statement) -> None:
        """Bind what a statement binds, once for every assignment of its signs."""
        if isinstance(statement, Iterate | Call | FindRoot):
            raise BrokenProgram("what iterates or is shared is not unrolled")
        support = self._union(reads(statement))
        variants = [(choice, self._at(statement, support, choice)) for choice in choices(len(support))]
        for choice, changed in sorted(variants, key=lambda variant: _is_negative(variant[1])):
            if isinstance(changed, Let):
                self._names[changed.name, choice] = self._bound(changed, support, choice)
                continue
            names = {name: self._fresh(name, support, choice) for name in binds(statement)}
            self.body.append(renamed(changed, names.__getitem__))
            self._names |= {(name, choice): new for name, new in names.items()}
        self._support |= dict.fromkeys(binds(statement), support)

    def _at(self, statement: Statement, support: tuple[int, ...], choice: Choice) -> Statement:
        """The statement where its signs have values."""
        values = self._values(support, choice)
        return rewritten(statement, lambda e: e.xreplace(values))

    def values(self, choice: Choice) -> dict[sp.Basic, sp.Basic]:
        """What stands for every name where all signs have values."""
        return self._values(tuple(range(len(self.signs))), choice)

    def refusals(self, conditions: Sequence[Require]) -> dict[Choice, sp.Expr]:
        """The refusal of every slot: the first condition that does not hold there."""
        refusal = _Refusal((), {(): sp.Integer(0)}, None)
        for status, group in groupby(conditions, key=lambda r: r.otherwise):
            by_support: dict[tuple[int, ...], list[Require]] = {}
            for condition in group:
                by_support.setdefault(self._union(reads(condition)), []).append(condition)
            for support in sorted(by_support, key=lambda s: (len(s), s)):
                if not support and refusal.status in (None, status):
                    self.body += [
                        self._at(condition, (), ()) for condition in by_support[support]
                    ]  # all branches alike
                else:
                    refusal = self._refused(refusal, support, by_support[support])
        return {choice: refusal.at(choice) for choice in choices(len(self.signs))}

    def _refused(self, before: _Refusal, support: tuple[int, ...], conditions: Sequence[Require]) -> _Refusal:
        status, notes = conditions[0].otherwise, dict.fromkeys(c.comment for c in conditions if c.comment)
        joint = tuple(sorted({*before.support, *support}))
        values: dict[Choice, sp.Expr] = {}
        for choice in choices(len(joint)):
            known = self._values(joint, choice)
            holds = sp.And(*(c.condition.xreplace(known) for c in conditions))
            full = dict(zip(joint, choice, strict=True))
            earlier = before.values[tuple(full[i] for i in before.support)]
            fails = Select(holds, sp.Integer(0), sp.Integer(list(Status).index(status)))
            value = fails if earlier == 0 else Select(sp.Gt(earlier, 0), earlier, fails)
            values[choice] = self._bound(Let(count(REFUSAL), value, ", ".join(notes)), joint, choice)
        return _Refusal(joint, values, status if before.status in (None, status) else Status.OK)

    def _bound(self, let: Let, support: tuple[int, ...], choice: Choice) -> sp.Expr:
        """The name of a value, bound unless the value or its negative has a name already."""
        value = self._without_repetition(let, support, choice)
        if is_condition(value):
            return self._known[value] if value in self._known else self._named(let, value, value, support, choice)
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        key = self._written_out(value)
        if key in self._known:
            return self._known[key]
        if -key in self._known:
            return -self._known[-key]
        return self._named(let, key, value, support, choice)

    def _named(self, let: Let, key: sp.Basic, value: sp.Basic, support: tuple[int, ...], choice: Choice) -> sp.Symbol:
        name = self._fresh(let.name, support, choice)
        self._known[key] = name
        self._values_of[name] = value
        self.body.append(replace(let, name=name, value=value))
        return name

    def _written_out(self, value: sp.Expr) -> sp.Expr:
        """A sum of squares of what is bound, in terms of that: those of two branches can be equal
        though no square is.
        """
        terms = sp.Add.make_args(value)
        if len(terms) > 1 and all(t.is_Pow and t.exp == 2 and t.base in self._values_of for t in terms):
            return sp.expand(value.xreplace(self._values_of))
        return value

    def _without_repetition(self, let: Let, support: tuple[int, ...], choice: Choice) -> sp.Expr:
        """The value with a name for what stands in it twice, below a root and elsewhere."""
        value = let.value
        if not value.has(Root):
            return value
        nodes = list(sp.preorder_traversal(value))
        for radicand in dict.fromkeys(node.args[0] for node in nodes if isinstance(node, Root)):
            if radicand.args and nodes.count(radicand) > 1:
                square = Let(real(f"{let.name.name}_squared"), radicand)
                value = value.xreplace({radicand: self._bound(square, support, choice)})
        return value

    def _union(self, symbols: Iterable[sp.Symbol]) -> tuple[int, ...]:
        return tuple(sorted({index for s in symbols for index in self._support.get(s, ())}))

    def _values(self, support: tuple[int, ...], choice: Choice) -> dict[sp.Basic, sp.Basic]:
        full = dict(zip(support, choice, strict=True))
        return {
            name: self._names[name, tuple(full[i] for i in own)]
            for name, own in self._support.items()
            if set(own) <= set(support)
        }

    def _fresh(self, name: sp.Symbol, support: tuple[int, ...], choice: Choice) -> sp.Symbol:
        return self.taken.fresh(suffixed(name.name, [self.signs[i] for i in support], choice), name)


def _is_negative(statement: Statement) -> bool:
    """Whether a value has a minus in front: its opposite is named rather, so that it is taken without one."""
    return (
        isinstance(statement, Let)
        and not is_condition(statement.value)
        and bool(statement.value.could_extract_minus_sign())
    )


@dataclass(frozen=True)
class _Refusal:
    """The refusal so far: by the signs that it depends on. `status`: the one there is, OK where there are several."""

    support: tuple[int, ...]
    values: Mapping[Choice, sp.Expr]
    status: Status | None

    def at(self, choice: Choice) -> sp.Expr:
        """The refusal of a slot."""
        return self.values[tuple(choice[i] for i in self.support)]
