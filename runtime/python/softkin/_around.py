"""A machine around another one: what both have in common."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from softkin._configuration import Criterion
from softkin._core import Image, Mechanism
from softkin._ends import Ends
from softkin._types import Configuration, ConfigurationLike, Diagnosis, Numbers, Reals, Status, Turns

_COMMON = (
    "AXES", "CONFIGURATION", "DEFAULT_CONFIGURATION", "MARGINS", "JACOBIAN_ROWS", "READS_ROTATION", "FREEDOM",
    "BRANCHES", "PERIOD_AXES", "HELD", "SURPLUS", "DISTANCE_AXES", "checks_limits",
)  # fmt: skip


class Around(Mechanism):
    """A machine with the axes, the configuration, the limits and the choices of another one."""

    __slots__ = ()

    PARAMETERS = ()
    ROLE = "complete"

    _within: Mechanism
    """The other machine."""

    def _surround(self, within: Mechanism, own: Mapping[str, Any]) -> None:
        """Take over what both have. own: further attributes, and those that differ."""
        for name, value in {**{name: getattr(within, name) for name in _COMMON}, **own, "_within": within}.items():
            object.__setattr__(self, name, value)

    @property
    def limits(self) -> dict[str, Ends | None]:
        """The limits of the machine within."""
        return self._within.limits

    def misses(self, axes: Numbers) -> dict[str, float]:
        """The misses of the machine within."""
        return self._within.misses(axes)

    @property
    def _criteria(self) -> tuple[Criterion, ...]:
        return self._within._criteria

    @property
    def _branch_bytes(self) -> list[int]:
        return self._within._branch_bytes

    @property
    def _period_bytes(self) -> list[int]:
        return self._within._period_bytes

    def _read(self, configuration: ConfigurationLike | None) -> tuple[Configuration, Turns]:
        return self._within._read(configuration)

    def _joined(self, branches: Configuration, periods: Configuration) -> Configuration:
        return self._within._joined(branches, periods)

    def _turn_sizes(self) -> Reals:
        return self._within._turn_sizes()

    def _periods(self, axes: Reals) -> Configuration:
        return self._within._periods(axes)

    def _written(self, margins: Reals, axes: Reals) -> Configuration:
        return self._within._written(margins, axes)

    def _parameter_units(self) -> dict[str, str]:
        return self._within._parameter_units()

    def _ranges(self) -> tuple[tuple[float, float], ...]:
        return self._within._ranges()

    def _quantities(self, axes: Reals) -> Reals | Status:
        return self._within._quantities(axes)

    def _warning_distance(self) -> float:
        return self._within._warning_distance()

    def _limits(self, axes: Reals) -> Diagnosis | None:
        return self._within._beyond_limits(axes)

    def _follows(self) -> str:
        return self._within._follows()

    def _image(self) -> Image | Status:
        return self._within._image()
