"""`Call` in the step of `Iterate`: its semantics, its passes and its cost, and equal answers in every language."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp

from derive.emit.page.lines import Lines
from derive.emit.page.names import Spelling
from derive.ir.interpret import repeats_counted, run
from derive.ir.one_row import Repeats
from derive.ir.passes import normalise
from derive.ir.program import Call, Iterate, Let, Output, Program, shared
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram, verify
from derive.lowering.passes import ANY_TURN, DERIVED, NOTHING, UNCONVERTED, WITHOUT_SQUARES, applied
from derive.lowering.unrolling import is_straight
from derive.optimize.regular import regular
from derive.report.cost import Cost, cost_of
from tests.unit.ir.nested_loops import (
    BEGIN,
    CHANGE,
    END,
    FIRST,
    GUESS,
    LANGUAGES,
    LEVEL,
    MEAN,
    OTHER,
    PROGRAMS,
    RADICAND,
    ROWS,
    SECOND,
    TAKEN,
    TINY,
    answers,
    find_mean,
    interpreted,
    settle,
)  # fmt: skip

OK, REFUSED = ["OK"] * 4, ["BAD_INPUT", "IMPOSSIBLE", "BAD_INPUT"]


def passes(row: tuple[float, float]) -> int:
    """The passes of a mean, with the square root of the processor."""
    mean, other = row
    return 1 if abs(mean - other) <= 1e-12 * mean else 1 + passes(((mean + other) / 2, (mean * other) ** 0.5))


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_conditional_call_in_a_loop(language: str, tmp_path: Path) -> None:
    """The means are those of mpmath, rows end at different passes, and a refusal inside is that of the caller."""
    found = answers(language, "find_mean", tmp_path)
    assert [status for status, _ in found] == OK + REFUSED
    for (mean, _), row in zip((values for _, values in found[:4]), ROWS, strict=False):
        assert mean == pytest.approx(float(mpmath.agm(*row)), rel=1e-14)
    assert 1 / found[1][1][0] == pytest.approx(0.8346268416740731, rel=1e-14)  # Gauss's constant
    assert [values[1] for _, values in found[:4]] == [*map(passes, ROWS[:4])] == [6, 5, 1, 8]


@pytest.mark.parametrize("language", LANGUAGES)
def test_three_levels(language: str, tmp_path: Path) -> None:
    """A called program loops and calls itself; its refusal becomes that of the caller; its results count at the end."""
    found = answers(language, "settle", tmp_path)
    assert [status for status, _ in found] == OK + ["INVALID_COUPLING"] * 3
    wanted = interpreted("settle")
    for (_, values), (_, known), (_, end) in zip(found[:4], wanted[:4], ROWS, strict=False):
        assert values[0] == pytest.approx(end, rel=2e-9) and values == pytest.approx(known, rel=1e-12)
    assert found[2][1][1] == 1 and all(values[1] > 60 for _, values in (found[0], found[1], found[3]))


def test_passes_of_programs_keep_the_answers() -> None:
    """The passes of a derived inverse neither drop nor move a call of a loop."""
    program = settle()
    values = {"begin": np.array([24.0, 1e80]), "end": np.array([6.0, 1.0]), "tiny": np.array(1e-12)}
    wanted, statuses = run(program, values)
    for passes_of_it in (DERIVED, ANY_TURN, UNCONVERTED, WITHOUT_SQUARES):
        changed = applied(passes_of_it, program, NOTHING)
        (loop,) = (s for s in changed.body if isinstance(s, Iterate))
        assert [c.program.name for c in loop.calls()] == ["find_mean"]
        found, again = run(changed, values)
        assert list(again) == list(statuses) and found["level"][0] == wanted["level"][0]
    assert regular(program, ["tiny"]) is None and not is_straight(program)


def test_only_what_is_read_is_bound() -> None:
    """A result that nothing reads is dropped in a loop, too; one that is read behind the loop alone is kept."""
    (loop,) = settle().body
    assert isinstance(loop, Iterate)
    (call,) = loop.calls()
    plain = replace(loop, state=(LEVEL,), start=(BEGIN,), following=(MEAN,))
    for outputs, names in (((LEVEL,), (MEAN,)), ((LEVEL, TAKEN), (MEAN, TAKEN))):
        program = normalise("p", (plain,), [Output(o.name, o) for o in outputs])
        (found,) = program.calls()
        assert found.names == names and program.inputs == (BEGIN, END, TINY)
    unread = replace(plain, done=sp.Le(LEVEL, 1), following=(LEVEL / 2,))
    (kept,) = normalise("p", (unread,), [Output("level", LEVEL)]).calls()
    assert kept.names == () and kept.program == call.program  # it can still refuse


def test_shared_programs_of_loops() -> None:
    """A program that only a loop calls is listed before its caller, and the loop reads its constants."""
    assert [p.name for p in shared([settle()])] == ["find_root", "find_mean"]
    assert TINY in settle().reads() and settle().refuses
    assert [call.program.name for call in settle().calls()] == ["find_mean"]
    for caller, called in (("find_mean", "find_root"), ("settle", "find_mean")):
        (call,) = PROGRAMS[caller].calls()
        assert call.program is PROGRAMS[called]  # as it is behind all passes


def test_the_verifier_refuses() -> None:
    """A call in a loop is checked as one outside of it."""
    (loop,) = find_mean().body
    assert isinstance(loop, Iterate)
    call, half = loop.step
    assert isinstance(call, Call)
    for broken, inputs, word in (
        (call, (FIRST, SECOND), "reads 'tiny', which is neither given nor an input"),
        (replace(call, names=(OTHER,)), (FIRST, SECOND, TINY), "'other' is bound twice"),
        (replace(call, names=(CHANGE,)), (FIRST, SECOND, TINY), "no output 'change'"),
        (replace(call, given=((RADICAND, GUESS),)), (FIRST, SECOND, TINY), "'guess' is read before it is bound"),
    ):
        with pytest.raises(BrokenProgram, match=word):
            verify(Program("p", inputs, (replace(loop, step=(broken, half)),), ()))


def test_the_passes_of_rows_that_go_on_are_counted() -> None:
    """A row that is done runs no program again: the passes of many rows are those of each alone."""
    rows = [(24.0, 6.0), (1e-3, 1e3), (3.0, 3.0), (1e80, 1.0)]
    alone = []
    for row in rows:
        with repeats_counted() as counted:
            interpreted("settle", [row])
        alone.append((counted.passes, counted.runs))
        if row != rows[-1]:
            assert sum(cost_of(settle(), repeats=counted).counts) < sum(cost_of(settle()).counts)
    with repeats_counted() as counted:
        interpreted("settle", rows)
    assert [counted.passes, counted.runs] == [sum(column, Counter()) for column in zip(*alone, strict=True)]
    assert len({str(one) for one in alone}) == 4
    with repeats_counted() as counted:
        interpreted("find_mean", rows[:3])
    assert counted.passes["both means"] == sum(map(passes, rows[:3]))


def test_cost() -> None:
    """A program in a loop counts in every pass; its own passes count as often as all runs together may make them."""
    x, y, z, t = map(real, "xyzt")
    step, found = real("step"), real("found")
    inner = Iterate((x,), (z,), (Let(step, x * y),), (step + x,), sp.Le(step, 1), 9, None, "inner")
    called = Program("called", (y, z), (inner,), (Output("found", step + 1),))
    once, one_pass = Cost(1), Cost(1, 1)
    assert cost_of(called) == once + one_pass * 9

    def looped(passes: int | None) -> Program:
        call = Call(called, ((y, t * z),), (found,), passes=passes)
        loop = Iterate((t,), (z,), (call,), (t / found,), sp.Le(found, 1), 5, None, "outer")
        return verify(Program("looped", (z,), (loop,), ()))

    own = Cost(0, 1, 1)
    assert cost_of(looped(None)) == own * 5 + cost_of(called) * 5
    assert cost_of(looped(20)) == own * 5 + once * 5 + one_pass * 20
    counted = Repeats(passes=Counter(outer=4, inner=7), runs=Counter(called=4))
    assert cost_of(looped(20), repeats=counted) == own * 4 + once * 4 + one_pass * 7
    assert cost_of(looped(None), repeats=Repeats()) == Cost()


def test_the_page() -> None:
    """A call in a loop stands in its step, under its condition."""
    lines = list(Lines(Spelling({}, ())).of(find_mean().body))
    kinds = [(line.kind, line.depth) for line in lines]
    place = kinds.index(("call", 2))
    assert kinds[place - 1] == ("where", 1) and "FindRoot" in lines[place].note
    assert "refused" not in lines[place].note
