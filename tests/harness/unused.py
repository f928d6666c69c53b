"""What an object declares and does not use: variables that nothing reads, and outputs that nothing assigns.

Parameters of a public method are given by an interface: only its outputs are looked at. Those of a protected one are
given by the base block; and what a base declares is there for the blocks that extend it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass

from . import ast


@dataclass
class _Uses:
    """The names, in small letters, that statements read and write."""

    read: set[str] = field(default_factory=set)
    written: set[str] = field(default_factory=set)

    def statement(self, node: object) -> None:
        """Note the uses of a statement, or of a part of one."""
        if isinstance(node, ast.Assign):
            self._target(node.target)
            self.statement(node.value)
        elif isinstance(node, ast.Argument):
            self._target(node.value)
            if not node.is_output:  # an input reads, an in-out does both
                self.statement(node.value)
        elif isinstance(node, ast.Name):
            self.read.add(node.text.lower())
        elif isinstance(node, ast.Member):
            self.statement(node.object)
            if isinstance(node.object, ast.This | ast.Super) or _is_this(node.object):
                self.read.add(node.name.lower())
        elif isinstance(node, tuple):
            for one in node:
                self.statement(one)
        elif is_dataclass(node):
            for part in fields(node):
                self.statement(getattr(node, part.name))

    def _target(self, node: object) -> None:
        """Note that a place is written; what stands in its indices is read."""
        if isinstance(node, ast.Name):
            self.written.add(node.text.lower())
        elif isinstance(node, ast.Member):
            self._target(node.object)
        elif isinstance(node, ast.Index):
            self._target(node.object)
            self.statement(node.indices)
        elif isinstance(node, ast.Dereference):
            self.statement(node.pointer)

    @classmethod
    def of(cls, *parts: object) -> _Uses:
        found = cls()
        for part in parts:
            found.statement(part)
        return found


def _is_this(node: object) -> bool:
    return isinstance(node, ast.Dereference) and isinstance(node.pointer, ast.This | ast.Super)


def unused(declared: ast.Declaration) -> Iterator[str]:
    """What an object declares and does not use, as `Object.Method: name`."""
    if isinstance(declared, ast.Routine):
        yield from _of_routine(declared, declared.name)
    elif isinstance(declared, ast.Block):
        routines = [*declared.methods, *(p.getter for p in declared.properties)]
        inside = _Uses.of(declared.body, *(r.body for r in routines))
        has_supplied = any(r.access == "PROTECTED" for r in routines)
        is_base = has_supplied and declared.extends is None and not declared.implements
        if not is_base:
            yield from _left(declared.sections, inside, declared.name, ("VAR", "VAR_INPUT", "VAR_IN_OUT"))
        for routine in routines:
            if is_base and routine.access == "PROTECTED":
                continue
            yield from _of_routine(routine, f"{declared.name}.{routine.name}")


def _of_routine(routine: ast.Routine, place: str) -> Iterator[str]:
    scopes = ("VAR",) if routine.access in ("PUBLIC", "PROTECTED") else ("VAR", "VAR_INPUT", "VAR_IN_OUT")
    yield from _left(routine.sections, _Uses.of(routine.body), place, scopes)


def _left(sections: tuple[ast.Section, ...], uses: _Uses, place: str, scopes: tuple[str, ...]) -> Iterator[str]:
    read = uses.read | {n for s in sections for v in s.variables for n in _Uses.of(v.type, v.initial).read}
    for section in sections:
        known = uses.written if section.scope == "VAR_OUTPUT" else read
        if section.scope == "VAR_IN_OUT" and not section.constant:
            known = read | uses.written
        if section.scope == "VAR_OUTPUT" or section.scope in scopes:
            yield from (f"{place}: {v.name}" for v in section.variables if v.name.lower() not in known)
