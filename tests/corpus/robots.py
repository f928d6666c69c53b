"""Robots of the package, made from what is recorded of them: names and parameters of their parts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import softkin

from tests.corpus.dimensions import ALSO, COUPLED, DIMENSIONS

LENGTHS = ("length", "signed length", "distance")
WITHOUT_LENGTHS = 500.0
"""The reach assumed of a machine that has no lengths."""

Recipe = list[dict[str, Any]]
"""The parts of a robot, one or two: {"name": …, "parameters": {…}}."""


@dataclass(frozen=True)
class Robot:
    """A robot with how it is made, and the size of it."""

    recipe: Recipe
    made: softkin.Mechanism
    reach: float

    @property
    def is_angle(self) -> np.ndarray:
        return np.array([axis.unit == "deg" for axis in self.made.AXES], dtype=bool)

    def changed(self, **parameters: float) -> Robot:
        """The same robot with other parameters of its last part that knows them."""
        return robot([p | {"parameters": p["parameters"] | _known(p["name"], parameters)} for p in self.recipe])


def robot(recipe: Recipe) -> Robot:
    """The robot of a recipe; raises `KinematicsError` where its parameters are not allowed."""
    parts = [softkin.catalogue()[part["name"]](**part["parameters"]) for part in recipe]
    made = parts[0] if len(parts) == 1 else softkin.Coupled(*parts)
    return Robot(recipe, made, sum(map(_reach, parts)) or WITHOUT_LENGTHS)


def recipes(name: str) -> Iterator[Recipe]:
    """The machines of a mechanism: as it is drawn, special ones, an unequal one with offsets, in metres."""
    if name in COUPLED:
        yield [{"name": part, "parameters": dict(given)} for part, given in COUPLED[name]]
        return
    nominal = dict(DIMENSIONS[name])
    for changes in ({}, *ALSO.get(name, ())):
        yield [{"name": name, "parameters": nominal | changes}]
    yield [{"name": name, "parameters": _unequal(name, nominal)}]
    yield [{"name": name, "parameters": {k: v * _metres(name, k) for k, v in nominal.items()}}]


def parameter(name: str, key: str) -> softkin.Parameter:
    """What the package says of a parameter."""
    return next(p for p in softkin.catalogue()[name].PARAMETERS if p.name == key)


def _known(name: str, parameters: Mapping[str, float]) -> dict[str, float]:
    own = {p.name for p in softkin.catalogue()[name].PARAMETERS}
    return {key: value for key, value in parameters.items() if key in own}


def _reach(part: softkin.Mechanism) -> float:
    chosen = [p.name for p in part.PARAMETERS if p.kind in LENGTHS]
    return sum(abs(part.parameters[n]) for n in chosen if not n.startswith(("offset_", "lower_", "upper_", "home_")))


def _metres(name: str, key: str) -> float:
    return 0.001 if parameter(name, key).unit.startswith("u") else 1.0


def _unequal(name: str, nominal: dict[str, float]) -> dict[str, float]:
    """No two lengths alike, every axis with an offset, the assembly mode the other one, where parameters allow it."""
    rng = np.random.default_rng(31)
    for _ in range(100):
        given = {
            k: v * float(rng.uniform(0.85, 1.2)) if parameter(name, k).kind in LENGTHS else v
            for k, v in nominal.items()
        }
        for p in softkin.catalogue()[name].PARAMETERS:
            if p.name in ("tcp_above", "tcp_below"):
                given[p.name] = 1.0
            if p.name.startswith("offset_") and p.name.removeprefix("offset_") in _axes(name):
                given[p.name] = float(rng.uniform(-30.0, 30.0))
        try:
            robot([{"name": name, "parameters": given}])
        except softkin.KinematicsError:
            continue
        return given
    raise ValueError(f"{name}: no parameters near the nominal ones are allowed")


def _axes(name: str) -> set[str]:
    return {axis.name.lower() for axis in softkin.catalogue()[name].AXES}
