"""The types that may be assigned without a conversion. The rules are stricter than in CODESYS: no digit is lost."""

import re

from . import st_types as types

_CONVERSION = re.compile(r"(\w+?)_TO_(\w+)\Z")


def fits(given: types.Type, wanted: types.Type) -> bool:
    """Whether a value of the given type may be assigned to the wanted type."""
    if given == wanted:
        return not isinstance(given, types.NoResult)
    if isinstance(wanted, types.Interface):
        return _refers(given, wanted)
    if isinstance(given, types.IntegerLiteral):
        if isinstance(wanted, types.Integer):
            return wanted.low <= given.value <= wanted.high
        return isinstance(wanted, types.Real)
    if isinstance(given, types.Integer) and isinstance(wanted, types.Integer):
        return given.widens_to(wanted)
    if isinstance(given, types.String) and isinstance(wanted, types.String):
        return given.length <= wanted.length
    if isinstance(given, types.Address) and isinstance(wanted, types.Pointer):
        return _memory_of_reals(given.of) and _memory_of_reals(wanted.target) or _of_one_struct(given.of, wanted.target)
    return False


def _refers(given: types.Type, wanted: types.Interface) -> bool:
    """Whether a value can be a reference to that interface."""
    if isinstance(given, types.Block):
        return wanted in given.implemented()
    return isinstance(given, types.Interface) and wanted in given.all()


def _memory_of_reals(of: types.Type) -> bool:
    return isinstance(of, types.Opaque) or (isinstance(of, types.Array) and of.element == types.LREAL)


def _of_one_struct(given: types.Type, wanted: types.Type) -> bool:
    """Whether both are arrays of the same structure: a library that is given such a pointer is told their number."""
    are_arrays = isinstance(given, types.Array) and isinstance(wanted, types.Array)
    return are_arrays and isinstance(given.element, types.Struct) and given.element == wanted.element


def common(left: types.Type, right: types.Type) -> types.Type | None:
    """The type in which two numbers meet, or None."""
    if isinstance(left, types.IntegerLiteral) and isinstance(right, types.IntegerLiteral):
        return types.INT if fits(left, types.INT) and fits(right, types.INT) else types.DINT
    if fits(left, right):
        return right
    return left if fits(right, left) else None


def conversion(name: str) -> tuple[types.Type, types.Type] | None:
    match = _CONVERSION.match(name.upper())
    if match is None:
        return None
    source, target = (types.ELEMENTARY.get(part) for part in match.groups())
    if source is None or target is None or source == target:
        return None
    return source, target
