"""A controller that calls a block: plain values in, a status and plain values out."""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

from softkin import KinematicsError

from derive.description.mechanism import Mechanism, Parameter, Role
from derive.emit.softmotion.inputs import wanted_name
from derive.kinematics.parameters import machine_parameters
from tests.harness.library import Library
from tests.text import values
from tests.text.settings import Range, settings
from tests.text.units import public_methods
from tests.text.values import Numbers

OK = "SMC_NO_ERROR"
NOT_INITIALIZED = "SMC_TRAFO_NOT_INITIALIZED"
BAD_INPUT = "SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"
UNREACHABLE = "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"
IMPOSSIBLE = "SMC_TRAFO_INVALID_CONSTELLATION"

Answer = tuple[str, Any]
"""A status, and what was written; None where the method refused."""


class Controller:
    """A block, called as a controller calls it.

    A variable that a method writes holds an arbitrary value before the call, and must hold the same after a refusal.
    names: of inputs that are not called as wanted, by parameters.
    """

    def __init__(self, library: Library, mechanism: Mechanism, names: Mapping[str, str] = MappingProxyType({})) -> None:
        self.names = names
        self.library = library
        self.mechanism = mechanism
        self.block = library.new(mechanism.block_name)

    @cached_property
    def methods(self) -> frozenset[str]:
        """The public methods that its interfaces have, in small letters; others that it inherits answer nothing."""
        return frozenset(name.lower() for name in public_methods(self.mechanism))

    def set_inputs(self, given: Mapping[str, float]) -> None:
        for parameter, name in self._inputs:
            if parameter.name in given:
                setattr(self.block, name, input_value(parameter, given[parameter.name]))

    @cached_property
    def _inputs(self) -> tuple[tuple[Parameter, str], ...]:
        """The parameters of the machine, each with the name of its input."""
        parameters = machine_parameters(self.mechanism)
        return tuple((parameter, self.names.get(parameter.name, wanted_name(parameter))) for parameter in parameters)

    def initialise(self, given: Mapping[str, float]) -> str:
        self.set_inputs(given)
        status: str = self.block.call("Initialize")
        return status

    def axis_settings(self, axis: int, limits: Range) -> str:
        """AxisSettings: the limits of the drive of an axis."""
        status: str = self.block.call("AxisSettings", **{"as": settings(self.library, limits), "udiAxis": axis})
        return status

    def axis_properties(self, axis: int) -> tuple[str, bool, float, float]:
        """GetAxisProperties: its type, and the limits."""
        found = self._new(values.PROPERTIES_TYPE)
        self.block.call("GetAxisProperties", props=found, udiAxis=axis)
        return found.eType, found.limits.xUnlimited, found.limits.dLower, found.limits.dUpper

    def state(self) -> dict[str, object]:
        """All instance variables, without the inputs; those in the structure of an axis by their names and that of the
        axis.
        """
        blocks = [self.library.objects[self.mechanism.block_name]]
        if blocks[0].extends:
            blocks.append(self.library.objects[blocks[0].extends])
        names = [v.name for block in blocks for s in block.sections if s.scope == "VAR" for v in s.variables]
        state = {name: getattr(self.block, name) for name in names}
        for joint, axis in zip(self.mechanism.joints, state.pop("axes"), strict=False):
            state |= {f"{field}{joint.name}": getattr(axis, field) for field in axis._fields}
        return state

    def forward(self, axes: Numbers) -> Answer:
        """AxesToCartesian: position, rotation, all configuration bytes."""
        frame, data = self._new(values.FRAME_TYPE), self._new(values.BYTES_TYPE)
        status = self._call("AxesToCartesian", {"f": frame, "cd": data}, a=values.axes(self.library, axes))
        return self._answer(status, lambda: (values.vector_of(frame.vT), self._rows(frame.mR), tuple(data.abyData)))

    def inverse(
        self, position: Numbers, rows: Iterable[Numbers], configuration: Iterable[int], reference: Numbers
    ) -> Answer:
        """CartesianToAxes: all entries of the axis values."""
        found = self._new(values.AXES_TYPE)
        status = self._call(
            "CartesianToAxes",
            {"a": found},
            f=values.frame(self.library, position, rows),
            aRef=values.axes(self.library, reference),
            cd=values.configuration(self.library, configuration),
        )
        unshared = self.block.unshared
        assert not any((*unshared.known, *unshared.kept)), "a call has left something for other tasks"
        return self._answer(status, lambda: values.axes_of(found))

    def diagnose(
        self, position: Numbers, rows: Iterable[Numbers], configuration: Iterable[int], reference: Numbers
    ) -> tuple[str, float]:
        """Diagnose: the reason, and how much is missing."""
        return self.explain(position, rows, configuration, reference)[:2]

    def explain(
        self, position: Numbers, rows: Iterable[Numbers], configuration: Iterable[int], reference: Numbers
    ) -> tuple[str, float, int, float]:
        """Diagnose: the reason, how much is missing, the number of a turn that is inside, and the projection."""
        reason, outputs = self.block.call_with_outputs(
            "Diagnose",
            f=values.frame(self.library, position, rows),
            aRef=values.axes(self.library, reference),
            cd=values.configuration(self.library, configuration),
        )
        return reason, outputs["dMissing"], outputs["iTurn"], outputs["dProjection"]

    def inverse_offset(
        self, point: Numbers, offset: Numbers, configuration: Iterable[int], reference: Numbers
    ) -> Answer:
        """CartesianToAxes_Offset: all entries of the axis values."""
        found = self._new(values.AXES_TYPE)
        status = self._call(
            "CartesianToAxes_Offset",
            {"a": found},
            v_MCS=values.vector(self.library, point),
            vOffset_TCP=values.vector(self.library, offset),
            aRef=values.axes(self.library, reference),
            cd=values.configuration(self.library, configuration),
        )
        return self._answer(status, lambda: values.axes_of(found))

    def configuration_offset(self, axes: Numbers, offset: Numbers) -> tuple[int, ...]:
        """AxesToConfiguration_Offset: all bytes."""
        found = self._new(values.BYTES_TYPE)
        arguments = {"a": values.axes(self.library, axes), "vOffset_TCP": values.vector(self.library, offset)}
        self.block.call("AxesToConfiguration_Offset", cd=found, **arguments)
        return tuple(found.abyData)

    def orientation(self, axes: Numbers) -> Answer:
        """AxesToOrientation: the rotation."""
        found = self._new(values.MATRIX_TYPE)
        status = self._call("AxesToOrientation", {"m": found}, a=values.axes(self.library, axes))
        return self._answer(status, lambda: self._rows(found))

    def jacobian(self, axes: Numbers, start: tuple[Numbers, Iterable[Numbers]] | None = None) -> Answer:
        """Jacobian: all six rows of six. start: position and rotation, for JacobianFrom."""
        found = [values.MEANINGLESS] * 36
        more = {} if start is None else {"f": values.frame(self.library, *start)}
        method = "JacobianFrom" if more else "Jacobian"
        status = self._call(method, {"J": found}, a=values.axes(self.library, axes), **more)
        return self._answer(status, lambda: tuple(tuple(found[6 * i : 6 * i + 6]) for i in range(6)))

    def is_singular(self, axes: Numbers) -> bool:
        """IsSingularity."""
        found: bool = self.block.call("IsSingularity", a=values.axes(self.library, axes))
        return found

    def image(self, method: str, **arguments: Any) -> Answer:
        """A method that writes an OrientationSpace: freedom, rotation, vRot, vU. GetOrientationImage has no status."""
        found = self._new(values.IMAGE_TYPE)
        status = self._call(method, {"oriInfo": found}, **arguments) or OK
        sides = values.vector_of(found.vRot), values.vector_of(found.vU)
        return self._answer(status, lambda: (found.dof, self._rows(found.mOriZero), *sides))

    def image_with_orientation(self, rows: Iterable[Numbers]) -> Answer:
        """GetFlangeOrientationImageWithOri; reference and configuration are never read."""
        axes, data = values.axes(self.library, ()), values.configuration(self.library, ())
        return self.image(
            "GetFlangeOrientationImageWithOri", mR_Flange=values.matrix(self.library, rows), aRef=axes, cd=data
        )

    def configuration(self, data: Iterable[int]) -> Any:
        """Configuration bytes as an argument."""
        return values.configuration(self.library, data)

    def _new(self, type_name: str) -> Any:
        return values.meaningless(self.library, type_name)

    def _call(self, method: str, written: Mapping[str, Any], **arguments: Any) -> str:
        before = [value[:] if isinstance(value, list) else value._copy() for value in written.values()]
        status: str = self.block.call(method, **written, **arguments)
        if status not in (OK, None):
            assert list(written.values()) == before, f"{method} refused, and wrote"
        return status

    def _rows(self, matrix: Any) -> tuple[tuple[float, ...], ...]:
        return self.library.get_rotation(matrix)

    @staticmethod
    def _answer(status: str, read: Any) -> Answer:
        return status, read() if status == OK else None


def input_value(parameter: Parameter, value: float) -> bool | int | float:
    if parameter.role is Role.FLAG:
        return bool(value)
    return int(value) if parameter.role is Role.SIGN else float(value)


TOLERANCE = 1e-12
"""Relative to the larger of 1 and the value: both languages evaluate the same formulas."""


def asked(call: Callable[..., Any], *arguments: Any) -> Answer:
    """The answer of a call in Python, as a status and a value."""
    try:
        return OK, call(*arguments)
    except KinematicsError as refusal:
        return refusal.status.softmotion, None


def is_close(found: Any, expected: Any) -> bool:
    """Whether numbers agree to rounding, and everything else exactly."""
    if found == expected:
        return True
    if isinstance(expected, float):
        return abs(found - expected) <= TOLERANCE * max(1.0, abs(expected))
    if isinstance(expected, tuple | list):
        return len(found) == len(expected) and all(map(is_close, found, expected))
    return False


def assert_same(found: Any, expected: Any, *context: object) -> None:
    """Fail where two answers differ, and say what was asked."""
    assert is_close(found, expected), "\n".join(map(str, (f"{found} is not {expected}", *context)))
