"""Types of statements."""

from . import ast, constants
from . import st_types as types
from .check_expressions import Expressions
from .conversions import common
from .facts import Facts, Scope
from .faults import StError
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
            case ast.While():
                self._condition(node.condition)
                self._loop(node.body)
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

    def _loop(self, body: tuple[ast.Statement, ...]) -> None:
        self.loops += 1
        self.check(body)
        self.loops -= 1

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
        self._loop(node.body)

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

    def _label(self, label: ast.Label, subject: types.Type, seen: set[constants.Value]) -> None:
        for part in (label.lower, label.upper):
            if part is None:
                continue
            if common(self.expressions.type_of(part), subject) != subject:
                raise StError(label.at, f"the label does not fit {subject.name}")
            value = constants.evaluate(part, self.scope.meaning)
            if value is None:
                raise StError(label.at, "a label must be a constant")
            if value in seen:
                raise StError(label.at, "the label occurs twice")
            seen.add(value)
