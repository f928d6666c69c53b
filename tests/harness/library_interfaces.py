"""The interfaces of SoftMotion as types: a program can hold a reference to one, and call its documented methods."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

from . import ast
from .contract import INTERFACES, Signature
from .parse import parse

_QUERYABLE = ("MC_KIN_REF_SM3", "ISMKinematicAxisSettings")
"""The interfaces whose documentation says that they extend what a query needs, beside those that extend them."""

_WITHOUT_A_STAND_IN = "Coupled_Kin_Axis_Map"


def declared() -> Iterator[ast.Interface]:
    """Every interface, without its properties and without methods that have parameters of unknown types."""
    for name, interface in INTERFACES.items():
        known = {m: s for m, s in interface["methods"].items() if all(map(_is_known, s["params"]))}
        text = "\n".join((f"INTERFACE {name}", *(_method(m, s) for m, s in known.items()), "END_INTERFACE"))
        (found,) = parse(text, "TRAFO")
        assert isinstance(found, ast.Interface)
        first = ("__SYSTEM.IQueryInterface",) if name in _QUERYABLE else ()
        yield replace(found, extends=(*first, *interface["extends"]))


def _is_known(parameter: tuple[str, str, str | None]) -> bool:
    kind = parameter[2]
    return kind is not None and not kind.endswith(_WITHOUT_A_STAND_IN)


def _method(name: str, signature: Signature) -> str:
    returns = f" : {signature['returns']}" if signature["returns"] else ""
    lines = [f"METHOD {name}{returns}"]
    for scope, parameters in groupby(signature["params"], key=lambda p: p[0]):
        lines += [scope, *(f"  {parameter} : {kind};" for _, parameter, kind in parameters), "END_VAR"]
    return "\n".join((*lines, "END_METHOD"))
