"""Every statement of every emitted loop is executed by the tests of this folder: none is dead, none untried."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import product

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from tests.catalogue.loop_machines import loop_machine
from tests.catalogue.loops.edges import EDGES, OTHER_WAY_ROUND, PLACES
from tests.catalogue.loops.test_impossible import EDGES as ENDS
from tests.catalogue.loops.test_impossible import IMPOSSIBLE
from tests.text import test_axis_settings
from tests.text.controller import NOT_INITIALIZED, Controller, asked, assert_same
from tests.text.loops import test_branches
from tests.text.loops.test_branches import compare
from tests.text.pairs import LOOPS, Pair, pair_of, pairs_of
from tests.text.reasons import compare_reason, provoke
from tests.text.samples import NO_TURN, Bytes, Command, Sample, samples_at
from tests.text.statements import Statements
from tests.text.test_every_statement import asked_of_every_block, compare_all, few, left_out, libraries
from tests.text.units import file_of

pytestmark = pytest.mark.slow

FEW, FAR = 6, (0.3, 1.0, 3.0)
"""The number of samples, and how far beyond a pose a place is asked for: a watched call takes its time."""


@pytest.mark.parametrize("mechanism", [m for m in LOOPS if not m.home], ids=lambda m: m.name)
def test_every_statement_runs(mechanism: Mechanism) -> None:
    """Of the loops that are solved in closed form: the iteration of a platform has `tests/test_hexapod.py`."""
    loops = pairs_of(mechanism)
    statements = Statements([file_of(mechanism)], libraries(mechanism))
    with statements.watched():
        run_the_tests(mechanism, loops)
        for step in the_steps(mechanism, loops):
            if not left_out(mechanism, statements):
                break
            step()
    assert left_out(mechanism, statements) == []


def the_steps(mechanism: Mechanism, loops: tuple[Pair, ...]) -> Iterator[Callable[[], None]]:
    """What other tests ask, too: each step as long as a statement has not run, the best first."""
    yield from (partial(compare_all, loop, sample) for loop, sample in at_edges(mechanism))
    for loop in loops:
        yield from (partial(compare_all, loop, sample) for sample in (*few(loop.regular, FEW), *loop.anywhere))
    yield from (partial(go_out, loop) for loop in loops)


def run_the_tests(mechanism: Mechanism, loops: tuple[Pair, ...]) -> None:
    """What the comparisons leave out: refusals, and the other blocks."""
    for test in asked_of_every_block(loops):
        test()
    provoke(loops[1], loops[1].regular[0])
    test_branches.test_a_byte_without_a_meaning_is_refused(loops[:1])
    test_axis_settings.every_statement_of_the_settings(mechanism)
    impossible = [given | changes for name, given, changes, _ in IMPOSSIBLE.values() if name == mechanism.name]
    own = type(loops[0].robot).__name__
    impossible += [beyond(1e-6) for name, (beyond, _) in ENDS.items() if name == own]
    for given in impossible:
        assert Controller(loops[0].library, mechanism).initialise(given) == NOT_INITIALIZED


def go_out(loop: Pair) -> None:
    """Away from some poses in all directions, so that every leg in turn is the one that cannot reach."""
    own, default = loop.robot.CONFIGURATION, loop.robot.DEFAULT_CONFIGURATION
    for index in range(loop.robot.BRANCHES):
        sample = loop.regular[0]
        wrong = (*default[:index], 4, *default[index + 1 :])
        compare_offset(loop, loop.robot.forward(sample.axes)[0].position, sample, wrong)
    for sample in loop.regular[:3]:
        position, _ = loop.robot.forward(sample.axes)[0]
        for share, x, y, z in product(FAR, (-1, 0, 1), (-1, 0, 1), (-1, 0, 1)):
            size = share * loop.machine.reach
            place = tuple(p + size * d for p, d in zip(position, (x, y, z), strict=True))
            for data in ((0,) * len(own), default):
                compare_reason(loop, Command(place, NO_TURN, data, sample.axes))
                compare(loop, place, sample, data)
                compare_offset(loop, place, sample, data)


def compare_offset(loop: Pair, place: tuple[float, ...], sample: Sample, data: Bytes) -> None:
    """The same for a point off the flange."""
    if "cartesiantoaxes_offset" in loop.controller.methods:
        asked_for = place, sample.offset, data, sample.reference
        status, axes = asked(loop.robot.inverse_offset, *asked_for)
        expected = None if axes is None else axes + (0.0,) * (6 - len(axes))
        assert_same(loop.controller.inverse_offset(*asked_for), (status, expected), loop, *asked_for)


def at_reference(loop: Pair, sample: Sample) -> np.ndarray:
    """The rotation of the flange with the joints that turn it at the reference, where a point off it holds them."""
    closure = loop.machine.closure
    return closure.turns(closure.joints(np.array([sample.reference])))[0]


def sampled(mechanism: Mechanism, dimensions: Mapping[str, float], axes: tuple[float, ...]) -> tuple[Pair, Sample]:
    """A machine, and a sample at axis values."""
    loop = pair_of(loop_machine(mechanism, "edge", dimensions))
    return loop, *samples_at(loop.machine, [axes])


def at_edges(mechanism: Mechanism) -> list[tuple[Pair, Sample]]:
    """Machines at the end of what can be assembled, at the axis values of the end. Places that no leg can aim at are
    asked.
    """
    others = [OTHER_WAY_ROUND[mechanism.name]] if mechanism.name in OTHER_WAY_ROUND else []
    found = [sampled(mechanism, *edge) for edge in (*EDGES[mechanism.name], *others)]
    for dimensions, places in PLACES.get(mechanism.name, ()):
        loop, sample = sampled(mechanism, dimensions, (0.0,) * len(mechanism.joints))
        for place, data in product(places, product((0, 1, 2), repeat=loop.robot.BRANCHES)):
            turned = (*data, *(0,) * len(loop.robot.PERIOD_AXES))
            compare_reason(loop, Command(place, NO_TURN, turned, sample.axes))
            compare(loop, place, sample, turned)
            compare_offset(loop, tuple(np.add(place, at_reference(loop, sample) @ sample.offset)), sample, turned)
    return found
