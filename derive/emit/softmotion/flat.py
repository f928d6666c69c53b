"""Blocks that extend nothing: each contains the variables and methods of the base block.

Only the text of the objects is read. A block gets the variables of the base, and every method that it does not
override.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from derive.emit.plcopen.objects import Object

_SECTION = re.compile(r"^VAR\b.*?^END_VAR$", re.DOTALL | re.MULTILINE)
_INPUTS = re.compile(r"^VAR_INPUT$.*?^END_VAR$", re.DOTALL | re.MULTILINE)


def flattened(objects: Sequence[Object], base: Object) -> tuple[Object, ...]:
    """The objects, of which those that extend the base have its variables and methods instead.

    Raises `ValueError` for a block that calls what it overrides.
    """
    return tuple(_flat(one, base) if _head(one, base) in one.declaration else one for one in objects)


def _head(block: Object, base: Object) -> str:
    return f"\nFUNCTION_BLOCK {block.name} EXTENDS {base.name}"


def _flat(block: Object, base: Object) -> Object:
    for part in block.parts():
        if "SUPER" in part.implementation:
            raise ValueError(f"{block.name}.{part.name} calls what the base has, and a flat block has no base")
    alone = block.declaration.replace(_head(block, base), f"\nFUNCTION_BLOCK {block.name}")
    declaration = _with_variables(alone, "\n".join(_SECTION.findall(base.declaration)))
    return replace(block, declaration=declaration, members=(*block.members, *_inherited(block, base)))


def _with_variables(declaration: str, variables: str) -> str:
    """The declaration with these sections behind its inputs, which every block has."""
    inputs = _INPUTS.search(declaration)
    assert inputs is not None
    return f"{declaration[: inputs.end()]}\n{variables}{declaration[inputs.end() :]}"


def _inherited(block: Object, base: Object) -> Iterator[Object]:
    own = {member.name for member in block.members}
    return (member for member in base.members if member.name not in own)
