"""Programs as data: what they read, the graph of their values, and what the verifier refuses."""

import re

import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.graph import Graph, Value
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, ToReal
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.symbols import count, real, symbols_of
from derive.ir.verify import BrokenProgram, verify

A, B, X, Y, Z = (real(n) for n in "abxyz")
SAMPLE = Program(
    "sample",
    (X, Y),
    (Let(A, X * DEGREE), Require(sp.Gt(A, Y), Status.UNREACHABLE), Let(B, A + 1)),
    (Output("o", B * real("free")),),
)


def test_what_a_statement_reads() -> None:
    assert SAMPLE.body[0].reads() == {X}
    assert SAMPLE.body[1].reads() == {A, Y}


def test_a_degree_is_no_input() -> None:
    assert symbols_of(DEGREE * X) == {X}


def test_what_a_program_reads_is_what_it_does_not_bind() -> None:
    assert SAMPLE.reads() == {X, Y, real("free")}


def test_its_parts_in_order() -> None:
    assert [let.name for let in SAMPLE.lets()] == [A, B]
    assert [r.otherwise for r in SAMPLE.requires()] == [Status.UNREACHABLE]


def test_a_choice_between_equals_is_none() -> None:
    assert Select(sp.Gt(X, 0), A, A) == A
    assert Select(sp.Gt(X, 0), A, B) != A


def test_statuses_are_enumerators_of_the_controller() -> None:
    assert len({s.value for s in Status}) == len(Status) == 6
    assert all(s.value.startswith("SMC_") for s in Status)


@pytest.fixture
def graph() -> Graph:
    return Graph()


def leaf(graph: Graph, head: sp.Basic) -> Value:
    return graph.leaf(head)


def test_a_sum_is_the_same_in_any_order_and_its_opposite_is_the_same_node(graph: Graph) -> None:
    x, y = leaf(graph, X), leaf(graph, Y)
    difference = graph.sum([x, -y])
    assert graph.sum([-y, x]) == difference
    assert graph.sum([y, -x]) == -difference


def test_signs_of_factors_and_divisors_stand_beside_the_product(graph: Graph) -> None:
    x, y, z = (leaf(graph, s) for s in (X, Y, Z))
    quotient = graph.product([x, y], [z])
    assert graph.product([-y, x], [z]) == -quotient
    assert graph.product([-y, -x], [-z]) == -quotient


def test_equal_terms_are_counted_and_opposite_ones_cancel(graph: Graph) -> None:
    x, y = leaf(graph, X), leaf(graph, Y)
    assert graph.sum([x, y, -x]) == y
    assert graph.sum([x, -x]) == graph.leaf(sp.Integer(0))
    assert graph.sum([x, x]) == graph.product([graph.leaf(sp.Integer(2)), x])


def test_numbers_are_put_together(graph: Graph) -> None:
    x, two, three = leaf(graph, X), graph.leaf(sp.Integer(2)), graph.leaf(sp.Integer(-3))
    assert graph.sum([two, x, three]) == graph.sum([x, graph.leaf(sp.Integer(-1))])
    assert graph.product([two, x, three]) == -graph.product([graph.leaf(sp.Integer(6)), x])
    assert graph.product([graph.leaf(sp.Integer(0)), x]) == graph.leaf(sp.Integer(0))


def test_a_cosine_does_not_know_the_sign_of_its_angle(graph: Graph) -> None:
    x = leaf(graph, X)
    assert graph.apply(sp.cos, [-x]) == graph.apply(sp.cos, [x])
    assert graph.apply(sp.sin, [-x]) == -graph.apply(sp.sin, [x])
    assert graph.apply(Root, [-x]) != graph.apply(Root, [x])


def test_a_choice_that_is_decided_is_none(graph: Graph) -> None:
    """A choice with a decided condition or equal sides is the chosen value."""
    x, y = leaf(graph, X), leaf(graph, Y)
    condition = graph.apply(sp.Gt, [x, y])
    assert graph.apply(Select, [graph.leaf(sp.true), x, y]) == x
    assert graph.apply(Select, [condition, y, y]) == y
    assert graph.apply(Select, [condition, -x, -y]) == -graph.apply(Select, [condition, x, y])
    assert graph.apply(sp.Gt, [graph.leaf(sp.Integer(2)), graph.leaf(sp.Integer(-2))]) == graph.leaf(sp.true)


def test_a_part_of_a_condition_that_is_decided_is_not_asked(graph: Graph) -> None:
    condition = graph.apply(sp.Gt, [leaf(graph, X), leaf(graph, Y)])
    true, false = graph.leaf(sp.true), graph.leaf(sp.false)
    assert graph.apply(sp.And, [condition, true, condition]) == condition
    assert graph.apply(sp.And, [condition, false]) == false
    assert graph.apply(sp.Or, [condition, true]) == true


def test_what_is_made_of_whole_numbers_is_whole_until_it_is_converted(graph: Graph) -> None:
    turn = leaf(graph, count("turn"))
    degrees = graph.product([graph.leaf(sp.Integer(360)), turn])
    assert degrees.node.is_whole
    assert not graph.apply(ToReal, [turn]).node.is_whole
    assert not leaf(graph, X).node.is_whole


def test_what_is_shared_is_asked_once_whether_it_is_whole(graph: Graph) -> None:
    """A value that is reached along 2^200 ways is told at once."""
    value, other = leaf(graph, X), leaf(graph, Y)
    for _ in range(200):
        value = graph.product([value, graph.sum([value, other])])
    assert not value.node.is_whole


def program(*body: Statement, inputs: tuple[sp.Symbol, ...] = (X, Y), output: sp.Expr = X) -> Program:
    return Program("sample", inputs, body, (Output("result", output),))


def test_every_primitive_is_accepted() -> None:
    far = sp.And(sp.Gt(X, 0), sp.Or(sp.Le(Y, 1), sp.Lt(X, Y)), sp.Ge(Y, -1))
    sample = program(
        Let(Z, sp.sin(X) + sp.cos(Y) * sp.Abs(X) - Root(X**2) / Y + X**-2 + sp.Rational(1, 3) + sp.Float(0.5)),
        Require(far, Status.UNREACHABLE),
        Let(real("turn"), NearestPeriod(Atan2(Y, X) / DEGREE, Z)),
        Let(real("on_arc"), NearestOnArc(X, Y, 90 * DEGREE)),
        Let(real("choice"), Select(far, X, Select(sp.true, Y, Z))),
        output=real("choice"),
    )
    assert verify(sample) is sample


BROKEN = {
    "a name that nothing binds": (program(Let(Z, X + real("w"))), "'w' is read before it is bound"),
    "a name that is bound later": (program(Let(Z, real("w")), Let(real("w"), X)), "'w' is read before it is bound"),
    "a name that binds itself": (program(Let(Z, Z + 1)), "'z' is read before it is bound"),
    "an unbound condition": (program(Require(sp.Gt(Z, 0), Status.UNREACHABLE)), "'z' is read before it is bound"),
    "an unbound output": (program(output=Z), "'z' is read before it is bound"),
    "an unbound name in a choice": (program(Let(Z, Select(sp.Gt(real("w"), 0), X, Y))), "'w' is read before"),
    "a name twice": (program(Let(Z, X), Let(Z, Y)), "'z' is bound twice"),
    "an input bound again": (program(Let(X, Y)), "'x' is bound twice"),
    "one name in two spellings": (
        program(Let(real("cos_a12"), X), Let(real("cos_a_12"), Y)),
        "'cos_a_12' is bound twice (also as 'cos_a12')",
    ),
    "two inputs of one spelling": (program(inputs=(X, real("a_1"), real("a1"))), "'a1' is bound twice (also as 'a_1')"),
    "an upper case letter": (program(Let(real("Z"), X)), "'Z' is not a portable"),
    "a leading digit": (program(Let(real("2z"), X)), "'2z' is not a portable"),
    "a leading underscore": (program(Let(real("_z"), X)), "'_z' is not a portable"),
    "a trailing underscore": (program(Let(real("z_"), X)), "'z_' is not a portable"),
    "a double underscore": (program(Let(real("z__a"), X)), "'z__a' is not a portable"),
    "a blank": (program(Let(real("z a"), X)), "'z a' is not a portable"),
    "a letter of another alphabet": (program(Let(real("φ"), X)), "'φ' is not a portable"),
    "no name": (program(Let(real(""), X)), "'' is not a portable"),
    "a square root": (program(Let(Z, sp.sqrt(X))), "is not an integer power"),
    "a surd": (program(Let(Z, X * sp.sqrt(3))), "power sqrt(3) is not an integer power"),
    "a real exponent": (program(Let(Z, X ** sp.Float(2.5))), "is not an integer power"),
    "a variable exponent": (program(Let(Z, X**Y)), "is not an integer power"),
    "an exponential": (program(Let(Z, sp.exp(X))), "exp is not a primitive"),
    "a tangent": (program(Let(Z, sp.tan(X))), "tan is not a primitive"),
    "an arc cosine": (program(Let(Z, sp.acos(X))), "acos is not a primitive"),
    "SymPy's own arc tangent": (program(Let(Z, sp.atan2(X, Y))), "atan2 is not a primitive"),
    "a maximum": (program(Let(Z, sp.Max(X, Y))), "Max is not a primitive"),
    "a case distinction": (program(Let(Z, sp.Piecewise((X, X > 0), (Y, True)))), "Piecewise is not a primitive"),
    "pi": (program(Let(Z, sp.pi * X)), "Pi is not a primitive"),
    "an infinity": (program(Let(Z, sp.oo * sp.Abs(X), "")), "is not a primitive"),
    "not a number": (program(Let(Z, sp.nan)), "NaN is not a primitive"),
    "an imaginary number": (program(Let(Z, sp.I * X)), "ImaginaryUnit is not a primitive"),
    "an equation": (program(Require(sp.Eq(X, Y), Status.UNREACHABLE)), "Eq(x, y) mixes types"),
    "an inequation": (program(Require(sp.Ne(X, Y), Status.UNREACHABLE)), "Ne(x, y) mixes types"),
    "a negation": (program(Require(sp.Not(sp.And(X > 0, sp.Eq(Y, 1), evaluate=False)), Status.OK)), "mixes types"),
    "the opposite of a condition": (
        program(Require(sp.Not(sp.And(X > 0, Y > 1)), Status.OK)),
        "is not the opposite of a flag",
    ),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_broken_programs_are_refused(kind: str) -> None:
    broken, message = BROKEN[kind]
    with pytest.raises(BrokenProgram, match="^sample: .*" + re.escape(message)):
        verify(broken)
