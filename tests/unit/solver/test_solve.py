"""The driver: problems that no mechanism of the catalogue has, solved, or refused with the equations left."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
import pytest
import sympy as sp

from derive.equations.problem import Problem
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Wrap
from derive.ir.program import Let, Output, Status
from derive.ir.symbols import cosine, real, sine
from derive.ir.verify import BrokenProgram
from derive.solver.derivation import Derivation
from derive.solver.derivation_record import DerivationRecord
from derive.solver.solve import solve
from derive.solver.unsolved import Unsolved
from tests.unit.solver.execution import at, distance, problem, reference

A1, A2, A3, HEADING = (real(n) for n in ("a1", "a2", "a3", "heading"))
P, Q = real("p"), real("q")
X, Y, Z = (real(n) for n in "xyz")
L1, L2 = (sp.Symbol(f"link_{k}", positive=True) for k in (1, 2))
TOOL_X, TOOL_Y, TURN = real("tool_x"), real("tool_y"), real("turn")
K = sp.Symbol("k", positive=True)
S = sp.Symbol("s", real=True, nonzero=True)
COUNT = 40


@dataclass(frozen=True)
class Case:
    """Sides that equal x, y, ...; the unknowns; the other symbols in the sides; the expected rules."""

    sides: Mapping[str, sp.Expr]
    angles: tuple[sp.Symbol, ...] = ()
    lengths: tuple[sp.Symbol, ...] = ()
    positive: tuple[sp.Expr, ...] = ()
    rules: tuple[str, ...] = ()
    slots: int = 2

    @property
    def problem(self) -> Problem:
        equations = [side - real(name) for name, side in self.sides.items()]
        unknowns = {"angles": self.angles, "lengths": self.lengths}
        return problem(*equations, **unknowns, known=(HEADING,), signs=(S,), positive=self.positive)

    @property
    def arguments(self) -> tuple[sp.Expr, ...]:
        found = {f.args[0] for side in self.sides.values() for f in side.atoms(sp.sin, sp.cos)}
        return tuple(sorted(found, key=sp.default_sort_key))

    @cached_property
    def derivation(self) -> Derivation:
        return solve(self.problem, self.arguments, lambda angle: ())


def arm(*links: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    return sp.Add(*[n * sp.cos(a) for n, a in links]), sp.Add(*[n * sp.sin(a) for n, a in links])


def plane(*links: tuple[sp.Expr, sp.Expr], x: sp.Expr | int = 0) -> dict[str, sp.Expr]:
    along, across = arm(*links)
    return {"x": along + x, "y": across}


RIGHT = sp.pi / 2
CASES = {
    "2R with a tool beside the arm": Case(
        plane((L1, A1), (L2 + TOOL_X, A1 + A2), (TOOL_Y, A1 + A2 + RIGHT)), (A1, A2), rules=("trigonometric", "pair")
    ),
    "2R with absolute angles": Case(plane((L1, A1), (L2, A2)), (A1, A2), rules=("trigonometric", "pair", "sum")),
    "2R against each other": Case(plane((L1, -A1), (L2, A2 - A1)), (A1, A2), rules=("trigonometric", "pair")),
    "2R with a driven direction": Case(
        plane((L1, S * A1), (L2, S * A1 + A2)), (A1, A2), rules=("trigonometric", "pair")
    ),
    "rail and arm": Case(plane((L1, A1), (L2, HEADING), x=P), (A1,), (P,), rules=("trigonometric", "affine")),
    "oblique rail and arm": Case(plane((P, sp.pi / 6), (L1, A1)), (A1,), (P,), rules=("trigonometric", "affine")),
    "arm and telescope with a known direction": Case(
        plane((L1, A1), (P, HEADING)), (A1,), (P,), rules=("trigonometric", "affine along")
    ),
    "telescope": Case(plane((P, A1), (L1, HEADING)), (A1,), (P,), rules=("polar",)),
    "2R whose elbow bends one way": Case(
        plane((L1, A1), (L2, A1 + A2)), (A1, A2), positive=(sp.sin(A2),), rules=("trigonometric", "pair"), slots=1
    ),
    "telescope beside its axis": Case(plane((P, A1), (TOOL_Y, A1 + RIGHT)), (A1,), (P,), rules=("quadratic", "pair")),
    "telescope that cannot turn inside out": Case(
        plane((P + K, A1)), (A1,), (P,), positive=(P + K,), rules=("polar", "affine"), slots=1
    ),
    "3R with a commanded turn": Case(
        plane((L1, A1), (L2, A1 + A2), (K, A1 + A2 + A3))
        | {"cos_turn": sp.cos(A1 + A2 + A3), "sin_turn": sp.sin(A1 + A2 + A3)},
        (A1, A2, A3),
        rules=("pair", "trigonometric", "pair", "sum"),
    ),
    "3R on a turned base": Case(
        plane((L1, A1 + sp.pi / 6), (L2, A1 + A2 + sp.pi / 6), (K, A1 + A2 + A3 + sp.pi / 6))
        | {"cos_turn": sp.cos(A1 + A2 + A3 + sp.pi / 6), "sin_turn": sp.sin(A1 + A2 + A3 + sp.pi / 6)},
        (A1, A2, A3),
        rules=("pair", "trigonometric", "pair", "sum"),
    ),
    "rails that can be parallel": Case(
        plane((P, HEADING), x=Q), (), (P, Q), rules=("affine across", "affine"), slots=1
    ),
    "belts": Case({"x": 2 * P - 3 * Q, "y": K * P + L1 * Q}, (), (P, Q), rules=("affine pair",), slots=1),
    "spherical": Case(
        {"x": P * sp.cos(A2) * sp.cos(A1), "y": P * sp.cos(A2) * sp.sin(A1), "z": P * sp.sin(A2)},
        (A1, A2),
        (P,),
        rules=("polar", "polar"),
        slots=4,
    ),
    "shoulder and elbow": Case(
        {
            "x": sp.cos(A1) * (L1 * sp.cos(A2) + L2 * sp.cos(A2 + A3)),
            "y": sp.sin(A1) * (L1 * sp.cos(A2) + L2 * sp.cos(A2 + A3)),
            "z": L1 * sp.sin(A2) + L2 * sp.sin(A2 + A3),
        },
        (A1, A2, A3),
        rules=("polar", "trigonometric", "pair"),
        slots=4,
    ),
}


def samples(case: Case) -> dict[str, np.ndarray]:
    """Unknowns and parameters by name, and the x, y, ... that they lead to."""
    generator = np.random.default_rng(7)
    draw = {n: generator.uniform(-3, 3, COUNT) for n in ("a1", "a2", "a3", "heading", "p", "q", "tool_x", "tool_y")}
    draw |= {n: generator.uniform(0.5, 2, COUNT) for n in ("link_1", "link_2", "k", "scale")}
    draw["s"] = generator.choice([-1.0, 1.0], COUNT)
    for quantity in case.positive:
        assert quantity in (P + K, sp.sin(A2))
        if quantity == P + K:
            draw["p"] = np.abs(draw["p"]) - draw["k"]
        else:
            draw["a2"] = np.abs(draw["a2"])
    sides = {name: sampled(side, draw) for name, side in case.sides.items()}
    return draw | sides


def sampled(expression: sp.Expr, numbers: Mapping[str, np.ndarray]) -> np.ndarray:
    return np.asarray([at(expression, {k: v[i] for k, v in numbers.items()}) for i in range(COUNT)])


def solutions(case: Case, derivation: Derivation, given: Mapping[str, np.ndarray]) -> list[dict[str, np.ndarray]]:
    """The values of all unknowns for every assignment of the signs."""
    names = [
        *(f(a) for a in case.angles for f in (cosine, sine)),
        *case.lengths,
        *(s.value for s in derivation.determinants),
    ]
    outputs = [Output(f"o{k}", n) for k, n in enumerate(names)]
    program = normalise("solution", derivation.statements, outputs)
    heading = {"cos_heading": np.cos(given["heading"]), "sin_heading": np.sin(given["heading"])}
    free = {reference(a).name: np.zeros(COUNT) for a in (*case.angles, *case.lengths)}
    found = []
    for signs in product((1.0, -1.0), repeat=len(derivation.determinants)):
        sigma = {s.sigma.name: np.asarray(v) for s, v in zip(derivation.determinants, signs, strict=True)}
        values, status = run(program, {**given, **heading, **free, **sigma})
        assert set(status) == {Status.OK}
        columns = iter(values.values())
        unknowns = {a.name: np.arctan2(*reversed([next(columns), next(columns)])) for a in case.angles}
        unknowns |= {v.name: next(columns) for v in case.lengths}
        for sign, determinant in zip(signs, columns, strict=True):
            assert np.all(sign * determinant > 0)
        found.append(unknowns)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_all_solutions(name: str) -> None:
    case = CASES[name]
    derivation, given = case.derivation, samples(case)
    found = solutions(case, derivation, given)
    assert len(found) == case.slots
    for unknowns in found:
        numbers = {**given, **unknowns}
        for side_name, side in case.sides.items():
            assert np.abs(sampled(side, numbers) - given[side_name]).max() <= 1e-12
    for i in range(COUNT):
        apart = [_apart(case, {k: v[i] for k, v in given.items()}, {k: v[i] for k, v in f.items()}) for f in found]
        assert sum(d < 1e-9 for d in apart) == 1  # exactly one is the solution from which the pose was made
        for first, second in product(range(len(found)), repeat=2):
            both = ({k: v[i] for k, v in found[n].items()} for n in (first, second))
            assert first == second or _apart(case, *both) > 1e-6


def _apart(case: Case, first: Mapping[str, float], second: Mapping[str, float]) -> float:
    angles = [distance(first[a.name], second[a.name]) for a in case.angles]
    return max([*angles, *(abs(first[v.name] - second[v.name]) for v in case.lengths)])


@pytest.mark.long("3R")
@pytest.mark.parametrize("name", CASES)
def test_by_these_rules(name: str) -> None:
    assert CASES[name].derivation.rules == CASES[name].rules


def test_what_cannot_vanish_is_preferred() -> None:
    """First the rotation that is commanded directly, although the wrist stands first; then the shorter formula."""
    turn = {"cos_turn": sp.cos(A1 + HEADING), "sin_turn": sp.sin(A1 + HEADING)}
    assert Case({**plane((L1, A1)), **turn}, (A1,)).derivation.conditionings == ()
    long, short = Case({"x": 2 * P + L1 * L2 - K * TOOL_X, "y": P}, (), (P,)), Case({"y": P}, (), (P,))
    assert [str(s.value) for s in long.derivation.statements] == [str(s.value) for s in short.derivation.statements]


UNSOLVED = {
    "nothing determines one length": (Case({"x": P}, (), (P, Q)), "the closure does not determine q"),
    "two lengths in one direction": (
        Case({"x": P + Q, "y": 2 * P + 2 * Q}, (), (P, Q)),
        "the closure does not determine p, q: 2 unknowns in 2 equations (first, second) leave 1 free to move",
    ),
    "no more equations than one": (Case(plane((L1, A1)), (A1, A2)), "the closure does not determine a2"),
    "a factor that can vanish": (Case({"x": TOOL_X * P}, (), (P,)), "no subproblem determines p"),
    "three links, no turn": (
        Case(plane((L1, A1), (L2, A1 + A2), (K, A1 + A2 + A3)), (A1, A2, A3)),
        "the closure does not determine a1, a2, a3: 3 unknowns in 2 equations (first, second) leave 1 free to move",
    ),
    "a length beside its own sine": (Case({"x": P * sp.sin(P) - K}, (), (P,)), "no subproblem determines p"),
    "an angle of which only the turns count": (Case({"x": K * A1}, (A1,)), "no subproblem determines a1"),
}


@pytest.mark.parametrize("name", UNSOLVED)
def test_unsolved_says_what_is_left(name: str) -> None:
    case, message = UNSOLVED[name]
    with pytest.raises(Unsolved) as refusal:
        solve(case.problem, case.arguments, lambda angle: ())
    assert message in str(refusal.value)


def test_a_step_binds_a_name_once() -> None:
    record = DerivationRecord()
    record.append((Let(P, X), Let(P, X), Let(Q, P + Y)))
    with pytest.raises(BrokenProgram, match="a step binds p twice, to x and to y"):
        record.append((Let(P, X), Let(P, Y)))


def test_turns_count_once_they_are_chosen() -> None:
    case = Case({"x": sp.cos(A1), "y": sp.sin(A1), "z": P - K * A1}, (A1,), (P,))
    turned: list[sp.Symbol] = []

    def resolve(angle: sp.Symbol) -> tuple[Let, ...]:
        turned.append(angle)
        return (Let(angle, Wrap(Atan2(sine(angle), cosine(angle))) + TURN),)

    derivation = solve(case.problem, case.arguments, resolve)
    assert turned == [A1]
    assert derivation.rules == ("pair", "affine")
    program = normalise("screw", derivation.statements, [Output("p", P)])
    values, _ = run(
        program, {n: np.asarray(v) for n, v in {"x": 0.0, "y": 1.0, "z": 3.0, "k": 2.0, "turn": 10.0}.items()}
    )
    assert values["p"] == pytest.approx(3.0 + 2.0 * (np.pi / 2 + 10.0))


def test_no_turn_is_chosen_that_nothing_needs() -> None:
    case = Case({"x": sp.cos(A1), "y": sp.sin(A1)}, (A1,))
    asked: list[sp.Symbol] = []

    def ask(angle: sp.Symbol) -> tuple[()]:
        asked.append(angle)
        return ()

    solve(case.problem, case.arguments, ask)  # type: ignore[attr-defined]
    assert asked == []
