"""Texts checked and translated on what others have in common with them: that is done once.

Nearly every library begins with the stand-ins and the shared objects, and only its last text is new.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from . import ast, library_interfaces, python_names, stubs
from . import st_types as types
from .check import NATIVE, check
from .facts import Facts, Scope
from .faults import Place, StError
from .initial_values import default, initial, is_inlined
from .parse import parse
from .translate_statements import Source, Statements, assignment
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
            add(f"    {assignment(f'self.{field}', f'other.{field}', variable.type)}")
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
                lines.append(f"if {target} is not None: {assignment(place, value, variable.type)}")
        if scope.result is None:
            return [*lines, "return"]
        own = python_names.local(scope.result.name)
        return [*lines, f"return {own}.value" if scope.result in self.facts.boxed else f"return {own}"]


def _parameter(variable: types.Variable) -> str:
    prefix = "output_" if variable.scope == "VAR_OUTPUT" else ""
    return prefix + python_names.local(variable.name)


def _copied(name: str, of: types.Type) -> str:
    if isinstance(of, types.Array):
        return f"{name}[:]" if types.is_scalar(of.element) else f"copy_elements({name})"
    return f"{name}._copy()"


Texts = tuple[tuple[str, str], ...]
"""The name of each, and its Structured Text."""


@dataclass(frozen=True, eq=False)
class Layer:
    """Objects that others can be translated on: nobody writes into it."""

    universe: Universe
    source: Source
    """Without the globals, which come last."""

    def followed_by(self, universe: Universe, declarations: Sequence[ast.Declaration]) -> Layer:
        """With more objects, which the universe knows."""
        source = Source(self.source.lines[:], self.source.places[:])
        translate(universe, declarations, check(universe, declarations), stubs.EXTRA_INITIALISATION, source)
        return Layer(universe, source)

    def whole(self) -> Source:
        source = Source(self.source.lines[:], self.source.places[:])
        globals_of(self.universe, source)
        return source


def layer_of(texts: Texts, matrix_size: int, max_config_data: int) -> Layer:
    """The last text on the others; all of them at once where the others need it, or where it declares a name that they
    find. Raises StError.
    """
    last = [declaration for file, text in texts[-1:] for declaration in declarations_of(text, file)]
    try:
        others = _at_once(texts[:-1], matrix_size, max_config_data)
    except StError:
        return _at_once(texts, matrix_size, max_config_data)
    if any(others.universe.find(name) is not None for declaration in last for name in _declared(declaration)):
        return _at_once(texts, matrix_size, max_config_data)
    universe = others.universe.copy()
    universe.add(last, "")
    return others.followed_by(universe, last)


@lru_cache(maxsize=8)
def _at_once(texts: Texts, matrix_size: int, max_config_data: int) -> Layer:
    universe = Universe()
    universe.declare("SM3M", "SMC_Matrix3", types.Opaque("SMC_Matrix3", matrix_size), Place("SM3M", 0))
    everything: list[ast.Declaration] = []
    for space, declarations in _stub_declarations(max_config_data).items():
        universe.add(list(declarations), space)
        everything += declarations
    own = [declaration for file, text in texts for declaration in declarations_of(text, file)]
    universe.add(own, "")
    return Layer(universe, Source()).followed_by(universe, everything + own)


def _declared(declaration: ast.Declaration) -> Iterator[str]:
    """The names that a declaration may give a meaning outside of it."""
    yield declaration.name
    if isinstance(declaration, ast.Globals):
        yield from (variable.name for variable in declaration.variables)
    if isinstance(declaration, ast.Enumeration):
        yield from (name for name, _ in declaration.members)


@lru_cache(maxsize=256)
def declarations_of(text: str, file: str) -> tuple[ast.Declaration, ...]:
    """A text that stands in many libraries is parsed once: nobody writes into a syntax tree."""
    return tuple(parse(text, file))


@lru_cache
def _stub_declarations(max_config_data: int) -> dict[str, tuple[ast.Declaration, ...]]:
    found = {space: tuple(parse(text, space)) for space, text in stubs.texts(max_config_data).items()}
    return found | {"TRAFO": (*found["TRAFO"], *library_interfaces.declared())}
