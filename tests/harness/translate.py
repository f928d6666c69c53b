"""Python source of declarations: one class per structure and block, one function per routine."""

from collections.abc import Sequence

from . import ast, python_names
from . import st_types as types
from .check import NATIVE
from .facts import Facts, Scope
from .initial_values import default, initial, is_inlined
from .translate_statements import Source, Statements
from .universe import Universe


def translate(
    universe: Universe,
    declarations: Sequence[ast.Declaration],
    facts: Facts,
    extra: dict[str, list[str]],
    source: Source,
) -> None:
    """Add declarations to the source of what they are based on; `extra` adds lines to the start of a structure's
    life.
    """
    translator = _Translator(universe, facts, extra, source, [one.name for one in declarations])
    for declaration in declarations:
        translator.declaration(declaration)


def globals_of(universe: Universe, source: Source) -> None:
    """Add the globals: they hold instances of the classes, so they come last."""
    for variable in universe.globals:
        if not is_inlined(variable):
            name = python_names.global_variable(variable)
            source.add(f"{name} = {initial(variable, universe.meaning)}")


class _Translator:
    def __init__(
        self, universe: Universe, facts: Facts, extra: dict[str, list[str]], source: Source, names: list[str]
    ) -> None:
        self.universe = universe
        self.facts = facts
        self.extra = extra
        self.source = source
        self.pending = set(names)

    def declaration(self, node: ast.Declaration) -> None:
        found = self.universe.find(node.name)
        if isinstance(found, types.Struct):
            self._struct(found)
        elif isinstance(found, types.Block):
            self._block(found)
        elif isinstance(node, ast.Routine) and NATIVE not in node.pragmas:
            assert isinstance(found, types.Routine)
            self._routine(python_names.function(found), node, found)

    # ---- structures --------------------------------------------------------------------
    def _struct(self, struct: types.Struct) -> None:
        add, name = self.source.add, python_names.type_class(struct)
        names = [python_names.attribute(v.name) for v in struct.fields.values()]
        add(f"class {name}(StructValue):")
        self.source.depth += 1
        add(f"__slots__ = _fields = {tuple(names)!r}")
        add("def __init__(self):")
        for field, variable in zip(names, struct.fields.values(), strict=True):
            add(f"    self.{field} = {initial(variable, self.universe.meaning)}")
        for line in self.extra.get(struct.name, []):
            add(f"    {line}")
        add("    pass")
        add("def _assign(self, other):")
        for field, variable in zip(names, struct.fields.values(), strict=True):
            add(f"    {_assignment(f'self.{field}', f'other.{field}', variable.type)}")
        add("    pass")
        add("def _copy(self):")
        add(f"    new = object.__new__({name})")
        for field, variable in zip(names, struct.fields.values(), strict=True):
            own = f"self.{field}"
            add(f"    new.{field} = {own if types.is_scalar(variable.type) else _copied(own, variable.type)}")
        add("    return new")
        self.source.depth -= 1

    # ---- blocks ------------------------------------------------------------------------
    def _block(self, block: types.Block) -> None:
        if block.name not in self.pending:
            return
        self.pending.remove(block.name)
        if block.base is not None:
            self._block(block.base)  # Python needs the base class first
        add = self.source.add
        base = "Instance" if block.base is None else python_names.type_class(block.base)
        scope = Scope(self.universe, block, block.name, {}, None, False)
        add(f"class {python_names.type_class(block)}({base}):", block.declaration.at)
        self.source.depth += 1
        add(f"__slots__ = {tuple(python_names.attribute(v.name) for v in block.variables.values())!r}")
        add(f"implemented = frozenset({sorted(one.name.lower() for one in block.implemented())!r})")
        add("def __init__(self):")
        add("    super().__init__()")
        for variable in block.variables.values():
            # An in-out is bound by the call; until then there is nothing to refer to.
            start = "None" if variable.is_reference else initial(variable, scope.meaning)
            add(f"    self.{python_names.attribute(variable.name)} = {start}")
        add("def body(self):")
        Statements(self.source, scope, self.facts, ["return"]).body(block.declaration.body)
        for routine in block.methods.values():
            self._routine(python_names.method(routine.name), routine.declaration, routine)
        for prop in block.properties.values():
            self._routine(python_names.getter(prop.name), prop.getter.declaration, prop.getter)
        self.source.depth -= 1

    # ---- routines ----------------------------------------------------------------------
    def _routine(self, name: str, node: ast.Routine, routine: types.Routine) -> None:
        scope = self.facts.scopes[node]
        statements = Statements(self.source, scope, self.facts, self._leave(scope, routine))
        own = ["self"] if routine.block is not None else []
        self.source.add(f"def {name}({', '.join(own + [_parameter(p) for p in routine.parameters])}):", node.at)
        self.source.depth += 1
        for variable in scope.locals.values():
            for line in self._start(variable, scope, statements):
                self.source.add(line, node.at)
        self.source.depth -= 1
        statements.body(node.body)
        self.source.depth += 1
        for line in statements.leave:
            self.source.add(line, node.at)
        self.source.depth -= 1

    def _start(self, variable: types.Variable, scope: Scope, statements: Statements) -> list[str]:
        """The lines that bring a local variable to life."""
        name = python_names.local(variable.name)
        in_cell = statements.code.is_cell(variable)
        if variable.scope == "VAR_IN_OUT" or is_inlined(variable):
            return []
        if variable.scope == "VAR_INPUT":
            if in_cell:
                return [f"{name} = Cell({name})"]
            return [] if types.is_scalar(variable.type) else [f"{name} = {_copied(name, variable.type)}"]
        start = initial(variable, scope.meaning) if variable.scope != "RESULT" else default(variable.type)
        return [f"{name} = Cell({start})" if in_cell else f"{name} = {start}"]

    def _leave(self, scope: Scope, routine: types.Routine) -> list[str]:
        """Outputs go to whoever asked for them, then the result is returned."""
        lines = []
        for variable in routine.parameters:
            if variable.scope == "VAR_OUTPUT":
                own, target = python_names.local(variable.name), _parameter(variable)
                value = f"{own}.value" if variable in self.facts.boxed else own
                place = f"{target}.value" if types.is_scalar(variable.type) else target
                lines.append(f"if {target} is not None: {_assignment(place, value, variable.type)}")
        if scope.result is None:
            return [*lines, "return"]
        own = python_names.local(scope.result.name)
        return [*lines, f"return {own}.value" if scope.result in self.facts.boxed else f"return {own}"]


def _parameter(variable: types.Variable) -> str:
    prefix = "output_" if variable.scope == "VAR_OUTPUT" else ""
    return prefix + python_names.local(variable.name)


def _assignment(target: str, value: str, of: types.Type) -> str:
    if types.is_scalar(of):
        return f"{target} = {value}"
    if isinstance(of, types.Array):
        return f"{target}[:] = {value}" if types.is_scalar(of.element) else f"assign_elements({target}, {value})"
    return f"{target}._assign({value})"


def _copied(name: str, of: types.Type) -> str:
    if isinstance(of, types.Array):
        return f"{name}[:]" if types.is_scalar(of.element) else f"copy_elements({name})"
    return f"{name}._copy()"
