"""Unrolled branches: one after the other, with the names of the one before, and what both sides of a choice bind."""

from __future__ import annotations

import sympy as sp

from derive.ir.passes import normalise
from derive.ir.primitives import Root
from derive.ir.program import Let, Output, Program, Statement
from derive.ir.symbols import Sign, real, without_words
from derive.lowering.scheduling import scheduled
from derive.lowering.unrolling import unroll
from derive.optimize.coalesce import coalesced
from tests.unit.answers import values

ARM, ELBOW = Sign(real("sigma_arm"), ("front", "back")), Sign(real("sigma_elbow"), ("down", "up"))
SIGNS = (ARM, ELBOW)
A, B, C, P, Q, R, X, Y = (real(n) for n in "abcpqrxy")


def unrolled(*body: Statement, outputs: dict[str, sp.Expr]) -> Program:
    return unroll(normalise("p", body, [Output(name, value) for name, value in outputs.items()]), SIGNS)


def test_branches_come_one_after_the_other_and_the_opposite_takes_no_minus() -> None:
    """The outputs of the branches are in the order of the slots."""
    body = (Let(P, -Root(X) * ELBOW.symbol), Let(Q, Y * ARM.symbol + P), Let(R, Root(Q) + P))
    program = unrolled(*body, outputs={"o": R})
    outputs = [o.name for o in program.outputs if o.name.startswith("o_")]
    assert outputs == ["o_front_down", "o_front_up", "o_back_down", "o_back_up"]
    assert values(program)["p_up"] == Root(X)


def test_a_branch_uses_the_names_of_the_one_before() -> None:
    """A branch reuses the names of values that the branch before no longer needs."""
    body = (Let(P, Y * ARM.symbol + Root(X)), Let(Q, Root(P) + ELBOW.symbol), Let(R, Root(Q) + P))
    program = unrolled(*body, outputs={"o": R})
    wanted = [o.value for o in program.outputs]
    items, names = coalesced(scheduled(program.body, wanted), wanted, SIGNS)
    bound = [item.name.name for item in items if isinstance(item, Let)]
    front, back = (["p", "root_of_p", "q", f"r_{arm}_down", "q", f"r_{arm}_up"] for arm in ("front", "back"))
    assert bound == ["root_of_x", *front, *back]
    assert [names[v].name for v in sorted(names, key=str) if v.name.startswith("r_")] == [
        "r_back_down", "r_back_up", "r_front_down", "r_front_up",
    ]  # fmt: skip


def test_words_behind_a_name() -> None:
    """A name is split into the neutral name and the words of its branches."""
    assert without_words("axis_a1_front_up", SIGNS) == ("axis_a1", ("front", "up"))
    assert without_words("cos_q1_back", SIGNS) == ("cos_q1", ("back",))
    assert without_words("up", SIGNS) == ("up", ())
