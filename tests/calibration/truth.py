"""A serial machine with deviations, multiplied out from its description: the truth of the tests.

It knows the description and what docs/CALIBRATION.md says a deviation is, and nothing of the package.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.geometry.frames import Factor, Motion
from derive.ir.constants import DEGREE
from tests.mechanisms import named

Array = NDArray[np.float64]
DEG = np.pi / 180.0


class Truth:
    """The chain of one machine."""

    def __init__(self, name: str, given: Mapping[str, float], deviations: Mapping[str, float]) -> None:
        """given: the parameters by name. deviations: in degrees and lengths."""
        self.mechanism: Mechanism = named(name)
        self.off, self.given = dict(deviations), given
        joints = self.mechanism.joints
        known = {p.symbol: given.get(p.name, p.default or 0.0) for p in self.mechanism.parameters} | {DEGREE: DEG}
        values = {j.symbol: sp.sympify(j.ratio * j.motor + j.coupling).subs(known) for j in joints}
        assert self.mechanism.chain is not None
        self.factors = self.mechanism.chain.factors
        amounts = [sp.sympify(f.amount) for f in self.factors]
        self.fixed = [float(a.subs(dict.fromkeys(values, 0)).subs(known)) for a in amounts]
        self.moved = sp.lambdify([j.motor for j in joints], [a.subs(values).subs(known) for a in amounts])
        self.names: list[str | None] = []
        for amount in amounts:
            own = [j.key for j in joints if j.symbol in amount.free_symbols]
            self.names.append(next((key for key in own if key not in self.names), None))

    def forward(self, axes: Sequence[float]) -> Array:
        """The matrix (4, 4) of the frame at axis values."""
        motors = []
        for j, axis in zip(self.mechanism.joints, axes, strict=True):
            moved = (axis - self.given.get(f"offset_{j.key}", 0.0)) * (1.0 + self._of(f"{j.key}_gain"))
            motors.append((DEG if j.in_degrees else 1.0) * (moved + self._of(f"{j.key}_offset")))
        found = self._end("base")
        for factor, name, fixed, amount in zip(self.factors, self.names, self.fixed, self.moved(*motors), strict=True):
            if name is not None:
                line = self._line(name, factor.axis)
                found = found @ line @ motion(factor, amount - fixed) @ np.linalg.inv(line)
            found = found @ motion(factor, fixed)
        return found @ self._end("tool")

    def _of(self, name: str) -> float:
        return self.off.get(name, 0.0)

    def _line(self, name: str, axis: int) -> Array:
        """Where the line of an axis is, seen from where it is drawn: in a frame with that axis as z."""
        own = np.eye(4)
        own[:3, :3] = np.roll(np.eye(3), axis + 1, axis=0)
        shift = np.eye(4)
        shift[:2, 3] = self._of(f"{name}_shift_x"), self._of(f"{name}_shift_y")
        return own @ shift @ about(0, self._of(f"{name}_tilt_x")) @ about(1, self._of(f"{name}_tilt_y")) @ own.T

    def _end(self, end: str) -> Array:
        found = np.eye(4)
        found[:3, 3] = [self._of(f"{end}_{k}") for k in "xyz"]
        return found @ about(2, self._of(f"{end}_c")) @ about(1, self._of(f"{end}_b")) @ about(0, self._of(f"{end}_a"))


def about(axis: int, degrees: float) -> Array:
    """A rotation about x, y or z, by Rodrigues' formula."""
    across = np.cross(np.eye(3)[axis], np.eye(3)).T
    found = np.eye(4)
    found[:3, :3] += np.sin(DEG * degrees) * across + (1.0 - np.cos(DEG * degrees)) * across @ across
    return found


def motion(factor: Factor, amount: float) -> Array:
    """The matrix of a factor of a chain."""
    if factor.motion is Motion.SHIFT:
        found = np.eye(4)
        found[factor.axis, 3] = amount
        return found
    return about(factor.axis, 180.0 * amount if factor.motion is Motion.FLIP else amount / DEG)
