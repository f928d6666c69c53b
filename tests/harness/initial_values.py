"""Python source for the initial value of a variable."""

from . import ast, constants, python_names
from . import st_types as types


def literal(value: constants.Value | None, of: types.Type) -> str:
    """A constant as Python source, in the shape its type has at run time."""
    if isinstance(value, types.EnumMember):
        return repr(value.name)
    if isinstance(of, types.Real) and isinstance(value, (int, float)):
        return repr(float(value))
    return repr(value)


def initial(variable: types.Variable, meaning: constants.Lookup) -> str:
    """Source that makes a fresh value: the initial value written, or the default of the type."""
    if isinstance(variable.initial, ast.ArrayValues) and isinstance(variable.type, types.Array):
        element = variable.type.element
        values = (literal(constants.evaluate(v, meaning), element) for v in variable.initial.values)
        return f"[{', '.join(values)}]"
    if variable.initial is not None:
        return literal(constants.evaluate(variable.initial, meaning), variable.type)
    return default(variable.type)


def default(of: types.Type) -> str:
    if isinstance(of, types.Boolean):
        return "False"
    if isinstance(of, types.Integer):
        return "0"
    if isinstance(of, types.Real):
        return "0.0"
    if isinstance(of, types.String):
        return "''"
    if isinstance(of, types.Enum):
        return repr(next(iter(of.members.values())))
    if isinstance(of, types.Array):
        if types.is_scalar(of.element):
            return f"[{default(of.element)}] * {of.count}"
        return f"[{default(of.element)} for _ in range({of.count})]"
    if isinstance(of, (types.Struct, types.Block, types.Opaque)):
        return f"{python_names.type_class(of)}()"
    return "None"


def is_inlined(variable: types.Variable) -> bool:
    """Scalar constants are written into the source instead of being kept."""
    return (
        variable.constant
        and not variable.is_reference
        and variable.initial is not None
        and variable.scope in ("VAR", "VAR_GLOBAL")
        and types.is_scalar(variable.type)
    )
