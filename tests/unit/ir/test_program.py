"""Programs as data: the names that they read, and the simplifications of primitives."""

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.symbols import real, symbols_of

A, B, X, Y = (real(n) for n in "abxy")
SAMPLE = Program(
    "sample",
    (X, Y),
    (Let(A, X * DEGREE), Require(sp.Gt(A, Y), Status.UNREACHABLE), Let(B, A + 1)),
    (Output("o", B * real("free")),),
)


def test_what_a_statement_reads() -> None:
    """A statement reads the names in its expressions."""
    assert SAMPLE.body[0].reads() == {X}
    assert SAMPLE.body[1].reads() == {A, Y}


def test_a_degree_is_no_input() -> None:
    """The constant DEGREE is no input."""
    assert symbols_of(DEGREE * X) == {X}


def test_what_a_program_reads_is_what_it_does_not_bind() -> None:
    """A program reads the names that it does not bind."""
    assert SAMPLE.reads() == {X, Y, real("free")}


def test_its_parts_in_order() -> None:
    """The values and the conditions of a program are listed in their order."""
    assert [let.name for let in SAMPLE.lets()] == [A, B]
    assert [r.otherwise for r in SAMPLE.requires()] == [Status.UNREACHABLE]


def test_a_choice_between_equals_is_none() -> None:
    """A choice between equal values is that value."""
    assert Select(sp.Gt(X, 0), A, A) == A
    assert Select(sp.Gt(X, 0), A, B) != A


def test_statuses_are_enumerators_of_the_controller() -> None:
    """Every status is a different error of SoftMotion."""
    assert len({s.value for s in Status}) == len(Status) == 6
    assert all(s.value.startswith("SMC_") for s in Status)
