"""A body on plain numbers that refuses with a diagnosis, run as it is printed."""

from dataclasses import replace
from typing import Any

import pytest
import sympy as sp
from softkin import Diagnosis, Status
from softkin._configuration import turn_inside
from softkin._scalar import cos, sqrt

from derive.emit.python.printer import primitives_in
from derive.emit.python.program import Argument, Method, scalar_body
from derive.emit.python.refusal import explained
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program, Require
from derive.ir.program import Status as Outcome
from derive.ir.reason import OtherTurn, Unit, Why, about, about_joint
from derive.ir.symbols import real
from derive.report.reasons import Reasons

X, Y, Q1 = (real(n) for n in ("x", "y", "q1"))
REASONS = Reasons({"q1": "A1"})


def lines_of(program: Program, names: tuple[str, ...] = ("x", "y")) -> list[str]:
    kind = "Reals" if program.outputs else ""
    method = Method(
        "m", "", program, (Argument("given", "Reals", names),), kind, tuple(o.name for o in program.outputs)
    )
    return scalar_body(method, explained(REASONS))


def called(program: Program, *given: float, names: tuple[str, ...] = ("x", "y")) -> Any:
    scope: dict[str, Any] = {
        "Diagnosis": Diagnosis,
        "Status": Status,
        "sqrt": sqrt,
        "cos": cos,
        "turn_inside": turn_inside,
    }
    text = "\n".join(["def f(given):", *(f"    {line}" for line in lines_of(program, names))])
    exec(text, scope)
    return scope["f"](given)


def test_a_refusal_names_the_axis_and_the_amount() -> None:
    """A printed condition refuses with the axis, the reason, the unit and the missing amount."""
    require = Require(sp.Gt(X, 1), Outcome.UNREACHABLE, reason=about_joint(Q1, Why.OUT_OF_REACH, 1 - X, Unit.LENGTH))
    program = normalise("p", [require], [Output("o", X + Y)])
    assert called(program, 3.0, 4.0) == (7.0,)
    assert called(program, -2.0, 4.0) == Diagnosis(Status.UNREACHABLE, "A1: out of reach [u]", 3.0)


def test_an_amount_does_not_keep_values_out_of_a_choice() -> None:
    """What one side alone needs is computed there alone, although an amount reads it behind: that writes it out."""
    far, length, angle = sp.Gt(X, 0), real("length"), real("angle")
    lets = [
        Let(length, Root(X**2 + Y**2)),
        Let(angle, sp.cos(Y)),
        Let(real("u"), Select(far, X / (1 + length), angle)),
        Let(real("v"), Select(far, Y / (1 + length), angle * 2)),
    ]
    size = real("u") ** 2 + real("v") ** 2
    require = Require(sp.Le(size, 2), Outcome.UNREACHABLE, reason=about("the pose", Why.TOO_LARGE, angle + length))
    program = normalise("p", [*lets, require], [Output("o", real("u") + real("v"))])
    lines = lines_of(program)
    choice = next(k for k, line in enumerate(lines) if line.startswith("if x > 0"))
    assert not any(line.startswith(("length =", "angle =")) for line in lines), lines
    assert any(line.startswith("    length =") for line in lines[choice:]), lines
    refused = called(program, -1.0, 0.25)
    assert refused.reason == "the pose: too large"
    assert refused.missing == pytest.approx(float(sp.cos(0.25)) + 1.0625**0.5)
    assert called(program, 3.0, 4.0) == (pytest.approx(7.0 / 6.0),)


@pytest.mark.parametrize(
    ("axis", "turn", "words"), [(400.0, 1, "this turn is beyond a limit"), (100.0, 0, "above its")]
)
def test_another_turn_is_named(axis: float, turn: int, words: str) -> None:
    """A refused axis names a turn inside the limits where there is one, else the limit that it exceeds."""
    turns = (OtherTurn("A1", X, (sp.Integer(0),), (Y,)),)
    reason = replace(about_joint(Q1, Why.ABOVE, X - Y, Unit.ANGLE), turns=turns)
    program = normalise("p", [Require(sp.Le(X, Y), Outcome.UNREACHABLE, reason=reason)], [])
    found = called(program, axis, 50.0)
    assert (found.status, found.turn, found.missing) == (Status.UNREACHABLE, turn, axis - 50.0)
    assert words in found.reason and found.reason.startswith("A1: ") and found.reason.endswith(" [deg]")
    assert called(program, 50.0, 50.0) is None


def test_a_refusal_without_a_reason_is_none_of_the_inverse() -> None:
    """A condition without a reason cannot be printed in a method that explains its refusals."""
    program = normalise("p", [Require(sp.Gt(X, 0), Outcome.UNREACHABLE)], [Output("o", X)])
    with pytest.raises(TypeError, match="gives no reason"):
        lines_of(program)


def test_words_of_a_text_are_no_calls() -> None:
    """Names in strings and comments do not count as calls of primitives."""
    assert primitives_in(['return Diagnosis(Status.OK, "the root of cos", 0.0)', "x = sin(y)  # cos"]) == ["sin"]
