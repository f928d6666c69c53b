"""The matrix of the controller's library may store its elements by rows or by columns: the answers are the same."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.comparisons import COMPARISONS, POSELESS
from tests.text.serial_pairs import serial_pairs_of

FEW = 10
MACHINES = ("nominal", "random 2", "limited")


@pytest.mark.long("Scara4")
def test_every_method_answers_the_same_by_columns(mechanism: Mechanism) -> None:
    """Every method gives the same answers for matrices that are stored by columns."""
    for by_rows, by_columns in zip(serial_pairs_of(mechanism), serial_pairs_of(mechanism, "columns"), strict=True):
        if by_rows.machine.label not in MACHINES:
            continue
        for sample in by_rows.regular[:FEW]:
            assert by_columns.controller.forward(sample.axes) == by_rows.controller.forward(sample.axes)
            for method in COMPARISONS.keys() - POSELESS:
                if method.lower() in by_columns.controller.methods:
                    COMPARISONS[method](by_columns, sample)


@pytest.mark.parametrize("order", ["rows", "columns"])
def test_the_order_is_found(mechanism: Mechanism, order: str) -> None:
    """Initialize finds the storage order of the library."""
    (found,) = {one.controller.block.matrixOrder for one in serial_pairs_of(mechanism, order)}
    assert found.lower() == order
