"""Types and meanings of expressions."""

from . import ast, constants
from . import st_types as types
from .check_builtins import is_builtin, result_type
from .check_calls import bind
from .conversions import common, fits
from .facts import BoundCall, Facts, Scope
from .faults import StError
from .lexical import QUERY
from .writes import check_write, is_place, root

_ARITHMETIC = ("+", "-", "*", "/", "MOD")
_LOGIC = ("AND", "OR", "XOR")
_ORDER = ("<", "<=", ">", ">=")
_EQUALITY = ("=", "<>")


class Expressions:
    """Checks the expressions of one body and notes what it learns in the facts."""

    def __init__(self, scope: Scope, facts: Facts) -> None:
        self.scope = scope
        self.facts = facts

    def type_of(self, node: ast.Expression) -> types.Type:
        found = self.facts.type_of.get(node)
        if found is None:
            found = self.facts.type_of[node] = self._find_type(node)
        return found

    def must_fit(self, node: ast.Expression, wanted: types.Type) -> None:
        given = self.type_of(node)
        if not fits(given, wanted):
            raise StError(node.at, f"{given.name} does not fit {wanted.name}")

    def _find_type(self, node: ast.Expression) -> types.Type:
        match node:
            case ast.Literal():
                return _literal(node)
            case ast.Name():
                return self._value_of(node, self.scope.find(node.text), node.text)
            case ast.Member():
                return self._member(node)
            case ast.Index():
                return self._index(node)
            case ast.Dereference():
                pointer = self.type_of(node.pointer)
                if not isinstance(pointer, types.Pointer):
                    raise StError(node.at, f"{pointer.name} is no pointer")
                return pointer.target
            case ast.This():
                return self._own_block(node)
            case ast.AddressOf():
                return self._address(node)
            case ast.Unary():
                return self._unary(node)
            case ast.Binary():
                return self._binary(node)
            case ast.Call():
                return self._call(node)
        raise StError(node.at, f"{type(node).__name__} is not allowed here")

    # ---- names -------------------------------------------------------------------------
    def _value_of(self, node: ast.Expression, meaning: types.Meaning | None, text: str) -> types.Type:
        if meaning is None:
            raise StError(node.at, f"undeclared name {text}")
        self.facts.meanings[node] = meaning
        if isinstance(meaning, (types.Variable, types.Property)):
            return meaning.type
        if isinstance(meaning, types.EnumMember):
            return meaning.enum
        raise StError(node.at, f"{text} is not a value")

    def _own_block(self, node: ast.Expression) -> types.Block:
        if self.scope.block is None:
            raise StError(node.at, "THIS and SUPER exist only inside a function block")
        return self.scope.block

    def _member(self, node: ast.Member) -> types.Type:
        static = self.scope.meaning(node)
        if static is not None:
            return self._value_of(node, static, node.name)
        owner, key = self.type_of(node.object), node.name.lower()
        if isinstance(owner, types.Opaque):
            raise StError(node.at, f"the fields of {owner.name} are not known")
        found: types.Meaning | None = None
        if isinstance(owner, types.Struct):
            found = owner.fields.get(key)
        elif isinstance(owner, types.Block):
            found = owner.variable(key) or owner.property(key)
            inside = isinstance(node.object, ast.This)
            if isinstance(found, types.Variable) and found.scope == "VAR" and not inside:
                raise StError(node.at, f"{node.name} is a local variable of {owner.name}")
        if found is None:
            raise StError(node.at, f"{owner.name} has no field {node.name}")
        return self._value_of(node, found, node.name)

    def _index(self, node: ast.Index) -> types.Type:
        owner = self.type_of(node.object)
        if not isinstance(owner, types.Array):
            raise StError(node.at, f"{owner.name} has no index")
        if len(owner.bounds) != len(node.indices):
            raise StError(node.at, f"{owner.name} needs {len(owner.bounds)} indices")
        for index, (low, high) in zip(node.indices, owner.bounds, strict=True):
            given = self.type_of(index)
            if not isinstance(given, (types.Integer, types.IntegerLiteral)) or given == types.BYTE:
                raise StError(index.at, f"{given.name} cannot be an index")
            value = constants.evaluate(index, self.scope.meaning)
            if isinstance(value, int) and not low <= value <= high:
                raise StError(index.at, f"index {value} is outside {owner.name}")
        return owner.element

    def _address(self, node: ast.AddressOf) -> types.Type:
        operand = self.type_of(node.operand)
        if not is_place(node.operand, self.facts):
            raise StError(node.at, "ADR needs a variable")
        # A pointer can write, so the operand must be a place this body may write.
        check_write(node.operand, self.scope, self.facts)
        return types.Address(operand)

    # ---- operators ---------------------------------------------------------------------
    def _unary(self, node: ast.Unary) -> types.Type:
        operand = self.type_of(node.operand)
        if node.operator == "NOT" and (operand == types.BOOL or operand == types.BYTE):
            return operand
        if node.operator == "-":
            if isinstance(operand, types.IntegerLiteral):
                return types.IntegerLiteral(-operand.value)
            if operand == types.LREAL or (isinstance(operand, types.Integer) and operand.low < 0):
                return operand
        raise StError(node.at, f"{node.operator} does not take {operand.name}")

    def _binary(self, node: ast.Binary) -> types.Type:
        left, right = self.type_of(node.left), self.type_of(node.right)
        found: types.Type | None = None
        if node.operator in _ARITHMETIC:
            found = _arithmetic(node, left, right)
        elif node.operator in _LOGIC:
            met = common(left, right)
            found = met if met in (types.BOOL, types.BYTE) else None
        elif node.operator in _ORDER + _EQUALITY:
            found = types.BOOL if _comparable(node.operator, left, right) else None
        if found is None:
            raise StError(node.at, f"{left.name} {node.operator} {right.name} is not allowed")
        return found

    # ---- calls -------------------------------------------------------------------------
    def _call(self, node: ast.Call) -> types.Type:
        callee = self._callee(node.function)
        if isinstance(callee, types.Builtin):
            self.facts.calls[node] = BoundCall(callee, [])
            if callee.name.upper() == "SIZEOF":
                return self._size(node)
            if callee.name.upper() == QUERY:
                return self._query(node)
            return result_type(node, callee.name, self.type_of)
        if isinstance(callee, types.Routine):
            bind(self, node, callee, callee.name, callee.parameters)
            return callee.returns
        check_write(node.function, self.scope, self.facts)  # a call changes the instance
        bind(self, node, callee, callee.name, block_parameters(callee))
        return types.NOTHING

    def _callee(self, node: ast.Expression) -> types.Routine | types.Builtin | types.Block:
        found = self.scope.meaning(node)
        if isinstance(node, ast.Name) and self.scope.result is not None and found is self.scope.result:
            raise StError(node.at, f"{node.text} calls itself")
        if isinstance(node, ast.Name) and found is None and is_builtin(node.text):
            return types.Builtin(node.text)
        if found is None and isinstance(node, ast.Member):
            found = self._method(node)
        if isinstance(found, types.Routine):
            self.facts.meanings[node] = found
            return found
        if found is None and not isinstance(node, ast.Member):
            raise StError(node.at, f"undeclared function {getattr(node, 'text', '')}")
        instance = self.type_of(node)
        if isinstance(instance, types.Block):
            return instance
        raise StError(node.at, f"{instance.name} cannot be called")

    def _method(self, node: ast.Member) -> types.Routine | None:
        if isinstance(node.object, ast.Super):
            owner: types.Type | None = self._own_block(node).base
        else:
            owner = self.type_of(node.object)
        if isinstance(owner, types.Interface):
            if (offered := owner.method(node.name.lower())) is None:
                raise StError(node.at, f"{owner.name} has no method {node.name}")
            return offered
        if isinstance(owner, types.Block):
            found = owner.method(node.name.lower())
            own = isinstance(node.object, (ast.This, ast.Super))
            if found is not None and found.declaration.access == "PRIVATE" and not own:
                raise StError(node.at, f"the method {node.name} is private")
            if found is None and owner.variable(node.name.lower()) is None:
                raise StError(node.at, f"{owner.name} has no method {node.name}")
            return found
        if isinstance(node.object, ast.Super):
            raise StError(node.at, "SUPER needs a base block")
        return None

    def _query(self, node: ast.Call) -> types.Type:
        if len(node.arguments) != 2 or any(argument.name is not None for argument in node.arguments):
            raise StError(node.at, f"{QUERY} takes two arguments")
        source, target = (argument.value for argument in node.arguments)
        given, wanted = self.type_of(source), self.type_of(target)
        if not isinstance(given, (types.Interface, types.Block)):
            raise StError(source.at, f"{given.name} is no reference to an interface and no block")
        if not isinstance(wanted, types.Interface):
            raise StError(target.at, f"{wanted.name} is no reference to an interface")
        for interface in (given, wanted):
            if isinstance(interface, types.Interface) and not interface.is_queryable:
                raise StError(node.at, f"{interface.name} does not extend __SYSTEM.IQueryInterface")
        check_write(target, self.scope, self.facts)
        if (variable := root(target, self.facts)) is not None:
            self.facts.boxed.add(variable)
        return types.BOOL

    def _size(self, node: ast.Call) -> types.Type:
        if len(node.arguments) != 1 or node.arguments[0].name is not None:
            raise StError(node.at, "SIZEOF takes one argument")
        operand = node.arguments[0].value
        found = self.scope.meaning(operand)
        if not isinstance(found, types.Type):
            elementary = types.ELEMENTARY.get(operand.text.upper()) if isinstance(operand, ast.Name) else None
            found = elementary or self.type_of(operand)
        return types.IntegerLiteral(types.size_of(found))


def block_parameters(block: types.Block) -> tuple[types.Variable, ...]:
    inherited = block_parameters(block.base) if block.base else ()
    own = (v for v in block.variables.values() if v.scope in ("VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT"))
    return (*inherited, *own)


def _literal(node: ast.Literal) -> types.Type:
    if isinstance(node.value, bool):
        return types.BOOL
    if isinstance(node.value, int):
        return types.IntegerLiteral(node.value)
    return types.LREAL if isinstance(node.value, float) else types.String(len(node.value))


def _arithmetic(node: ast.Binary, left: types.Type, right: types.Type) -> types.Type | None:
    if isinstance(left, types.IntegerLiteral) and isinstance(right, types.IntegerLiteral):
        value = constants.evaluate(node, lambda _: None)
        return types.DINT if not isinstance(value, int) else types.IntegerLiteral(value)
    met = common(left, right)
    if met == types.LREAL:
        return None if node.operator == "MOD" else met
    return met if isinstance(met, types.Integer) and not met.is_bits else None


def _comparable(operator: str, left: types.Type, right: types.Type) -> bool:
    if isinstance(left, (types.Pointer, types.Interface)) and right == types.IntegerLiteral(0):
        return operator in _EQUALITY
    met = common(left, right)
    if isinstance(met, (types.Real, types.Integer)):
        return True
    return isinstance(met, (types.Boolean, types.Enum, types.String)) and operator in _EQUALITY
