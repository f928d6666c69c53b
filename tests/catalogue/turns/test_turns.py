"""Ranges around one turn, in both languages: a path is refused at their ends and never jumps."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import pytest
from softkin import Frame

from derive.description.mechanism import Mechanism
from derive.ir.constants import ONE_TURN
from tests.catalogue.turns.axes import (
    FEW_STEPS,
    FEW_WIDTHS,
    FULL,
    GAP_THAT_NO_STEP_CROSSES,
    MECHANISMS,
    REACH,
    STEPS,
    WIDTHS,
    Asked,
    Axes,
    Caller,
    InPython,
    OnController,
    Range,
    TurningAxis,
    number_of,
    placed,
    turning_axes,
)

CLOSE = 1e-7
"""Degrees, to the value that is commanded: poses are regular. Frames: relative to the sizes of their entries."""
Make = Callable[[Mechanism, Mapping[str, float]], Caller]
AROUND = (-2.5, -1.5, -0.5, 0.5, 1.5)
"""Steps from the end of a range, along the way out."""
TARGETS = (-4.0, -1e-3, 0.0, 1e-3, 60.0)
"""From the lower end inward, and from the upper end inward."""
REFERENCES = (0.0, 1e-3, 91.0, -181.0, 359.0, -1083.0, 36005.0)
"""From the target."""


def check_edges(axis: TurningAxis, limits: Range, step: float, make: Make) -> None:
    """Paths out of both ends of a range, over the end and back: each reference is the last answer."""
    for end, way in ((limits.upper, 1.0), (limits.lower, -1.0)):
        caller = make(axis.mechanism, axis.parameters(end, limits.lower, limits.upper))
        values = [end + way * step * k for k in AROUND if abs(step * k) < REACH]
        follow(axis, limits, caller, values + values[::-1])
        caller.check_alike()


def follow(axis: TurningAxis, limits: Range, caller: Caller, path: Sequence[float]) -> int:
    """A path of the axis from a value inside; the number of steps that were answered."""
    last, before, answered = axis.at(path[0]), path[0], 0
    assert limits.has(before), "it starts outside"
    for value in path:
        found = ask(axis, limits, caller, value, last)
        if found is not None:
            way = abs(value - before)
            if way < GAP_THAT_NO_STEP_CROSSES or not limits.has_one_value:
                assert abs(found[axis.index] - last[axis.index]) <= min(way, 180.0) + CLOSE, f"{axis} {limits} jumps"
            last, before, answered = found, value, answered + 1
    return answered


def check_anywhere(axis: TurningAxis, limits: Range, make: Make) -> None:
    """Single calls to values inside and outside of a range, from references inside and outside."""
    for value in (*(limits.lower + t for t in TARGETS), *(limits.upper - t for t in TARGETS)):
        caller = make(axis.mechanism, axis.parameters(value, limits.lower, limits.upper))
        for away in REFERENCES:
            ask(axis, limits, caller, value, axis.at(value + away))
        caller.check_alike()


def ask(axis: TurningAxis, limits: Range, caller: Caller, value: float, reference: Axes) -> Axes | None:
    """The inverse at the frame of an axis value, with branches named and turns open."""
    i, branches = axis.index, len(axis.mechanism.branches)
    frame, written = caller.forward(axis.at(value))
    asked = Asked(frame, (*written[:branches], *(0 for _ in written[branches:])), reference)
    found = caller.inverse(asked)
    expected = limits.answer(value, reference[i])
    if limits.is_sharp(value):
        assert (found is None) == (expected is None), f"{axis} {limits} at {value} from {reference[i]}: {found}"
    if found is None:
        _check_refusal(axis, limits, caller, value, asked)
    else:
        assert limits.has(found[i])
        assert expected is None or abs(found[i] - expected) < CLOSE
        assert_reaches(caller, found, frame)
    return found


def _check_refusal(axis: TurningAxis, limits: Range, caller: Caller, at: float, asked: Asked) -> None:
    """Where another turn is inside, the reason says so, and the byte is answered; else it does not."""
    inside = limits.inside(at)
    reason, missing, turn = caller.why(asked)
    assert missing > 0.0
    if limits.is_sharp(at):
        assert bool(turn) == bool(inside), f"{axis} {limits} at {at}: {reason} {turn}"
    assert reason.startswith(f"{axis.joint.name}: ")
    assert reason.endswith(" [deg]")
    assert ("turn" in reason) == (turn != 0)
    for value in inside:
        number = number_of(value)
        if limits.is_sharp(at) and not _is_on_an_edge(value):
            _answered(axis, caller, asked, number, value)
    if turn:
        _answered(axis, caller, asked, turn, None)


def _answered(axis: TurningAxis, caller: Caller, asked: Asked, turn: int, value: float | None) -> None:
    named = (*asked.configuration[: axis.byte], turn, *asked.configuration[axis.byte + 1 :])
    found = caller.inverse(replace(asked, configuration=named))
    assert found is not None, f"{axis}: turn {turn} is refused"
    assert value is None or abs(found[axis.index] - value) < CLOSE
    assert_reaches(caller, found, asked.frame)


def assert_reaches(caller: Caller, axes: Axes, frame: Frame) -> None:
    """Forward kinematics gives the frame again."""
    found, _ = caller.forward(axes)
    rows = zip(found.rotation, frame.rotation, strict=True)
    assert all(abs(a - b) < 1e-8 for one, other in rows for a, b in zip(one, other, strict=True))
    allowed = 1e-8 * (1e3 + max(map(abs, frame.position)))
    assert all(abs(a - b) < allowed for a, b in zip(found.position, frame.position, strict=True))


def _is_on_an_edge(value: float) -> bool:
    """Whether it is where one turn ends and the next begins."""
    return abs((value + 360.0) % 360.0 - 180.0) < 1e-8


pytestmark = pytest.mark.broad

THOROUGH = tuple(m for m in MECHANISMS if m.name in FULL)
BOTH = pytest.mark.parametrize("make", [InPython, OnController])


def named(mechanism: Mechanism) -> str:
    """The name of a mechanism, for the name of a test."""
    return mechanism.name


def ranges_of(axis: TurningAxis, widths: Sequence[float]) -> list[Range]:
    """The ranges that the vendor's allow; of a machine with many axes, every axis has them at another place."""
    places = slice(axis.index % 3, None, 3) if len(axis.mechanism.joints) > 3 else slice(None)
    found = [r for width in widths for r in list(placed(width))[places] if axis.allows(r.lower, r.upper)]
    assert {r.has_one_value for r in found} == {True, False}
    return found


def test_the_rule() -> None:
    """No step of a path crosses the gap that is left."""
    assert 360.0 - float(ONE_TURN) == GAP_THAT_NO_STEP_CROSSES > max(STEPS)
    assert [w for w in WIDTHS if Range(-w / 2, w / 2).has_one_value] == [180.0, 340.0, 350.0]


def asked(mechanism: Mechanism, *, short: bool) -> Iterator[tuple[TurningAxis, Range]]:
    """The axes of a mechanism and their ranges: of two mechanisms all, of others some. short: of those every other."""
    for axis in turning_axes(mechanism):
        if mechanism in THOROUGH and not short:
            yield from ((axis, limits) for limits in ranges_of(axis, WIDTHS))
        else:
            widths = FEW_WIDTHS[::2] if short else FEW_WIDTHS[1:]
            yield from ((axis, limits) for limits in ranges_of(axis, widths)[:: 3 - len(axis.base) // 4])


@pytest.mark.slow("Planar", "Ac6", "Articulated")
@pytest.mark.long("Ac6", "P2C", "Pos_RRR")
@BOTH
@pytest.mark.parametrize("mechanism", MECHANISMS, ids=named)
def test_edges(mechanism: Mechanism, make: Make) -> None:
    """At edges of ranges of an axis, the axis takes its value inside."""
    for axis, limits in asked(mechanism, short=False):
        for step in STEPS if mechanism in THOROUGH else FEW_STEPS:
            check_edges(axis, limits, step, make)


@pytest.mark.slow("Planar", "Ac6", "Articulated")
@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "make"),
    [
        *(pytest.param(m, InPython, id=m.name) for m in MECHANISMS),
        *(pytest.param(m, OnController, id=f"{m.name}-OnController") for m in THOROUGH),
    ],
)
def test_references_anywhere(mechanism: Mechanism, make: Make) -> None:
    """An axis takes the turn that its range and the reference decide."""
    for axis, limits in asked(mechanism, short=mechanism not in THOROUGH):
        check_anywhere(axis, limits, make)


@pytest.mark.slow("Articulated")
@BOTH
@pytest.mark.parametrize("mechanism", THOROUGH, ids=named)
@pytest.mark.parametrize("step", [8.97, -8.97, 2.3])
def test_a_turn_and_more(mechanism: Mechanism, step: float, make: Make) -> None:
    """From the middle of the range out, through the gap and back into it from the other side."""
    axis = turning_axes(mechanism)[0]
    values = [step * k for k in range(int(400.0 / abs(step)))]
    for width in WIDTHS:
        limits = Range(-width / 2, width / 2)
        caller = make(mechanism, axis.parameters(0.0, limits.lower, limits.upper))
        answered = follow(axis, limits, caller, values)
        assert int(width / 2 / abs(step)) < answered < len(values)
        caller.check_alike()


@BOTH
def test_where_the_inverse_is_a_search(make: Make) -> None:
    """The turn of every axis is chosen the same way: A6, along which it searches, and an axis that it finds there."""
    (mechanism,) = (m for m in MECHANISMS if m.search)
    for axis in (turning_axes(mechanism)[0], turning_axes(mechanism)[5]):
        lateral = replace(axis, given={p.name: p.nominal for p in mechanism.parameters})
        for limits in (Range(-175.0, 175.0), Range(-180.0, 180.0)):
            caller = make(mechanism, lateral.parameters(limits.upper, limits.lower, limits.upper))
            assert follow(lateral, limits, caller, [limits.upper + 6.0 * k for k in (-1, 0, 1)]) == 2
