"""Orientation kinematics as function blocks and in Python, with the calls of a coupling."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import softkin

from derive.description.mechanism import Mechanism
from tests.catalogue.coupling.parts import ORIENTATIONS, Part, orientation_parts, part
from tests.catalogue.machines import Machine
from tests.text import values
from tests.text.both import Both
from tests.text.controller import OK, Answer, Controller
from tests.text.samples import NO_TURN, Rows, Sample, samples_at
from tests.text.units import compiled
from tests.text.values import Numbers

Z = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Image:
    freedom: str
    zero: Rows = NO_TURN
    base_axis: Numbers = Z
    flange_axis: Numbers = Z

    def in_python(self) -> softkin.OrientationImage:
        return softkin.OrientationImage(self.freedom, self.zero, tuple(self.base_axis), tuple(self.flange_axis))


class OrientationController(Controller):
    """An orientation kinematics, called as a coupling calls it."""

    def space(self, image: Image) -> Any:
        """An OrientationSpace as an argument."""
        made = values.new(self.library, values.IMAGE_TYPE)
        made.dof = image.freedom
        self.library.set_rotation(made.mOriZero, image.zero)
        made.vRot.dX, made.vRot.dY, made.vRot.dZ = image.base_axis
        made.vU.dX, made.vU.dY, made.vU.dZ = image.flange_axis
        return made

    def is_compatible(self, image: Image) -> bool:
        """IsCompatibleWithPosKin."""
        found: bool = self.block.call("IsCompatibleWithPosKin", oriInfo=self.space(image))
        return found

    def end_point(self, rows: Rows, image: Image, configuration: Iterable[int], reference: Numbers) -> Answer:
        """GetPositionFromOrientation3."""
        axes, data = values.axes(self.library, reference), values.configuration(self.library, configuration)
        return self._vector("GetPositionFromOrientation3", rows, aRef=axes, cd=data, oriInfo=self.space(image))

    def end_point_2(self, rows: Rows, image: Image) -> Answer:
        """GetPositionFromOrientation2."""
        return self._vector("GetPositionFromOrientation2", rows, oriInfo=self.space(image))

    def end_point_1(self, rows: Rows) -> Answer:
        """GetPositionFromOrientation."""
        return self._vector("GetPositionFromOrientation", rows)

    def total(self, base: Image) -> Answer:
        """GetOrientationImageTotal."""
        return self.image("GetOrientationImageTotal", oriInfoBase=self.space(base))

    def with_orientation(self, rows: Rows, base: Image) -> tuple[str, Any, tuple[Any, ...]]:
        """GetOrientationImageWithOri: status, image, and the frame it is in with whether it is active."""
        found = self._new(values.IMAGE_TYPE)
        status, outputs = self.block.call_with_outputs(
            "GetOrientationImageWithOri",
            oriInfo=found,
            csOriKin="MCS",
            bActive=False,
            mR_flange=values.matrix(self.library, rows),
            aRef=values.axes(self.library, ()),
            cd=values.configuration(self.library, ()),
            oriInfoBase=self.space(base),
        )
        image = (found.dof, self._rows(found.mOriZero), values.vector_of(found.vRot), values.vector_of(found.vU))
        return status, image, (outputs["csOriKin"], outputs["bActive"])

    def _vector(self, method: str, rows: Rows, **arguments: Any) -> Answer:
        found = self._new(values.VECTOR_TYPE)
        status = self._call(method, {"v": found}, mR=values.matrix(self.library, rows), **arguments)
        return self._answer(status, lambda: values.vector_of(found))


@dataclass(frozen=True)
class OrientationPair(Both):
    """An orientation kinematics as a function block and in Python, and samples of it."""

    machine: Machine
    controller: OrientationController
    part: Part
    regular: tuple[Sample, ...]
    image: Image = Image("one")
    """The flange that carries it, where a method is told one."""

    def __str__(self) -> str:
        return f"{self.robot!r}"


@cache
def orientation_pairs_of(mechanism: Mechanism, order: str = "rows") -> tuple[OrientationPair, ...]:
    """Every set of shifts, and one machine with limits."""
    limits = {f"{end}_{j.key}": size for j in mechanism.joints for end, size in (("lower", -100.0), ("upper", 100.0))}
    shifts = {p.name: p.nominal for p in mechanism.parameters}
    limited = part(mechanism, **shifts, **limits)
    return tuple(_pair(one, order) for one in (*orientation_parts(mechanism), limited))


def _pair(one: Part, order: str) -> OrientationPair:
    controller = OrientationController(compiled(one.mechanism, order), one.mechanism)
    assert controller.initialise(one.robot.parameters) == OK
    rng = np.random.default_rng(29)
    unlimited = part(one.mechanism, **{p.name: one.robot.parameters[p.name] for p in one.mechanism.parameters})
    machine = Machine("", one.mechanism, {}, one.robot, one.closure, 300.0)
    return OrientationPair(machine, controller, one, samples_at(machine, unlimited.draw(8, rng)))


__all__ = ["ORIENTATIONS", "OrientationController", "Image", "OrientationPair", "orientation_pairs_of"]
