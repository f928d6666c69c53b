"""The number of operations of running Structured Text, as a cost."""

from collections.abc import Callable
from functools import cache
from typing import Any

from bench import counting
from derive.description.mechanism import Mechanism
from derive.report.cost import Cost
from tests.harness.library import Library
from tests.text.units import file_of, shared_texts, text_of


@cache
def counting_units(mechanism: Mechanism | None = None) -> Library:
    """The shared functions, with the unit of a mechanism if there is one, counting."""
    own = {} if mechanism is None else {file_of(mechanism): text_of(mechanism)}
    return counting.counting_library({**shared_texts(), **own})


def counted(call: Callable[..., Any], *arguments: Any, **named: Any) -> Cost:
    """What a call did."""
    _, found = counting.counted(call, *arguments, **named)
    return Cost(**found.of_kinds())
