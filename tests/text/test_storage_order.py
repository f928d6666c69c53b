"""The matrix of the controller's library may store its elements by rows or by columns: the answers are the same."""

from dataclasses import replace

import pytest

from tests.text.comparisons import POSELESS
from tests.text.controller import OK, Controller
from tests.text.pairs import Pair, comparisons_of
from tests.text.units import compiled

FEW = 4
MACHINES = ("nominal", "random 2", "other", "limited")


def by_columns(pair: Pair) -> Controller:
    """The block with a library that stores its matrices the other way, which Initialize finds."""
    controller = Controller(compiled(pair.mechanism, "columns"), pair.mechanism)
    assert controller.initialise(pair.robot.parameters) == OK
    assert controller.block.matrixOrder.lower() == "columns"
    return controller


@pytest.mark.broad
@pytest.mark.long("Hexapod", "Scara4")
def test_every_method_answers_the_same_by_columns(pairs: tuple[Pair, ...]) -> None:
    """Every method gives the same answers for matrices that are stored by columns."""
    compared = [pair for pair in pairs if pair.machine.label in MACHINES]
    assert len(compared) == 3
    for pair in compared:
        controller = by_columns(pair)
        other = replace(pair, controller=controller)
        for sample in pair.regular[:FEW]:
            assert controller.forward(sample.axes) == pair.controller.forward(sample.axes)
            for method, compare in comparisons_of(pair.mechanism).items():
                if method not in POSELESS and method.lower() in controller.methods:
                    compare(other, sample)
