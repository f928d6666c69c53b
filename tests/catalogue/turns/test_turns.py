"""Ranges around one turn, in both languages: a path is refused at their ends and never jumps; a turn inside can be
named."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import pytest

from derive.description.mechanism import Mechanism
from derive.ir.constants import ONE_TURN
from tests.catalogue.turns.axes import FULL, MECHANISMS, TurningAxis, turning_axes
from tests.catalogue.turns.callers import InPython, OnController
from tests.catalogue.turns.following import Make, check_anywhere, check_edges, follow
from tests.catalogue.turns.ranges import FEW_STEPS, FEW_WIDTHS, GAP_THAT_NO_STEP_CROSSES, STEPS, WIDTHS, Range, placed

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
