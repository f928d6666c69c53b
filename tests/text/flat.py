"""Blocks of the flat profile: the text of a unit, with what its base has in it, and without that base."""

import re
from collections.abc import Mapping
from functools import cache

from derive.description.mechanism import Mechanism
from derive.emit.plcopen.objects import Object, as_text, objects_of
from derive.emit.softmotion.library import flattened
from tests.harness.library import Library, compile_st
from tests.text.units import file_of, shared_texts, text_of

BASE = "Softkin_Kinematics"


def objects_in(text: str) -> tuple[Object, ...]:
    """The objects of a file, without its preamble and its rulers."""
    lines = text.split("\n")
    start = next(at for at, line in enumerate(lines) if line.startswith("// ===="))
    bare = (re.sub(r"  // =+$", "", line) for line in lines[start:] if not line.startswith("// ===="))
    return objects_of("\n".join(bare))


@cache
def base() -> Object:
    """The base block."""
    (found,) = objects_in(shared_texts()[f"{BASE}.st"])
    return found


@cache
def flat_text(mechanism: Mechanism) -> str:
    """The unit as the flat profile writes it, without its preamble."""
    return flat_of(text_of(mechanism))


def flat_of(text: str) -> str:
    """The text of a unit, flat."""
    return as_text(flattened(objects_in(text), base()))


def flat_texts(mechanism: Mechanism) -> Mapping[str, str]:
    """The unit and the objects that all units share."""
    shared = {name: text for name, text in shared_texts().items() if name != f"{BASE}.st"}
    return {**shared, file_of(mechanism): flat_text(mechanism)}


@cache
def flat_library(mechanism: Mechanism) -> Library:
    """The unit, ready to run."""
    return compile_st(flat_texts(mechanism))
