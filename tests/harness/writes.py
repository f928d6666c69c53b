"""Rules of assignment: for constants, for inputs, and that only Initialize and AxisSettings change an instance.

The last rule is for blocks with a method that others may call: several tasks do. A block whose methods are private or
protected runs by its body alone, in one task, and its methods are parts of that body.
"""

from . import ast
from . import st_types as types
from .facts import Facts, Scope
from .faults import StError

WRITERS = ("Initialize", "AxisSettings")
"""The methods that may change an instance: all others are called by several tasks at once."""
REFERENCE, ITS_WRITERS = "lastAxes", ("Direct", "Inverse")
"""What a user transformation of PacDrive keeps: the robot calls it in one task."""
EMPTY = "unshared"
"""What calls hand on that keep nothing in it: the tests look whether it is still empty (`tests/text/controller.py`)."""
READERS = ("ReadInputs", "Check", "ReadLimits")
"""What Initialize alone calls, and what that calls: see `tests/text/contract/test_interfaces.py`."""


def root(node: ast.Expression, facts: Facts) -> types.Variable | None:
    """The variable in which the memory of an expression lies; None behind a pointer."""
    if isinstance(node, ast.Index):
        return root(node.object, facts)
    meaning = facts.meanings.get(node)
    if isinstance(node, ast.Member) and isinstance(meaning, types.Variable) and meaning.scope == "FIELD":
        return root(node.object, facts)
    if isinstance(node, ast.Member) and not isinstance(node.object, (ast.This, ast.Super)):
        outer = root(node.object, facts)
        return outer if outer is not None else _variable(meaning)
    return _variable(meaning)


def _variable(meaning: types.Meaning | None) -> types.Variable | None:
    return meaning if isinstance(meaning, types.Variable) else None


def is_place(node: ast.Expression, facts: Facts) -> bool:
    """Whether the expression names memory, and not a mere value."""
    if isinstance(node, (ast.Index, ast.Dereference)):
        return True
    return isinstance(node, (ast.Name, ast.Member)) and isinstance(facts.meanings.get(node), types.Variable)


def check_write(node: ast.Expression, scope: Scope, facts: Facts) -> None:
    """Raise StError when the body may not write to this place. The node must be typed already."""
    if not is_place(node, facts):
        raise StError(node.at, "this is not a variable that can be written")
    _check_foreign(node, facts)
    variable = root(node, facts)
    if variable is None:
        return
    if variable.constant:
        what = "VAR_IN_OUT CONSTANT" if variable.is_reference else "constant"
        raise StError(node.at, f"write to the {what} {variable.name}")
    if variable.scope == "RESULT":
        scope.result_assigned = True
    if variable.scope == "VAR_GLOBAL" and scope.is_method:
        raise StError(node.at, f"a method writes the global variable {variable.name}")
    if variable.member_of is not None:
        _check_member(variable, node, scope)


def _check_foreign(node: ast.Expression, facts: Facts) -> None:
    """Refuse an assignment to a variable of another instance that is no input, or no part of an input."""
    while isinstance(node, (ast.Member, ast.Index)):
        meaning = facts.meanings.get(node)
        if isinstance(meaning, types.Variable) and meaning.member_of is not None and isinstance(node, ast.Member):
            foreign = not isinstance(node.object, (ast.This, ast.Super))
            if foreign and meaning.scope != "VAR_INPUT":
                raise StError(node.at, f"{meaning.name} is no input of {meaning.member_of.name}")
        node = node.object


def _check_member(variable: types.Variable, node: ast.Expression, scope: Scope) -> None:
    if scope.is_method and variable.scope == "VAR_INPUT":
        raise StError(node.at, f"a method writes the input {variable.name}")
    if variable.name == EMPTY or (scope.block is not None and runs_by_its_body(scope.block)):
        return
    writers = ITS_WRITERS if variable.name == REFERENCE else (*WRITERS, *READERS)
    if scope.is_method and scope.owner.lower() not in map(str.lower, writers):
        raise StError(node.at, f"only {' and '.join(WRITERS)} may write the instance variable {variable.name}")
    block = scope.block
    if not scope.is_method and block is not None and block.methods and block.declaration.kind != "PROGRAM":
        raise StError(node.at, f"the body of a block with methods writes {variable.name}")


def runs_by_its_body(block: types.Block) -> bool:
    """Whether nothing but its body can be called from outside: it and its bases have no public method or property."""
    routines = [routine.declaration.access for routine in block.methods.values()]
    is_closed = not block.properties and set(routines) <= {"PRIVATE", "PROTECTED"}
    return is_closed and not block.declaration.implements and (block.base is None or runs_by_its_body(block.base))
