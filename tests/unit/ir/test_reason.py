"""Reasons in the passes: an amount is right wherever its refusal is moved, and costs nothing where nothing refuses."""

from dataclasses import replace

import pytest
import sympy as sp

from derive.ir.passes import hoist, normalise, with_inputs, without_reasons
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Status, rewritten
from derive.ir.program import reason_expressions as told
from derive.ir.reason import Kind, OtherTurn, Reason, Subject, Unit, Why, about, about_joint
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram

A, B, C, D, X, Y, K = (real(n) for n in "abcdxyk")
OUT = [Output("o", X + 1)]
POSITIVE = sp.Gt(X, 0)


def refusing(amount: sp.Expr, condition: sp.Basic = POSITIVE) -> Require:
    return Require(condition, Status.UNREACHABLE, reason=about_joint(A, Why.OUT_OF_REACH, amount, Unit.LENGTH))


def amount_of(program: Program) -> sp.Expr | None:
    """The amount of the only reason."""
    (require,) = program.requires()
    assert require.reason is not None
    return require.reason.amount


def test_what_only_an_amount_reads_is_written_out_in_it() -> None:
    """A value that only the amount of a reason reads is written into the amount."""
    program = normalise("p", [Let(B, 2 * X), Let(C, B + Y), refusing(C**2)], OUT)
    assert program.bound() == ()
    assert amount_of(program) == (2 * X + Y) ** 2
    assert program.inputs == (X, Y)


def test_what_is_bound_before_the_refusal_is_read() -> None:
    """An amount reads a value that is bound before its condition by its name."""
    program = normalise("p", [Let(B, 2 * X), refusing(B + 1, sp.Gt(B, 0))], [Output("o", B)])
    assert program.bound() == (B,)
    assert amount_of(program) == B + 1


def test_what_is_bound_behind_the_refusal_is_written_out() -> None:
    """The order is that of the values that are needed: an amount moves none of them."""
    program = normalise("p", [Let(B, 2 * X), refusing(B + 1)], [Output("o", B**2 + B)])
    assert [type(s) for s in program.body] == [Require, Let]
    assert amount_of(program) == 2 * X + 1


def test_aliases_are_folded_in_amounts() -> None:
    """A name for another name is replaced in amounts, too."""
    assert amount_of(normalise("p", [Let(B, X), refusing(B + Y)], OUT)) == X + Y


def test_amounts_read_constants_that_are_hoisted() -> None:
    """An amount reads a hoisted constant by its name."""
    program = normalise("p", [Let(B, 2 * K), Let(C, B + X), refusing(B, sp.Gt(C, 0))], [Output("o", C)])
    (lowered,), hoisted = hoist([program], ["k"])
    assert [let.value for let in hoisted] == [2 * K]
    assert amount_of(lowered) == hoisted[0].name


def test_an_amount_does_not_count_as_read() -> None:
    """It is computed where the program refuses, and nowhere else."""
    statement = refusing(Y)
    assert statement.reads() == {X}
    assert list(told(statement)) == [Y]


def test_a_name_that_an_amount_reads_is_an_input() -> None:
    """A name that only an amount reads is an input of the program."""
    assert with_inputs(Program("p", (), (refusing(Y),), ())).inputs == (X, Y)


def test_an_amount_of_nothing_is_found() -> None:
    """An amount that reads a value before it is bound is refused."""
    with pytest.raises(BrokenProgram, match="'y' is read before it is bound"):
        with_inputs(Program("p", (), (refusing(Y), Let(Y, X)), ()))


def test_every_expression_of_a_reason_is_rewritten() -> None:
    """Rewriting a condition rewrites every expression of its reason."""
    turns = (OtherTurn("A", X, (X, X + 1), (2 * X,)),)
    statement = replace(refusing(X), reason=Reason(Subject(Kind.JOINT, "a"), Why.BELOW, X, Unit.ANGLE, turns))
    changed = rewritten(statement, lambda e: e.xreplace({X: Y}))
    assert list(told(changed)) == [Y, Y, Y, Y + 1, 2 * Y]


def test_who_is_told_nothing_computes_nothing() -> None:
    """Without reasons a program neither computes amounts nor reads their inputs."""
    program = without_reasons(normalise("p", [Let(B, Select(sp.Gt(Y, 0), Y, X)), refusing(B)], OUT))
    assert amount_of(program) is None
    assert program.inputs == (X,)
    assert program.requires()[0].condition == sp.Gt(X, 0)
    assert program.requires()[0].comment == "a: out of reach"


def test_the_reader_is_told_the_reason_or_the_note() -> None:
    """The comment of a condition is its note, else its reason."""
    assert refusing(X).comment == "a: out of reach"
    assert replace(refusing(X), note="limits of A").comment == "limits of A"
    assert Let(A, X, "by the sum", turn_of="A1").comment == "by the sum; A1: whole turns added"


def test_every_sentence_takes_one_name() -> None:
    """Every sentence of a reason has at most one place for a name."""
    for why in Why:
        assert why.value.count("{}") <= 1
        assert about("NAME", why).words.count("NAME") == why.value.count("{}")
