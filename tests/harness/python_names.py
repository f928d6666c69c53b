"""The names of declared objects and variables in the translated Python source."""

import keyword
from functools import cache

from . import st_types as types

# Attributes the harness itself puts on instances.
_TAKEN = {"call", "call_with_outputs", "get", "body", "routines", "cells", "origin"}


def attribute(name: str) -> str:
    """A variable of a block or a field of a structure keeps its declared spelling where Python lets it."""
    return name + "_" if keyword.iskeyword(name) or name in _TAKEN else name


def local(name: str) -> str:
    return "v_" + name.lower()


def function(routine: types.Routine) -> str:
    return "function_" + routine.name.lower()


@cache
def method(name: str) -> str:
    return "method_" + name.lower()


def getter(name: str) -> str:
    return "getter_" + name.lower()


def type_class(of: types.Struct | types.Block | types.Opaque) -> str:
    return "class_" + of.name.lower()


def global_variable(variable: types.Variable) -> str:
    return "global_" + variable.name.lower()
