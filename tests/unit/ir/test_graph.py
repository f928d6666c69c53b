"""The graph of values: which values are one node, and where its sign stands."""

import pytest
import sympy as sp

from derive.ir.graph import Graph, Value
from derive.ir.primitives import Root, Select, ToReal
from derive.ir.symbols import count, real

X, Y, Z = map(real, "xyz")


@pytest.fixture
def graph() -> Graph:
    return Graph()


def leaf(graph: Graph, head: sp.Basic) -> Value:
    return graph.leaf(head)


def test_a_sum_is_the_same_in_any_order_and_its_opposite_is_the_same_node(graph: Graph) -> None:
    """Sums in any order are one node, and the opposite sum is the same node with a sign."""
    x, y = leaf(graph, X), leaf(graph, Y)
    difference = graph.sum([x, -y])
    assert graph.sum([-y, x]) == difference
    assert graph.sum([y, -x]) == -difference


def test_signs_of_factors_and_divisors_stand_beside_the_product(graph: Graph) -> None:
    """The signs of factors and divisors are collected in one sign beside the product."""
    x, y, z = (leaf(graph, s) for s in (X, Y, Z))
    quotient = graph.product([x, y], [z])
    assert graph.product([-y, x], [z]) == -quotient
    assert graph.product([-y, -x], [-z]) == -quotient


def test_equal_terms_are_counted_and_opposite_ones_cancel(graph: Graph) -> None:
    """Equal terms become a multiple, and opposite terms cancel."""
    x, y = leaf(graph, X), leaf(graph, Y)
    assert graph.sum([x, y, -x]) == y
    assert graph.sum([x, -x]) == graph.leaf(sp.Integer(0))
    assert graph.sum([x, x]) == graph.product([graph.leaf(sp.Integer(2)), x])


def test_numbers_are_put_together(graph: Graph) -> None:
    """Numbers in sums and products are combined."""
    x, two, three = leaf(graph, X), graph.leaf(sp.Integer(2)), graph.leaf(sp.Integer(-3))
    assert graph.sum([two, x, three]) == graph.sum([x, graph.leaf(sp.Integer(-1))])
    assert graph.product([two, x, three]) == -graph.product([graph.leaf(sp.Integer(6)), x])
    assert graph.product([graph.leaf(sp.Integer(0)), x]) == graph.leaf(sp.Integer(0))


def test_a_cosine_does_not_know_the_sign_of_its_angle(graph: Graph) -> None:
    """Cosines of opposite angles are one node, and sines differ by a sign."""
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
    """Decided and repeated parts of a condition are dropped."""
    condition = graph.apply(sp.Gt, [leaf(graph, X), leaf(graph, Y)])
    true, false = graph.leaf(sp.true), graph.leaf(sp.false)
    assert graph.apply(sp.And, [condition, true, condition]) == condition
    assert graph.apply(sp.And, [condition, false]) == false
    assert graph.apply(sp.Or, [condition, true]) == true


def test_what_is_made_of_whole_numbers_is_whole_until_it_is_converted(graph: Graph) -> None:
    """Expressions of whole numbers are whole until they are converted to a real number."""
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
