"""Instances of blocks and functions as Python sees them, and where their faults come from."""

from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import Any

from . import python_names
from . import st_types as types
from .faults import Place, StFault
from .runtime import Cell, ElementCell, FieldCell

_CELLS = (Cell, FieldCell, ElementCell)
_MISSING = object()


@dataclass
class Origin:
    """Which line of the text a line of the translated source comes from."""

    filename: str
    places: list[Place | None]

    def place(self, trace: TracebackType | None) -> Place | None:
        found = None
        while trace is not None:
            if trace.tb_frame.f_code.co_filename == self.filename:
                found = self.places[trace.tb_lineno - 1]
            trace = trace.tb_next
        return found

    def run(self, function: Callable[..., Any], arguments: list[Any]) -> Any:
        """Call translated source; what Python raises for bad arithmetic becomes a StFault."""
        try:
            return function(*arguments)
        except StFault as fault:
            if fault.place is not None:
                raise
            raise StFault(fault.reason, self.place(fault.__traceback__)) from None
        except ZeroDivisionError as error:
            raise StFault("division by zero", self.place(error.__traceback__)) from None
        except ValueError as error:
            message = f"SQRT of a negative, or a function outside its domain ({error})"
            raise StFault(message, self.place(error.__traceback__)) from None
        except OverflowError as error:
            raise StFault(f"real result is not finite ({error})", self.place(error.__traceback__)) from None
        except RecursionError as error:
            raise StFault("recursion without end", self.place(error.__traceback__)) from None


@dataclass
class Entry:
    """How Python calls a routine: its function, its parameters and what each starts with."""

    function: Callable[..., Any]
    routine: types.Routine
    defaults: list[Callable[[], Any]]

    def __post_init__(self) -> None:
        self._handed = [
            (p.name, p.scope, types.is_scalar(p.type), p.initial is not None and p.scope == "VAR_INPUT", make)
            for p, make in zip(self.routine.parameters, self.defaults, strict=True)
        ]

    def arguments(self, given: dict[str, Any]) -> tuple[list[Any], dict[str, Any]]:
        """Positional arguments, and the holders of outputs and scalar in-outs by name."""
        arguments, holders = [], {}
        for name, scope, scalar, may_be_left_out, make in self._handed:
            if scope == "VAR_OUTPUT":
                value = holders[name] = Cell(make()) if scalar else make()
            else:
                value = given.pop(name, _MISSING)
                if value is _MISSING:
                    if not may_be_left_out:
                        raise TypeError(f"{self.routine.name} needs {name}")
                    value = make()
                elif scalar and scope == "VAR_IN_OUT":
                    value = holders[name] = value if isinstance(value, _CELLS) else Cell(value)
            arguments.append(value)
        if given:
            raise TypeError(f"{self.routine.name} has no parameter {', '.join(given)}")
        return arguments, holders


def _opened(holders: dict[str, Any]) -> dict[str, Any]:
    return {name: h.value if isinstance(h, _CELLS) else h for name, h in holders.items()}


class Instance:
    """Base of all translated blocks. Inputs, outputs and variables are attributes."""

    __slots__ = ()
    origin: Origin
    routines: dict[str, Entry]
    cells: frozenset[str] = frozenset()  # the scalar in-outs
    implemented: frozenset[str] = frozenset()  # the interfaces, in small letters

    def call(self, name: str, /, **given: Any) -> Any:
        """Call a method; in-outs are changed in place, outputs are dropped."""
        arguments, _ = self.routines[name.lower()].arguments(given)
        return self.origin.run(getattr(self, python_names.method(name)), arguments)

    def call_with_outputs(self, name: str, /, **given: Any) -> tuple[Any, dict[str, Any]]:
        """Call a method; the dict holds its outputs and scalar in-outs."""
        entry = self.routines[name.lower()]
        arguments, holders = entry.arguments(given)
        # Not entry.function: a block that extends another may override it.
        function = getattr(self, python_names.method(name))
        return self.origin.run(function, arguments), _opened(holders)

    def get(self, name: str) -> Any:
        return self.origin.run(getattr(self, python_names.getter(name)), [])

    def __call__(self, /, **inputs: Any) -> None:
        """Set inputs and in-outs, and run the body once."""
        for name, value in inputs.items():
            wrapped = name in self.cells and not isinstance(value, _CELLS)
            setattr(self, python_names.attribute(name), Cell(value) if wrapped else value)
        self.origin.run(self.body, [])

    def body(self) -> None:
        """Overridden by every translated block."""


@dataclass
class Function:
    """A FUNCTION, called with its inputs and in-outs in order of declaration or by name."""

    entry: Entry
    origin: Origin

    def __call__(self, /, *positional: Any, **given: Any) -> Any:
        return self.with_outputs(*positional, **given)[0]

    def with_outputs(self, /, *positional: Any, **given: Any) -> tuple[Any, dict[str, Any]]:
        names = [p.name for p in self.entry.routine.parameters if p.scope != "VAR_OUTPUT"]
        if len(positional) > len(names):
            raise TypeError(f"{self.entry.routine.name} takes {len(names)} arguments")
        arguments, holders = self.entry.arguments(dict(zip(names, positional, strict=False)) | given)
        return self.origin.run(self.entry.function, arguments), _opened(holders)
