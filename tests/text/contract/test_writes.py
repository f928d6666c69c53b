"""Which methods write the variables of an instance: several tasks may call all others at once."""

import dataclasses
from collections.abc import Iterator

import pytest

from tests.harness import ast
from tests.text.contract.blocks import CONTRACT, UNITS, blocks, library

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("file", UNITS)
def test_only_initialize_writes_the_instance(file: str) -> None:
    """What Initialize calls writes the variables of a block and what the base keeps for it, and nothing else does."""
    block, base = blocks()[file], library().objects["Softkin_Kinematics"]
    members = {v.name.lower() for owner in (block, base) for s in owner.sections for v in s.variables}
    for method in block.methods:
        written = members & set(_written(method.body))
        if method.name != "ReadInputs":
            assert not written, f"{file}: {method.name}"
        else:
            assert not [a for a in _members_of_axes(method.body) if a.startswith(("drive", "lowest", "highest"))], file
        called = {call.lower() for call in _called(method.body)}
        assert "readinputs" not in called, file
        assert method.name == "ReadInputs" or not called & {name.lower() for name in CONTRACT.offered}, file


def test_the_base_alone_reads_inputs_and_writes_limits() -> None:
    """Initialize alone calls ReadInputs, and no other method what that calls; AxisSettings writes by Softkin_SetAxis,
    whose last statements write.
    """
    base, setter = library().objects["Softkin_Kinematics"], library().objects["Softkin_SetAxis"]
    members = {v.name.lower() for s in base.sections for v in s.variables}
    for method in base.methods:
        calls = set(_called(method.body))
        assert ("ReadInputs" in calls) == (method.name == "Initialize")
        assert ("Softkin_SetAxis" in calls) == (method.name in ("Initialize", "AxisSettings"))
        assert not calls & set(CONTRACT.offered) or method.name in CONTRACT.offered, method.name
        written = members & set(_written(method.body))
        assert written <= {"Check": {"refusal"}, "ReadLimits": {"axes"}}.get(method.name, set()) or (
            method.name == "Initialize"
        ), method.name
    firsts = [at for at, statement in enumerate(setter.body) if "axis" in _written((statement,))]
    assert firsts and firsts == list(range(firsts[0], len(setter.body) - 1))


def _written(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The variables that statements assign, however deep."""
    for statement in body:
        if isinstance(statement, ast.Assign):
            target = statement.target
            while isinstance(target, ast.Member | ast.Index):
                target = target.object
            if isinstance(target, ast.Name):
                yield target.text.lower()
        elif isinstance(statement, ast.If | ast.Case):
            for branch in statement.branches:
                yield from _written(branch.body)
            yield from _written(statement.otherwise)
        elif isinstance(statement, ast.For | ast.While):
            yield from _written(statement.body)


def _called(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The functions and methods that statements call by their plain names, however deep."""
    for found in _nodes(body):
        if isinstance(found, ast.Call) and isinstance(found.function, ast.Name):
            yield found.function.text


def _members_of_axes(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The members of the structures of axes that statements assign."""
    for found in _nodes(body):
        if isinstance(found, ast.Assign) and isinstance(found.target, ast.Member):
            yield found.target.name


def _nodes(found: object) -> Iterator[object]:
    """A node of the syntax tree and all inside it; of a tuple, those of its entries."""
    if isinstance(found, tuple):
        for one in found:
            yield from _nodes(one)
    elif dataclasses.is_dataclass(found):
        yield found
        for field in dataclasses.fields(found):
            yield from _nodes(getattr(found, field.name))
