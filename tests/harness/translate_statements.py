"""Python source of checked statements and of the frame round them."""

from dataclasses import dataclass, field

from . import ast, constants, python_names
from . import st_types as types
from .facts import Facts, Scope
from .faults import Place
from .initial_values import literal
from .intervals import is_written, of_loop
from .runtime import LOOP_CAP
from .translate_expressions import Expressions


@dataclass
class Source:
    """Lines of Python and, for each, the place in the text it comes from."""

    lines: list[str] = field(default_factory=list)
    places: list[Place | None] = field(default_factory=list)
    depth: int = 0

    def add(self, line: str, at: Place | None = None) -> None:
        self.lines.append("    " * self.depth + line)
        self.places.append(at)


def assignment(target: str, value: str, of: types.Type) -> str:
    """Structures, matrices and arrays change in place, so that references to them stay good."""
    if types.is_scalar(of):
        return f"{target} = {value}"
    if isinstance(of, types.Array):
        return f"{target}[:] = {value}" if types.is_scalar(of.element) else f"assign_elements({target}, {value})"
    return f"{target}._assign({value})"


class Statements:
    def __init__(self, source: Source, scope: Scope, facts: Facts, leave: list[str]) -> None:
        self.source = source
        self.scope = scope
        self.facts = facts
        self.leave = leave  # the lines that hand outputs and result to the caller
        self.code = Expressions(scope, facts)
        self.loops = 0

    def body(self, statements: tuple[ast.Statement, ...]) -> None:
        self.source.depth += 1
        for statement in statements:
            self._statement(statement)
        if not statements:
            self.source.add("pass")
        self.source.depth -= 1

    def _statement(self, node: ast.Statement) -> None:
        match node:
            case ast.Assign():
                target_type = self.facts.type_of[node.target]
                self._store(node.target, self.code.value(node.value, target_type), node.at)
            case ast.CallStatement():
                self._call(node)
            case ast.If():
                self._if(node)
            case ast.Case():
                self._case(node)
            case ast.For():
                self._for(node)
            case ast.Exit():
                self.source.add("break", node.at)
            case ast.Return():
                for line in self.leave:
                    self.source.add(line, node.at)

    def _store(self, target: ast.Expression, value: str, at: Place) -> None:
        of = self.facts.type_of[target]
        if isinstance(target, ast.Index) and isinstance(target.object, ast.Dereference):
            pointer, offset = self.code.value(target.object.pointer), self.code.offset(target)
            self.source.add(f"poke({pointer}, {offset}, {value})", at)
        else:
            self.source.add(assignment(self.code.value(target), value, of), at)

    # ---- calls of instances ------------------------------------------------------------
    def _call(self, node: ast.CallStatement) -> None:
        bound = self.facts.calls[node.call]
        if not isinstance(bound.callee, types.Block):
            self.source.add(self.code.value(node.call), node.at)
            return
        instance = self.code.value(node.call.function)
        for parameter, given in bound.arguments:
            if given is not None and parameter.scope != "VAR_OUTPUT":
                self._hand_over(f"{instance}.{python_names.attribute(parameter.name)}", parameter, given)
        self.source.add(f"{instance}.body()", node.at)
        for parameter, given in bound.arguments:
            if given is not None and parameter.scope == "VAR_OUTPUT":
                self._store(given, f"{instance}.{python_names.attribute(parameter.name)}", node.at)

    def _hand_over(self, place: str, parameter: types.Variable, given: ast.Expression) -> None:
        if parameter.is_reference:
            self.source.add(f"{place} = {self.code.reference(given)}", given.at)
            return
        self.source.add(assignment(place, self.code.value(given, parameter.type), parameter.type), given.at)

    # ---- control -----------------------------------------------------------------------
    def _if(self, node: ast.If) -> None:
        for number, branch in enumerate(node.branches):
            word = "elif" if number else "if"
            self.source.add(f"{word} {self.code.value(branch.condition)}:", branch.condition.at)
            self.body(branch.body)
        if node.otherwise:
            self.source.add("else:")
            self.body(node.otherwise)

    def _case(self, node: ast.Case) -> None:
        self.loops += 1
        subject = f"_case{self.loops}"
        self.source.add(f"{subject} = {self.code.value(node.subject)}", node.at)
        word = "if"
        for branch in node.branches:
            values = (constants.evaluate(label, self.scope.meaning) for label in branch.labels)
            tests = " or ".join(f"{subject} == {literal(value, types.DINT)}" for value in values)
            self.source.add(f"{word} {tests}:", branch.labels[0].at)
            self.body(branch.body)
            word = "elif"
        if node.otherwise:
            self.source.add("else:" if node.branches else "if True:")
            self.body(node.otherwise)

    def _for(self, node: ast.For) -> None:
        self.loops += 1
        stop = f"_stop{self.loops}"
        of = self.facts.type_of[node.control]
        assert isinstance(of, types.Integer)
        control = self.code.value(node.control)
        step = 1 if node.step is None else constants.whole(node.step, self.scope.meaning)
        self.source.add(f"{control} = {self.code.value(node.start, of)}", node.at)
        self.source.add(f"{stop} = {self.code.value(node.stop, of)}", node.at)
        # A control variable that cannot step past its end would run for ever on a controller.
        advanced = f"(_i if {of.low} <= (_i := {control} + {step}) <= {of.high} else overflow(_i))"
        condition = f"{control} {'<=' if step > 0 else '>='} {stop}"
        if of.high - of.low >= LOOP_CAP or not self._is_counted(node):
            self.source.add(f"for _ in range({LOOP_CAP + 1}):", node.at)
            self.source.add(f"    if not {condition}: break", node.at)
            self.body(node.body)
            self.source.add(f"    {control} = {advanced}", node.at)
            self.source.add("else: unbounded()", node.at)
            return
        past = f"{stop} {'+' if step > 0 else '-'} 1"
        self.source.add(f"for {control} in range({control}, {past}{'' if step == 1 else f', {step}'}):", node.at)
        self._counted(node, step)
        self.source.add(f"else: {control} = {advanced} if {condition} else {control}", node.at)

    def _is_counted(self, node: ast.For) -> bool:
        """Whether nothing but the loop itself writes its control variable, which nobody else sees."""
        variable = self.facts.meanings[node.control]
        assert isinstance(variable, types.Variable)
        is_local = self.scope.locals.get(variable.name.lower()) is variable and not self.code.is_cell(variable)
        return is_local and not is_written(variable, node.body, self.facts)

    def _counted(self, node: ast.For, step: int) -> None:
        """The body of such a loop: the control variable stays between the ends."""
        variable = self.facts.meanings[node.control]
        assert isinstance(variable, types.Variable)
        self.code.known[variable] = of_loop(self.code.interval(node.start), self.code.interval(node.stop), step)
        self.body(node.body)
        del self.code.known[variable]
