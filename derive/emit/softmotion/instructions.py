"""The instructions of a call in C, which `make costs` counted for processors of controllers: `templates/costs.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from derive.emit.language import TEMPLATES
from derive.report.cost import Costs

CALLS = ("AxesToCartesian", "CartesianToAxes", "Jacobian")
FILE = TEMPLATES / "costs.toml"
_CHANGED = 0.05
"""A machine whose operations have changed by a larger share has to be measured again."""
Calls = tuple[tuple[int, int], ...]
"""The instructions of each of `CALLS`: the median of regular poses, and the most."""


@dataclass(frozen=True)
class Core:
    """A processor, and the speed that microseconds assume."""

    name: str
    megahertz: int
    per_cycle: float

    @property
    def speed(self) -> str:
        """The assumption in words."""
        return f"{self.megahertz} MHz and {self.per_cycle:.1f} instructions a cycle"

    def microseconds(self, instructions: float) -> str:
        """How long they take, in two digits."""
        return _two_digits(instructions / self.megahertz / self.per_cycle)


@dataclass(frozen=True)
class Counted:
    """What was counted of a machine: instructions on each core, and its operations at that time."""

    operations: tuple[int, int]
    cores: Mapping[str, Calls]

    def is_of(self, forward: int, inverse: int) -> bool:
        """Whether a machine with so many operations is still the one that was measured."""
        pairs = zip((forward, inverse), self.operations, strict=True)
        return all(abs(now - then) <= _CHANGED * then for now, then in pairs)


@cache
def cores() -> tuple[Core, ...]:
    """The processors; headers state the first."""
    return tuple(Core(**core) for core in _data()["cores"])


@cache
def counted() -> Mapping[str, Counted]:
    """Every machine of the catalogue by the name of its block."""
    return {
        name: Counted(tuple(machine["operations"]), {c.name: tuple(map(tuple, machine[c.name])) for c in cores()})
        for name, machine in _data()["machines"].items()
    }


def sentences(block: str, costs: Costs) -> str:
    """What a header says of a machine; empty if none, or another one, was measured under the name of its block."""
    known, core = counted().get(block), cores()[0]
    if known is None or not known.is_of(sum(costs.forward.counts), sum(costs.inverse.counts)):
        return ""
    medians = [usual for usual, _ in known.cores[core.name]]
    forward, inverse, jacobian = map(grouped, medians)
    *first, last = map(core.microseconds, medians)
    return (
        f"The same formulas in C take on a {core.name} about {forward} instructions for AxesToCartesian, {inverse} for "
        f"CartesianToAxes on one branch, {jacobian} for Jacobian: {', '.join(first)} and {last} microseconds at an "
        f"assumed {core.speed}. Counted in an emulator (gcc -O2, median of regular poses): a floor, no promise for the "
        "compiler of a controller. Other processors: docs/SPEED.md."
    )


def grouped(instructions: float) -> str:
    """A number in two digits, by thousands."""
    return f"{int(float(_two_digits(instructions))):,}"


def table(blocks: Collection[str] = ()) -> Iterator[str]:
    """The table of a guide: instructions on the first core, and microseconds of the inverse on all. blocks: those that
    it shows, if not all.
    """
    heads = ["block", *(f"`{call}`" for call in CALLS), "at most", *(core.name for core in cores())]
    yield f"| {' | '.join(heads)} |"
    yield "|---" * len(heads) + "|"
    for block in blocks or counted():
        known = counted()[block].cores
        calls, inverse = known[cores()[0].name], CALLS.index("CartesianToAxes")
        cells = [*(grouped(usual) for usual, _ in calls), grouped(calls[inverse][1])]
        cells += [core.microseconds(known[core.name][inverse][0]) for core in cores()]
        yield f"| `{block}` | {' | '.join(cells)} |"


def _two_digits(number: float) -> str:
    """Rounded to two digits, without an exponent."""
    return f"{float(f'{number:.1e}'):g}"


def _data() -> Any:
    """The file as it is."""
    return tomllib.loads(FILE.read_text(encoding="utf-8"))
