"""Both-sided splits of a chain: T = L M S, so that L^-1 T S^-1 = M holds for every part M of the chain.

Positions are split once, before anything is known: behind the flange part S that no joint moves the origin of (the
wrist centre is what position and rotation say together), and in front of the part L up to the first joint. Rotations
are split again whenever an angle is known: the known turns at both ends are taken to the side of the commanded rotation,
turn by turn, each entry under a name: `r13_from_a12` is r13 as seen from behind A1 and A2, `r13_before_a6` in front of A6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.algebra import cosine, is_compound, polynomial, reduce_units, sine
from derive.composite import name_of, terms_of
from derive.frames import Chain, Factor, Motion
from derive.joints import COORDINATE_NAMES
from derive.pose import pose_of
from derive.problem import Equation, Problem
from derive.program import Let, real

_MOST_UNKNOWN = 2
"""No subproblem takes an equation with more unknown angles."""


def is_spatial(chain: Chain) -> bool:
    """Whether a chain turns about more than one axis."""
    return len({f.axis for f in chain.factors if f.motion is Motion.TURN}) > 1


@dataclass(frozen=True)
class Target:
    """A commanded point: its coordinates, and the names of what they are made of."""

    point: tuple[sp.Expr, ...]
    lets: tuple[Let, ...] = ()


@dataclass(frozen=True)
class Commanded:
    """The commanded rotation, and which of its columns are followed."""

    rotation: sp.Matrix
    columns: tuple[int, ...]


@dataclass(frozen=True)
class Unknowns:
    """What the equations of a chain are to be solved for, and what their normal form needs."""

    angles: tuple[sp.Symbol, ...]
    lengths: tuple[sp.Symbol, ...]
    units: tuple[sp.Symbol, ...]
    signs: tuple[sp.Symbol, ...]

    def form(self, expression: sp.Expr) -> sp.Expr:
        """The normal form."""
        return polynomial(expression, self.units, self.signs)

    def of(self, form: sp.Expr) -> set[sp.Symbol]:
        """The unknowns in a normal form."""
        present: set[sp.Symbol] = set(form.free_symbols)
        angles = {a for a in self.angles if present & {a, sine(a), cosine(a)}}
        return angles | (set(self.lengths) & present)


def split_positions(chain: Chain, commanded: Commanded, unknowns: Unknowns) -> tuple[Equation, ...]:
    """The position equations of a chain, at the split that leaves some unknown alone, else those of the whole chain."""
    point = [real(c) for c in COORDINATE_NAMES]
    factors, target = chain.factors, Target(tuple(point))
    if commanded.columns:
        factors, target = _behind_the_wrist(chain, sp.Matrix(point), commanded, unknowns)
    first = next(i for i, f in enumerate(factors) if f.amount.free_symbols & {*unknowns.angles, *unknowns.lengths})
    whole, behind = _equations(factors, -1, target, unknowns), _equations(factors, first, target, unknowns)
    return behind if _alone(behind, unknowns) > _alone(whole, unknowns) else whole


def _alone(equations: Sequence[Equation], unknowns: Unknowns) -> int:
    """How many equations leave some unknown alone."""
    return sum(len(unknowns.of(e.expression)) == 1 for e in equations)


def _behind_the_wrist(
    chain: Chain, point: sp.Matrix, commanded: Commanded, unknowns: Unknowns
) -> tuple[tuple[Factor, ...], Target]:
    """The part of the chain to the point that the commanded pose fixes and the fewest joints move."""
    best, target = chain.factors, Target(tuple(point))
    fewest = len(_movers(chain, unknowns))
    for cut in reversed([i for i, f in enumerate(chain.factors) if f.motion is Motion.TURN]):
        rest = pose_of(Chain(chain.factors[cut:]))
        seen = [unknowns.form(v) for v in -(rest.rotation.T * rest.position)]
        if any(unknowns.of(v) for v in seen) or any(v != 0 for i, v in enumerate(seen) if i not in commanded.columns):
            break  # its place in what is commanded of the flange is no longer fixed
        front = Chain(chain.factors[:cut])
        if len(_movers(front, unknowns)) < fewest:
            best, target, fewest = front.factors, _wrist(point, commanded.rotation, seen), len(_movers(front, unknowns))
    return best, target


def _movers(chain: Chain, unknowns: Unknowns) -> set[sp.Symbol]:
    """The joints that move the end point of a chain."""
    moved: set[sp.Symbol] = set(pose_of(chain).position.free_symbols)
    return moved & {*unknowns.angles, *unknowns.lengths}


def _wrist(point: sp.Matrix, rotation: sp.Matrix, seen: Sequence[sp.Expr]) -> Target:
    moved = point + rotation * sp.Matrix(seen)
    lets = []
    for c, value in zip(COORDINATE_NAMES, moved, strict=True):
        note = "the point that the last joints turn about" if c == "x" else ""
        lets.append(Let(real(f"wrist_{c}"), value, note))
    if not any(is_compound(let.value) for let in lets):
        return Target(tuple(moved))
    return Target(tuple(let.name for let in lets), tuple(lets))


def _equations(factors: Sequence[Factor], first: int, target: Target, unknowns: Unknowns) -> tuple[Equation, ...]:
    """The equations of the point seen from behind the joint at `first` and what is fixed to it; -1: from the base."""
    moving = {*unknowns.angles, *unknowns.lengths}
    end = first + 1
    while first >= 0 and end < len(factors) and not factors[end].amount.free_symbols & moving:
        end += 1
    front, rest = pose_of(Chain(tuple(factors[:end]))), pose_of(Chain(tuple(factors[end:])))
    seen = front.rotation.T * (sp.Matrix(target.point) - front.position)
    word = "" if first < 0 else f"_from_{_movers_name(factors[first], unknowns)}"
    found = []
    for c, left, right in zip(COORDINATE_NAMES, seen, rest.position, strict=True):
        form = unknowns.form(right - left)
        used = tuple(let for let in target.lets if let.name in form.free_symbols)
        found.append(Equation(f"{c}{word}", form, used))
    return tuple(found)


def _movers_name(factor: Factor, unknowns: Unknowns) -> str:
    return name_of(tuple((s, 1) for s in (*unknowns.angles, *unknowns.lengths) if s in factor.amount.free_symbols))


def rotations(problem: Problem) -> tuple[Equation, ...]:
    """What the commanded rotation says of the turns that are still unknown, the known ones at both ends taken away."""
    if not problem.turns or not any(_unknown(problem, t) for t in problem.turns):
        return ()
    turns = list(problem.turns)
    lets: list[Let] = []
    entries = sp.Matrix(3, 3, list(problem.rotation))
    front, back = _Side("from", "base"), _Side("before", "flange")
    while not _unknown(problem, turns[0]):
        turn = turns.pop(0)
        front = front.behind(_word(problem, turn), turn)
        entries = _named(problem, _matrix(problem, turn, lets).T * entries, front.suffix, lets)
    while len(problem.columns) == 3 and not _unknown(problem, turns[-1]):
        turn = turns.pop()
        back = back.behind(_word(problem, turn), turn)
        entries = _named(problem, entries * _matrix(problem, turn, lets).T, front.suffix + back.suffix, lets)
    return _entry_equations(problem, turns, entries, tuple(lets))


@dataclass(frozen=True)
class _Side:
    """The turns that have been taken away at one end."""

    word: str
    end: str
    joints: tuple[str, ...] = ()
    """Base first."""
    fixed: int = 0
    """How many oblique fixed turns there are since the last joint: one by right angles makes no new entries."""

    def behind(self, joints: tuple[str, ...], turn: Factor) -> _Side:
        """One turn further inwards."""
        if joints:
            return replace(self, joints=(*self.joints, *joints) if self.word == "from" else (*joints, *self.joints), fixed=0)
        is_oblique = any(entry not in (-1, 0, 1) for entry in turn.matrix())
        return replace(self, fixed=self.fixed + is_oblique)

    @property
    def suffix(self) -> str:
        """What tells the entries there from all others: `_from_a12`, `_from_a12_turned`, `_before_flange`."""
        turned = ("", "_turned", *(f"_turned_{n}" for n in range(2, self.fixed + 1)))
        if self.joints:
            return f"_{self.word}_{name_of(tuple((real(name), 1) for name in self.joints))}{turned[self.fixed]}"
        return f"_{self.word}_{self.end}{turned[self.fixed - 1]}" if self.fixed else ""


def _entry_equations(
    problem: Problem, turns: Sequence[Factor], entries: sp.Matrix, lets: tuple[Let, ...]
) -> tuple[Equation, ...]:
    middle = pose_of(Chain(tuple(turns))).rotation
    found = []
    for i in range(3):
        for j in problem.columns:
            if len({a for a in problem.angles if a in middle[i, j].free_symbols}) > _MOST_UNKNOWN:
                continue
            if any(a in middle[i, j].free_symbols for a in problem.pending):
                continue
            form = polynomial(middle[i, j], problem.units, problem.signs)
            if problem.unknowns_of(form):
                expression = reduce_units(form - entries[i, j], problem.units, problem.signs)
                found.append(Equation(f"r{i + 1}{j + 1}", expression, _needed(lets, expression), is_length=False))
    return tuple(found)


def _needed(lets: Sequence[Let], expression: sp.Expr) -> tuple[Let, ...]:
    """The lets that an expression refers to, through other lets, in order."""
    wanted = set(expression.free_symbols)
    kept: list[Let] = []
    for let in reversed(lets):
        if let.name in wanted:
            kept.append(let)
            wanted |= let.value.free_symbols
    return tuple(reversed(kept))


def _unknown(problem: Problem, turn: Factor) -> bool:
    return bool(turn.amount.free_symbols & {*problem.angles, *problem.pending})


def _word(problem: Problem, turn: Factor) -> tuple[str, ...]:
    """The joints of a turn, for names."""
    return tuple(a.name for a in problem.units if a in turn.amount.free_symbols)


def _matrix(problem: Problem, turn: Factor, lets: list[Let]) -> sp.Matrix:
    """The matrix of a known turn; the cosine and sine of a sum of angles under their names."""
    matrix = sp.Matrix(turn.matrix()[:3, :3])
    table: dict[sp.Expr, sp.Expr] = {}
    for function in sorted(matrix.atoms(sp.sin, sp.cos), key=sp.default_sort_key):
        table[function] = polynomial(function, problem.units, problem.signs)
        terms = terms_of(function.args[0], problem.units)
        if terms is not None and len(terms) > 1:
            name = real(f"{'sin' if isinstance(function, sp.sin) else 'cos'}_{name_of(terms)}")
            lets.append(Let(name, table[function]))
            table[function] = name
    return matrix.xreplace(table)


def _named(problem: Problem, entries: sp.Matrix, word: str, lets: list[Let]) -> sp.Matrix:
    """The entries under names of their own, where they are more than a name."""
    named = sp.zeros(3, 3)
    for i in range(3):
        for j in range(3):
            value = entries[i, j]
            if is_compound(value):
                lets.append(Let(real(f"r{i + 1}{j + 1}{word}"), value))
                value = lets[-1].name
            named[i, j] = value
    return named
