"""A call of any method of a block, with arguments that fit a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from tests.harness.instance import Entry
from tests.text import values
from tests.text.controller import OK, Controller
from tests.text.coupling.blocks import OrientationPair
from tests.text.pairs import Pair
from tests.text.samples import Rows, Sample
from tests.text.settings import settings
from tests.text.units import public_methods


@dataclass(frozen=True)
class Call:
    """A method with its arguments."""

    controller: Controller
    method: str
    arguments: Mapping[str, Any]
    written: tuple[str, ...]
    """The arguments that the method writes; all others are its inputs."""
    has_status: bool

    @property
    def inputs(self) -> tuple[str, ...]:
        """The arguments that the method reads only."""
        return tuple(name for name in self.arguments if name not in self.written)

    def again(self) -> Call:
        """The same with arguments of its own."""
        return replace(self, arguments={name: values.copied(value) for name, value in self.arguments.items()})

    def run(self) -> tuple[Any, dict[str, Any]]:
        """What the method returns, and what it has written."""
        result = self.controller.block.call(self.method, **self.arguments)
        return result, self.state()

    def state(self) -> dict[str, Any]:
        """What the arguments hold that the method writes."""
        return {name: values.plain(self.arguments[name]) for name in self.written}

    def is_refused(self, result: Any) -> bool:
        """Whether a result says that nothing was done."""
        return self.has_status and result != OK


def methods_of(controller: Controller) -> list[str]:
    """The public methods of a block, but for Initialize."""
    return [name for name in public_methods(controller.mechanism) if name != "Initialize"]


def call_of(pair: Pair, controller: Controller, method: str, sample: Sample) -> Call:
    """A method with arguments that fit a pose; what it writes holds what means nothing."""
    entry: Entry = controller.block.routines[method.lower()]
    given = _fitting(pair, sample)
    arguments, written = {}, []
    for parameter, make in zip(entry.routine.parameters, entry.defaults, strict=True):
        if parameter.scope == "VAR_OUTPUT":
            continue
        if parameter.is_reference and not parameter.constant:
            arguments[parameter.name] = values.filled(make())
            written.append(parameter.name)
        else:
            arguments[parameter.name] = given[parameter.name]
    returns = entry.routine.declaration.returns
    has_status = returns is not None and returns.text.endswith("SMC_ERROR")
    return Call(controller, method, arguments, tuple(written), has_status)


def _fitting(pair: Pair, sample: Sample) -> dict[str, Any]:
    """An argument for every input in the contract, by its name."""
    library = pair.library
    position, rotation, data = pair.controller.forward(sample.axes)[1]
    size = len(pair.robot.CONFIGURATION)
    axes, vector = values.axes(library, sample.axes), values.vector(library, position)
    configuration = values.configuration(library, data[:size])
    return {
        "a": axes,
        "aRef": axes,
        "f": values.frame(library, position, rotation),
        "mR_Flange": values.matrix(library, rotation),
        "v_MCS": vector,
        "vOffset_TCP": values.vector(library, (0.0, 0.0, 0.0)),
        "cd": configuration,
        "cd1": configuration,
        "cd2": configuration,
        "cdSrc": configuration,
        "aTwist": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        "aTwistRate": [6.0, 5.0, 4.0, 3.0, 2.0, 1.0],
        "aVelocities": [2.0, 3.0, 4.0, 5.0, 6.0, 7.0],
        "as": settings(library, None),
        **(of_an_orientation(pair, rotation) if isinstance(pair, OrientationPair) else {}),
        "udiAxis": 0,
    }


def of_an_orientation(pair: OrientationPair, rotation: Rows) -> dict[str, Any]:
    space = pair.controller.space(pair.image)
    matrix = values.matrix(pair.library, rotation)
    return {"mR": matrix, "mR_flange": matrix, "oriInfo": space, "oriInfoBase": space}
