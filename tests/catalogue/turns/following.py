"""Calls on a turning axis, each against what its range allows: never a jump, and a refusal that says whether the turn
refuses."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from softkin import Frame

from derive.description.mechanism import Mechanism
from tests.catalogue.turns.axes import REACH, Axes, TurningAxis
from tests.catalogue.turns.callers import Asked, Caller
from tests.catalogue.turns.ranges import GAP_THAT_NO_STEP_CROSSES, Range, number_of

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
    """Where another turn is inside, the reason says that the turn refuses, and the byte is
    answered; else it does not.
    """
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
