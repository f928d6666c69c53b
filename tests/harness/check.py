"""Check declarations: names, initial values, bodies. Everything the translator relies on."""

from collections.abc import Sequence

from . import ast, constants
from . import st_types as types
from .check_expressions import Expressions
from .contract import INTERFACES, check_contract
from .conversions import common, fits
from .facts import Facts, Scope
from .faults import StError
from .names import check_name
from .universe import Universe
from .writes import check_write


class Statements:
    def __init__(self, scope: Scope, facts: Facts) -> None:
        self.scope = scope
        self.facts = facts
        self.expressions = Expressions(scope, facts)
        self.loops = 0

    def check(self, body: tuple[ast.Statement, ...]) -> None:
        for statement in body:
            self._statement(statement)

    def _statement(self, node: ast.Statement) -> None:
        match node:
            case ast.Assign():
                self._assign(node)
            case ast.CallStatement():
                self.expressions.type_of(node.call)
            case ast.If():
                for branch in node.branches:
                    self._condition(branch.condition)
                    self.check(branch.body)
                self.check(node.otherwise)
            case ast.Case():
                self._case(node)
            case ast.For():
                self._for(node)
            case ast.Exit():
                if not self.loops:
                    raise StError(node.at, "EXIT outside a loop")

    def _condition(self, node: ast.Expression) -> None:
        given = self.expressions.type_of(node)
        if given != types.BOOL:
            raise StError(node.at, f"the condition is {given.name}, not BOOL")

    def _assign(self, node: ast.Assign) -> None:
        target = self.expressions.type_of(node.target)
        self.expressions.must_fit(node.value, target)
        check_write(node.target, self.scope, self.facts)
        if isinstance(target, types.Block):
            raise StError(node.at, "an instance of a block cannot be assigned")

    def _for(self, node: ast.For) -> None:
        control = self.expressions.type_of(node.control)
        if not isinstance(control, types.Integer) or control.is_bits or not isinstance(node.control, ast.Name):
            raise StError(node.at, "the control variable of FOR must be an integer variable")
        check_write(node.control, self.scope, self.facts)
        for part in (node.start, node.stop, node.step):
            if part is not None:
                self.expressions.must_fit(part, control)
        if node.step is not None and constants.evaluate(node.step, self.scope.meaning) in (None, 0):
            raise StError(node.at, "BY needs a constant that is not 0")
        self.loops += 1
        self.check(node.body)
        self.loops -= 1

    def _case(self, node: ast.Case) -> None:
        subject = self.expressions.type_of(node.subject)
        if not isinstance(subject, (types.Integer, types.Enum)):
            raise StError(node.at, f"CASE does not take {subject.name}")
        seen: set[constants.Value] = set()
        for branch in node.branches:
            for label in branch.labels:
                self._label(label, subject, seen)
            self.check(branch.body)
        self.check(node.otherwise)

    def _label(self, label: ast.Expression, subject: types.Type, seen: set[constants.Value]) -> None:
        if common(self.expressions.type_of(label), subject) != subject:
            raise StError(label.at, f"the label does not fit {subject.name}")
        value = constants.evaluate(label, self.scope.meaning)
        if value is None:
            raise StError(label.at, "a label must be a constant")
        if value in seen:
            raise StError(label.at, "the label occurs twice")
        seen.add(value)


NATIVE = "{attribute 'native'}"


def check(universe: Universe, declarations: Sequence[ast.Declaration]) -> Facts:
    facts = Facts()
    for declaration in declarations:
        check_name(declaration.name, declaration.at)
        if isinstance(declaration, ast.Block):
            _check_block(universe, declaration, facts)
        elif isinstance(declaration, ast.Routine):
            check_routine(universe, declaration, None, facts)
        elif isinstance(declaration, ast.Interface):
            _check_interface(universe, declaration)
        elif isinstance(declaration, ast.Enumeration):
            for name, _value in declaration.members:
                check_name(name, declaration.at)
        else:
            parts = declaration.fields if isinstance(declaration, ast.Structure) else declaration.variables
            for part in parts:
                check_name(part.name, part.at)
                _check_initial(universe, part, Scope(universe, None, declaration.name, {}, None, False), facts)
    return facts


def _check_block(universe: Universe, declaration: ast.Block, facts: Facts) -> None:
    block = universe.find(declaration.name)
    assert isinstance(block, types.Block)
    _check_members(block)
    scope = Scope(universe, block, declaration.name, {}, None, False)
    for section in declaration.sections:
        for part in section.variables:
            _check_initial(universe, part, scope, facts)
    for method in declaration.methods:
        check_routine(universe, method, block, facts)
    for prop in declaration.properties:
        check_routine(universe, prop.getter, block, facts)
    Statements(scope, facts).check(declaration.body)
    check_contract(block)


def _check_interface(universe: Universe, declaration: ast.Interface) -> None:
    """An interface extends the one that a query needs, and its methods have distinct names."""
    found = universe.find(declaration.name)
    assert isinstance(found, types.Interface)
    if not found.is_queryable and declaration.name not in INTERFACES:
        raise StError(declaration.at, f"the INTERFACE {declaration.name} extends nothing that a query finds")
    seen = {declaration.name.lower()}
    for method in declaration.methods:
        check_name(method.name, method.at)
        if method.name.lower() in seen:
            raise StError(method.at, f"duplicate name {method.name}")
        seen.add(method.name.lower())
        for part in (v for section in method.sections for v in section.variables):
            check_name(part.name, part.at)


def _check_members(block: types.Block) -> None:
    """Names inside a block are unique ignoring case; only methods and properties may be overridden."""
    seen: set[str] = set()
    written = block.declaration
    variables = [part for section in written.sections for part in section.variables]
    members: list[ast.VariableDeclaration | ast.Routine | ast.PropertyDeclaration]
    members = [*variables, *written.methods, *written.properties]
    for member in members:
        check_name(member.name, member.at)
        key = member.name.lower()
        inherited = block.base is not None and (
            block.base.variable(key) is not None
            or (isinstance(member, ast.VariableDeclaration) and _has_member(block.base, key))
        )
        if key in seen or inherited or key == written.name.lower():
            raise StError(member.at, f"duplicate name {member.name}")
        seen.add(key)


def _has_member(block: types.Block, key: str) -> bool:
    return bool(block.variable(key) or block.method(key) or block.property(key))


def _check_initial(universe: Universe, part: ast.VariableDeclaration, scope: Scope, facts: Facts) -> None:
    declared = universe.type_of(part.type)
    if part.initial is None:
        return
    values: tuple[ast.Expression, ...] = (part.initial,)
    if isinstance(part.initial, ast.ArrayValues):
        if not isinstance(declared, types.Array) or declared.count != len(part.initial.values):
            raise StError(part.at, f"the initial values of {part.name} do not fill {declared.name}")
        declared, values = declared.element, part.initial.values
    statements = Statements(scope, facts)
    for value in values:
        given = statements.expressions.type_of(value)
        if not fits(given, declared):
            raise StError(part.at, f"the initial value of {part.name} is {given.name}, not {declared.name}")
        if constants.evaluate(value, scope.meaning) is None:
            raise StError(part.at, f"the initial value of {part.name} is not constant")


def scope_of(universe: Universe, declaration: ast.Routine, block: types.Block | None) -> Scope:
    """The scope of a function, method or getter, with all its variables declared."""
    routine = _routine(universe, declaration, block)
    found: dict[str, types.Variable] = {p.name.lower(): p for p in routine.parameters}
    seen: set[str] = set()
    for section in declaration.sections:
        for part in section.variables:
            _check_local(part, seen, block, declaration.name)
            if section.scope == "VAR":
                found[part.name.lower()] = universe.variable(part, section, None)
    result = None
    if routine.returns != types.NOTHING:
        result = types.Variable(declaration.name, routine.returns, "RESULT")
        found[declaration.name.lower()] = result
    return Scope(universe, block, declaration.name, found, result, block is not None)


def _routine(universe: Universe, declaration: ast.Routine, block: types.Block | None) -> types.Routine:
    found = universe.find(declaration.name) if block is None else block.methods.get(declaration.name.lower())
    if declaration.kind == "GET" and block is not None:
        found = block.properties[declaration.name.lower()].getter
    assert isinstance(found, types.Routine)
    return found


def _check_local(part: ast.VariableDeclaration, seen: set[str], block: types.Block | None, owner: str) -> None:
    check_name(part.name, part.at)
    key = part.name.lower()
    if key in seen or key == owner.lower():
        raise StError(part.at, f"duplicate name {part.name}")
    if block is not None and _has_member(block, key):
        raise StError(part.at, f"{part.name} hides a member of {block.name}")
    seen.add(key)


def check_routine(universe: Universe, declaration: ast.Routine, block: types.Block | None, facts: Facts) -> None:
    scope = scope_of(universe, declaration, block)
    facts.scopes[declaration] = scope
    for section in declaration.sections:
        for part in section.variables:
            _check_initial(universe, part, scope, facts)
    if NATIVE in declaration.pragmas:
        return
    Statements(scope, facts).check(declaration.body)
    if scope.result is not None and not scope.result_assigned:
        raise StError(declaration.at, f"{declaration.name} never assigns its return value")
