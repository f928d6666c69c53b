"""The check that a block has every method and property of the library interfaces that it implements."""

import json
import re
from pathlib import Path
from typing import TypedDict

from . import ast
from . import st_types as types
from .faults import StError

_FILE = Path(__file__).with_name("softmotion_interfaces.json")
_PREFIX = re.compile(r"\b[A-Z_]\w*\.(?=[A-Z_])")


class Signature(TypedDict):
    returns: str | None
    params: list[tuple[str, str, str | None]]  # scope, name, type; a type that is not documented is null


class Interface(TypedDict):
    extends: list[str]
    properties: dict[str, str]
    methods: dict[str, Signature]


INTERFACES: dict[str, Interface] = json.loads(_FILE.read_text(encoding="utf-8"))
_BY_KEY = {name.lower(): name for name in INTERFACES}


def plain(type_text: str | None) -> str | None:
    """A type as text without the differences that do not matter: case, blanks, and the namespace."""
    if type_text is None:
        return None
    return re.sub(r"\s+", " ", _PREFIX.sub("", type_text.upper())).replace(", ", ",").strip()


def check_contract(block: types.Block) -> None:
    own = {interface.name: interface for interface in block.interfaces if interface.name.lower() not in _BY_KEY}
    for written in block.declaration.implements:
        *space, name = written.split(".")
        if name in own and space in ([], ["ROB"]):
            _check_own(block, own[name])
            continue
        if name.lower() not in _BY_KEY or [part.upper() for part in space] not in ([], ["TRAFO"]):
            raise StError(block.declaration.at, f"unknown interface {written}")
        _check_interface(block, _BY_KEY[name.lower()])


def _check_own(block: types.Block, interface: types.Interface) -> None:
    """Every method of an interface that a text declares stands in the block or its base, with the identical header."""
    for base in interface.bases:
        _check_own(block, base)
    for key, wanted in interface.methods.items():
        found = block.method(key)
        if found is None:
            raise StError(block.declaration.at, f"{block.name} lacks the method {wanted.name} of {interface.name}")
        if found.declaration.access != "PUBLIC":
            raise StError(found.declaration.at, f"{interface.name}.{wanted.name} must be public")
        if header(found.declaration) != header(wanted.declaration):
            raise StError(found.declaration.at, f"the header of {wanted.name} is not that of {interface.name}")


def header(method: ast.Routine) -> tuple[object, ...]:
    """What is the same in every block: the name, what it returns, and its parameters in their order."""
    returns = None if method.returns is None else method.returns.text
    return method.name, returns, *((p.scope, p.name, p.type) for p in method.params)


def _check_interface(block: types.Block, name: str) -> None:
    interface = INTERFACES[name]
    for base in interface["extends"]:
        _check_interface(block, base)
    for prop, type_text in interface["properties"].items():
        own = block.property(prop.lower())
        if own is None:
            raise StError(block.declaration.at, f"{block.name} lacks the property {prop} of {name}")
        if own.getter.declaration.returns is None or plain(own.getter.declaration.returns.text) != plain(type_text):
            raise StError(own.getter.declaration.at, f"the property {prop} of {name} is a {type_text}")
    for method, signature in interface["methods"].items():
        found = block.method(method.lower())
        if found is None:
            raise StError(block.declaration.at, f"{block.name} lacks the method {method} of {name}")
        _check_method(found.declaration, signature, name)


def _check_method(method: ast.Routine, signature: Signature, interface: str) -> None:
    where = f"{interface}.{method.name}"
    if method.access not in ("", "PUBLIC"):
        raise StError(method.at, f"{where} must be public")
    returns = None if method.returns is None else method.returns.text
    if plain(returns) != plain(signature["returns"]):
        raise StError(method.at, f"{where} returns {signature['returns']}, not {returns}")
    own = [(p.scope, p.name.lower(), plain(p.type)) for p in method.params]
    wanted = [(scope, name.lower(), plain(text)) for scope, name, text in signature["params"]]
    for given, expected in zip(own, wanted, strict=False):
        undocumented = expected[2] is None and given[:2] == expected[:2]
        if given != expected and not undocumented:
            raise StError(method.at, f"parameter of {where}: {given} where {expected} is wanted")
    if len(own) != len(wanted):
        raise StError(method.at, f"{where} has {len(wanted)} parameters, not {len(own)}")
