"""Python source of checked expressions.

A real result is tested for being finite where it leaves an expression or is an operand of anything
that could hide it (a divisor, a comparison, an argument). Sums, products and dividends pass infinities
and NaNs on, so one test at their end finds the same faults as a test after every operation.
"""

from . import ast, constants, python_names
from . import st_types as types
from .check_builtins import REAL_FUNCTIONS
from .conversions import conversion
from .facts import BoundCall, Facts, Scope
from .faults import StError
from .initial_values import initial, is_inlined, literal
from .intervals import Interval, Known, interval
from .lexical import QUERY

_COMPARISONS = {"=": "==", "<>": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}
_LOGIC = {"AND": "&", "OR": "|", "XOR": "^"}  # these evaluate both sides, as Structured Text does
_CHOICES = {"MIN": "minimum", "MAX": "maximum", "SEL": "selected", "LIMIT": "limited", "LEFT": "left"}


class Expressions:
    def __init__(self, scope: Scope, facts: Facts) -> None:
        self.scope = scope
        self.facts = facts
        self.known: Known = {}
        """The values that control variables can have, in the bodies of their loops."""

    def value(self, node: ast.Expression, wanted: types.Type | None = None) -> str:
        """Source of the value; whole numbers take the shape of the wanted type."""
        given = self.facts.type_of[node]
        if isinstance(given, types.IntegerLiteral):
            return literal(given.value, wanted or types.DINT)
        code = self._raw(node)
        if self._may_be_infinite(node):
            return f"(_t if (_t := {code}) - _t == 0.0 else not_finite(_t))"
        return code

    def _may_be_infinite(self, node: ast.Expression) -> bool:
        """Is this the result of real arithmetic, in contrast to a copy of a variable?"""
        if self.facts.type_of[node] != types.LREAL:
            return False
        if isinstance(node, ast.Binary):
            return True
        if isinstance(node, ast.Unary):
            return self._may_be_infinite(node.operand)
        if isinstance(node, ast.Call):
            callee = self.facts.calls[node].callee
            return isinstance(callee, types.Builtin) and callee.name.upper() != "SEL" and not _converts(callee)
        return False

    def _unchecked(self, node: ast.Expression) -> str:
        given = self.facts.type_of[node]
        return literal(given.value, types.LREAL) if isinstance(given, types.IntegerLiteral) else self._raw(node)

    def _raw(self, node: ast.Expression) -> str:
        match node:
            case ast.Literal():
                return literal(node.value, self.facts.type_of[node])
            case ast.Name():
                return self.named(node, self.facts.meanings[node])
            case ast.Member():
                return self._member(node)
            case ast.Index():
                return self._index(node)
            case ast.This():
                return "self"
            case ast.AddressOf():
                return f"address({self.value(node.operand)})"
            case ast.Unary():
                return self._unary(node)
            case ast.Binary():
                return self._binary(node)
            case ast.Call():
                return self._call(node)
        raise StError(node.at, "a pointer can be dereferenced only as p^[i]")

    # ---- names and places --------------------------------------------------------------
    def named(self, node: ast.Expression, meaning: types.Meaning) -> str:
        if isinstance(meaning, types.EnumMember):
            return repr(meaning.name)
        if isinstance(meaning, types.Property):
            return f"self.{python_names.getter(meaning.name)}()"
        assert isinstance(meaning, types.Variable)
        if is_inlined(meaning) and meaning.initial is not None:
            return literal(constants.evaluate(meaning.initial, self.scope.meaning), meaning.type)
        code = self.holder(meaning)
        return f"{code}.value" if self.is_cell(meaning) else code

    def holder(self, variable: types.Variable) -> str:
        """Source of the variable itself: its cell where it lives in one."""
        if variable.member_of is not None:
            return f"self.{python_names.attribute(variable.name)}"
        if variable.scope == "VAR_GLOBAL":
            return python_names.global_variable(variable)
        return python_names.local(variable.name)

    def is_cell(self, variable: types.Variable) -> bool:
        if not types.is_scalar(variable.type) or variable.scope == "FIELD":
            return False
        if variable.is_reference:
            return True
        return variable in self.facts.boxed and variable.member_of is None and variable.scope != "VAR_GLOBAL"

    def _member(self, node: ast.Member) -> str:
        meaning = self.facts.meanings[node]
        if isinstance(meaning, types.EnumMember) or isinstance(self.scope.meaning(node), types.Variable):
            return self.named(node, meaning)
        owner = self.value(node.object)
        if isinstance(meaning, types.Property):
            return f"{owner}.{python_names.getter(meaning.name)}()"
        assert isinstance(meaning, types.Variable)
        code = f"{owner}.{python_names.attribute(meaning.name)}"
        return f"{code}.value" if self.is_cell(meaning) else code

    def _index(self, node: ast.Index) -> str:
        offset = self.offset(node)
        if isinstance(node.object, ast.Dereference):
            return f"peek({self.value(node.object.pointer)}, {offset})"
        return f"{self.value(node.object)}[{offset}]"

    def offset(self, node: ast.Index) -> str:
        """The position in the flat list, tested against the bounds of every dimension."""
        array = self.facts.type_of[node.object]
        assert isinstance(array, types.Array)
        parts, constant, stride = list[str](), 0, array.count
        for index, (low, high) in zip(node.indices, array.bounds, strict=True):
            stride //= high - low + 1
            known = constants.evaluate(index, self.scope.meaning)
            if isinstance(known, int):
                constant += stride * (known - low)
            else:
                part = self._within(index, low, high)
                parts.append(part if stride == 1 else f"{part} * {stride}")
                constant -= stride * low
        if not parts:
            return str(constant)
        shift = "" if constant == 0 else f" {'+' if constant > 0 else '-'} {abs(constant)}"
        return " + ".join(parts) + shift

    def _within(self, index: ast.Expression, low: int, high: int) -> str:
        """An index, tested against those bounds that it might be beyond."""
        value, (least, most) = self.value(index), self.interval(index)
        is_above, is_below = least is not None and least >= low, most is not None and most <= high
        if is_above and is_below:
            return value if value.isidentifier() else f"({value})"
        name, bound = (value, value) if value.isidentifier() else ("_i", f"(_i := {value})")
        test = f"{'' if is_above else f'{low} <= '}{bound}{'' if is_below else f' <= {high}'}"
        return f"({name} if {test} else outside({name}, {low}, {high}))"

    def interval(self, node: ast.Expression) -> Interval:
        """The least and the largest value that an integer expression can have here."""
        return interval(node, self.known, self.facts, self.scope.meaning)

    def reference(self, node: ast.Expression) -> str:
        """Source of what a VAR_IN_OUT gets: the object itself, or a cell of a scalar."""
        if not types.is_scalar(self.facts.type_of[node]):
            return self.value(node)
        if isinstance(node, ast.Index):
            if isinstance(node.object, ast.Dereference):
                raise StError(node.at, "memory behind a pointer cannot be handed on by reference")
            return f"ElementCell({self.value(node.object)}, {self.offset(node)})"
        meaning = self.facts.meanings[node]
        assert isinstance(meaning, types.Variable)
        if isinstance(node, ast.Member) and meaning.scope == "FIELD":
            return f"FieldCell({self.value(node.object)}, {python_names.attribute(meaning.name)!r})"
        if is_inlined(meaning):
            return f"Cell({self.named(node, meaning)})"
        if meaning.is_reference or (meaning.member_of is None and self.is_cell(meaning)):
            return self.holder(meaning)
        owner = self.value(node.object) if isinstance(node, ast.Member) else "self"
        return f"FieldCell({owner}, {python_names.attribute(meaning.name)!r})"

    # ---- operators ---------------------------------------------------------------------
    def _in_range(self, code: str, of: types.Type) -> str:
        assert isinstance(of, types.Integer)
        return f"(_i if {of.low} <= (_i := {code}) <= {of.high} else overflow(_i))"

    def _unary(self, node: ast.Unary) -> str:
        of = self.facts.type_of[node]
        if node.operator == "NOT":
            operand = self.value(node.operand)
            return f"(not {operand})" if of == types.BOOL else f"(255 ^ {operand})"
        if of == types.LREAL:
            return f"(-{self._unchecked(node.operand)})"
        return self._in_range(f"-{self.value(node.operand)}", of)

    def _binary(self, node: ast.Binary) -> str:
        if node.operator in _LOGIC:
            return f"({self.value(node.left)} {_LOGIC[node.operator]} {self.value(node.right)})"
        if node.operator in _COMPARISONS:
            return self._comparison(node)
        of = self.facts.type_of[node]
        if of == types.LREAL:
            right = self.value(node.right, of) if node.operator == "/" else self._unchecked(node.right)
            return f"({self._left_operand(node)} {node.operator} {right})"
        left, right = self.value(node.left), self.value(node.right)
        if node.operator == "/":
            return self._in_range(f"quotient({left}, {right})", of)
        if node.operator == "MOD":
            return self._in_range(f"remainder({left}, {right})", of)
        code, (least, most) = f"{left} {node.operator} {right}", self.interval(node)
        assert isinstance(of, types.Integer)
        is_inside = least is not None and most is not None and of.low <= least and most <= of.high
        return f"({code})" if is_inside else self._in_range(code, of)

    def _left_operand(self, node: ast.Binary) -> str:
        """Without needless brackets: Python allows only 200 of them inside each other."""
        code, left = self._unchecked(node.left), node.left
        if not isinstance(left, ast.Binary) or isinstance(self.facts.type_of[left], types.IntegerLiteral):
            return code
        chain = node.operator in "+-" or left.operator in "*/"
        return code[1:-1] if chain else code

    def _comparison(self, node: ast.Binary) -> str:
        left, right = self.facts.type_of[node.left], self.facts.type_of[node.right]
        if isinstance(left, (types.Pointer, types.Interface)):
            return f"({self.value(node.left)} {'is' if node.operator == '=' else 'is not'} None)"
        wanted = types.LREAL if types.LREAL in (left, right) else None
        operator = _COMPARISONS[node.operator]
        return f"({self.value(node.left, wanted)} {operator} {self.value(node.right, wanted)})"

    # ---- calls -------------------------------------------------------------------------
    def _call(self, node: ast.Call) -> str:
        bound = self.facts.calls[node]
        if isinstance(bound.callee, types.Builtin):
            return self._builtin(node, bound.callee.name.upper())
        assert isinstance(bound.callee, types.Routine)
        arguments = self.arguments(bound)
        routine = bound.callee
        if routine.block is None and routine.interface is None:
            return f"{python_names.function(routine)}({', '.join(arguments)})"
        name = python_names.method(routine.name)
        owner = node.function.object if isinstance(node.function, ast.Member) else None
        if isinstance(owner, ast.Super):
            base = routine.block
            assert base is not None
            return f"{python_names.type_class(base)}.{name}({', '.join(['self', *arguments])})"
        instance = "self" if owner is None else self.value(owner)
        instance = instance if routine.interface is None else f"referred({instance})"
        return f"{instance}.{name}({', '.join(arguments)})"

    def arguments(self, bound: BoundCall) -> list[str]:
        return [self._argument(parameter, given) for parameter, given in bound.arguments]

    def _argument(self, parameter: types.Variable, given: ast.Expression | None) -> str:
        if given is None:
            return "None" if parameter.scope == "VAR_OUTPUT" else initial(parameter, self.scope.meaning)
        if parameter.scope == "VAR_INPUT":
            return self.value(given, parameter.type)
        return self.reference(given)

    def _builtin(self, node: ast.Call, name: str) -> str:
        of = self.facts.type_of[node]
        if name in REAL_FUNCTIONS:
            return f"math.{name.lower()}({self.value(node.arguments[0].value, types.LREAL)})"
        if name == "TRUNC":
            return self._in_range(f"truncated({self.value(node.arguments[0].value)})", of)
        pair = conversion(name)
        if pair is not None:
            return self._conversion(self.value(node.arguments[0].value, pair[0]), *pair)
        if name == QUERY:
            source, target = (argument.value for argument in node.arguments)
            wanted = self.facts.type_of[target].name.lower()
            return f"query({self.value(source)}, {self.reference(target)}, {wanted!r})"
        if name == "SEL" and all(self._is_plain(argument.value) for argument in node.arguments[1:]):
            choice, if_false, if_true = (self.value(argument.value, of) for argument in node.arguments)
            return f"({if_true} if {choice} else {if_false})"
        given = ", ".join(self.value(argument.value, of) for argument in node.arguments)
        if name == "ABS":
            return f"abs({given})" if of == types.LREAL else self._in_range(f"abs({given})", of)
        return f"{_CHOICES[name]}({given})"

    def _is_plain(self, node: ast.Expression) -> bool:
        """Is this a number or a variable, of which it makes no difference whether it is evaluated?"""
        if isinstance(node, ast.Unary):
            return isinstance(node.operand, ast.Literal)
        meaning = self.facts.meanings[node] if isinstance(node, ast.Name) else None
        return isinstance(node, ast.Literal) or (isinstance(meaning, types.Variable) and not meaning.is_reference)

    def _conversion(self, code: str, source: types.Type, target: types.Type) -> str:
        if target == types.BOOL:
            return f"({code} != 0)"
        if target == types.LREAL:
            return f"float({code})"
        return self._in_range(f"rounded({code})" if source == types.LREAL else f"int({code})", target)


def _converts(callee: types.Builtin) -> bool:
    """Is this a conversion? A whole number is finite as a real one."""
    return conversion(callee.name.upper()) is not None
