"""The emitted units: their texts, and each compiled together with the objects that all share."""

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from derive.description.mechanism import Mechanism
from derive.emit.st.contract import load
from tests.harness.library import Library, compile_st

FOLDER = Path(__file__).resolve().parents[2] / "generated" / "st"
SHARED = "softkin"
"""The folder of the objects that all units share."""
NO_UNITS = (SHARED, "selftest")
"""The folders whose objects are no kinematics."""


@cache
def shared_texts() -> Mapping[str, str]:
    """The objects that all units share, by file."""
    return {path.name: path.read_text(encoding="utf-8") for path in sorted((FOLDER / SHARED).glob("*.st"))}


def file_of(mechanism: Mechanism) -> str:
    return f"{mechanism.block_name}.st"


def text_of(mechanism: Mechanism) -> str:
    return (FOLDER / mechanism.family / file_of(mechanism)).read_text(encoding="utf-8")


@cache
def public_methods(mechanism: Mechanism) -> tuple[str, ...]:
    """The methods of a mechanism's unit that are public, own ones and those that it inherits and its interfaces have.

    They are read from their first lines: nothing is parsed for a list.
    """
    text, base = text_of(mechanism), shared_texts()["Softkin_Kinematics.st"]
    own, inherited = (re.findall(r"^METHOD PUBLIC (\w+)", part, re.MULTILINE) for part in (text, base))
    wanted = wanted_methods(tuple(re.findall(r"^  TRAFO\.(\w+),?$", text, re.MULTILINE)))
    return (*own, *(name for name in inherited if name in wanted))


@cache
def wanted_methods(interfaces: tuple[str, ...]) -> frozenset[str]:
    """The methods of these interfaces of SoftMotion and of our own."""
    contract = load()
    return frozenset((*contract.own, *(m for i in contract.closure(interfaces) for m in i.methods)))


def compiled(mechanism: Mechanism, order: str = "rows", matrix_size: int = 72, max_config_data: int = 31) -> Library:
    """A mechanism's unit, ready to run; compiled once for all tests."""
    return compiled_text(file_of(mechanism), text_of(mechanism), order, matrix_size, max_config_data)


@cache
def compiled_text(
    file: str, text: str, order: str = "rows", matrix_size: int = 72, max_config_data: int = 31
) -> Library:
    return compile_st({**shared_texts(), file: text}, order, matrix_size, max_config_data)


@cache
def compiled_shared() -> Library:
    return compile_st(shared_texts())
