"""All declared objects of the texts and of the library stand-ins, and how their names are found."""

from __future__ import annotations

from . import ast, constants
from . import st_types as types
from .faults import Place, StError
from .lexical import SYSTEM

LIBRARIES = ("TRAFO", "SM3M", "SM3_Error", "GD", "PDL", "ROB")


class Universe:
    def __init__(self) -> None:
        self.spaces: dict[str, types.Namespace] = {"": types.Namespace("", {})}
        for name in LIBRARIES:
            self.spaces[name.lower()] = types.Namespace(name, {})
        query = types.Interface("IQueryInterface", is_queryable=True)
        self.spaces[SYSTEM.lower()] = types.Namespace(SYSTEM, {query.name.lower(): query})
        self.globals: list[types.Variable] = []

    def copy(self) -> Universe:
        other = Universe()
        other.spaces = {key: types.Namespace(space.name, dict(space.entries)) for key, space in self.spaces.items()}
        other.globals = self.globals[:]
        return other

    # ---- finding -----------------------------------------------------------------------
    def find(self, name: str) -> types.Meaning | None:
        """An unqualified name: own objects, library objects, members of open enumerations."""
        key = name.lower()
        visible = [self.spaces[name.lower()] for name in ("", *LIBRARIES)]
        for space in visible:
            if key in space.entries:
                return space.entries[key]
        if key in self.spaces and key:
            return self.spaces[key]
        for space in visible:
            for entry in space.entries.values():
                if isinstance(entry, types.Enum) and not entry.qualified_only and key in entry.members:
                    return types.EnumMember(entry, entry.members[key])
        return None

    def find_path(self, path: str) -> types.Meaning | None:
        first, *rest = path.split(".")
        found = self.find(first)
        for part in rest:
            found = found.entries.get(part.strip().lower()) if isinstance(found, types.Namespace) else None
        return found

    def meaning(self, node: ast.Expression) -> types.Meaning | None:
        """What a global name or a dotted path of names means; None for anything local."""
        if isinstance(node, ast.Name):
            return self.find(node.text)
        if isinstance(node, ast.Member):
            owner = self.meaning(node.object)
            if isinstance(owner, types.Namespace):
                return owner.entries.get(node.name.lower())
            if isinstance(owner, types.Enum) and node.name.lower() in owner.members:
                return types.EnumMember(owner, owner.members[node.name.lower()])
        return None

    def type_of(self, text: ast.TypeText) -> types.Type:
        if isinstance(text, ast.StringText):
            return types.String(text.length)
        if isinstance(text, ast.PointerText):
            return types.Pointer(self.type_of(text.target))
        if isinstance(text, ast.ArrayText):
            bounds = tuple(
                (constants.whole(low, self.meaning), constants.whole(high, self.meaning)) for low, high in text.bounds
            )
            if any(low > high for low, high in bounds):
                raise StError(text.at, f"empty array {text.text}")
            return types.Array(bounds, self.type_of(text.element))
        elementary = types.ELEMENTARY.get(text.text.upper())
        found = elementary or self.find_path(text.text)
        if isinstance(found, types.Type):
            return found
        raise StError(text.at, f"unknown type {text.text}")

    # ---- declaring ---------------------------------------------------------------------
    def declare(self, space: str, name: str, meaning: types.Meaning, at: Place) -> None:
        key = name.lower()
        if any(key in other.entries for other in self.spaces.values()) or key in self.spaces:
            raise StError(at, f"duplicate name {name}")
        self.spaces[space.lower()].entries[key] = meaning

    def add(self, declarations: list[ast.Declaration], space: str) -> None:
        """Declare a batch: first all names, then what they consist of, so order does not matter."""
        for declaration in declarations:
            self._announce(declaration, space)
        for kind in (ast.Globals, ast.Structure, ast.Interface, ast.Routine, ast.Block):
            for declaration in declarations:
                if isinstance(declaration, kind):
                    self._complete(declaration, space)

    def _announce(self, declaration: ast.Declaration, space: str) -> None:
        name, at = declaration.name, declaration.at
        if isinstance(declaration, ast.Structure):
            self.declare(space, name, types.Struct(name, space), at)
        elif isinstance(declaration, ast.Enumeration):
            self.declare(space, name, _enum(declaration, space), at)
        elif isinstance(declaration, ast.Interface):
            self.declare(space, name, types.Interface(name, is_queryable=False), at)
        elif isinstance(declaration, ast.Block):
            self.declare(space, name, types.Block(name, declaration), at)

    def _complete(self, declaration: ast.Declaration, space: str) -> None:
        if isinstance(declaration, ast.Globals):
            self._add_globals(declaration, space)
        elif isinstance(declaration, ast.Structure):
            struct = self.spaces[space.lower()].entries[declaration.name.lower()]
            assert isinstance(struct, types.Struct)
            for part in declaration.fields:
                if part.name.lower() in struct.fields:
                    raise StError(part.at, f"duplicate name {part.name}")
                struct.fields[part.name.lower()] = types.Variable(
                    part.name, self.type_of(part.type), "FIELD", initial=part.initial
                )
        elif isinstance(declaration, ast.Interface):
            interface = self.spaces[space.lower()].entries[declaration.name.lower()]
            assert isinstance(interface, types.Interface)
            self._complete_interface(interface, declaration)
        elif isinstance(declaration, ast.Routine):
            routine = self.routine(declaration, None)
            routine.namespace = space
            self.declare(space, declaration.name, routine, declaration.at)
        elif isinstance(declaration, ast.Block):
            block = self.spaces[space.lower()].entries[declaration.name.lower()]
            assert isinstance(block, types.Block)
            self._complete_block(block)

    def _add_globals(self, declaration: ast.Globals, space: str) -> None:
        target = space
        if any("qualified_only" in pragma for pragma in declaration.pragmas):
            target = declaration.name
            self.spaces.setdefault(target.lower(), types.Namespace(target, {}))
        for part in declaration.variables:
            variable = types.Variable(
                part.name, self.type_of(part.type), "VAR_GLOBAL", declaration.constant, None, part.initial
            )
            self.globals.append(variable)
            self.declare(target, part.name, variable, part.at)

    def _complete_interface(self, interface: types.Interface, written: ast.Interface) -> None:
        for base in written.extends:
            found = self.find_path(base)
            if not isinstance(found, types.Interface):
                raise StError(written.at, f"unknown interface {base}")
            interface.bases += (found,)
            interface.is_queryable = interface.is_queryable or found.is_queryable
        for method in written.methods:
            routine = self.routine(method, None)
            routine.interface = interface
            interface.methods.setdefault(method.name.lower(), routine)

    def _complete_block(self, block: types.Block) -> None:
        written = block.declaration
        implemented = (self.find_path(name) for name in written.implements)
        block.interfaces = tuple(one for one in implemented if isinstance(one, types.Interface))
        if written.extends is not None:
            base = self.find_path(written.extends)
            if not isinstance(base, types.Block):
                raise StError(written.at, f"unknown base block {written.extends}")
            block.base = base
        for section in written.sections:
            for part in section.variables:
                block.variables.setdefault(part.name.lower(), self.variable(part, section, block))
        for method in written.methods:
            block.methods.setdefault(method.name.lower(), self.routine(method, block))
        for prop in written.properties:
            getter = self.routine(prop.getter, block)
            block.properties.setdefault(prop.name.lower(), types.Property(prop.name, getter.returns, getter))

    def variable(
        self, part: ast.VariableDeclaration, section: ast.Section, block: types.Block | None
    ) -> types.Variable:
        return types.Variable(part.name, self.type_of(part.type), section.scope, section.constant, block, part.initial)

    def routine(self, declaration: ast.Routine, block: types.Block | None) -> types.Routine:
        parameters = tuple(
            self.variable(part, section, None)
            for section in declaration.sections
            if section.scope in ("VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT")
            for part in section.variables
        )
        returns = types.NOTHING if declaration.returns is None else self.type_of(declaration.returns)
        return types.Routine(declaration.name, declaration, returns, parameters, block)


def _enum(declaration: ast.Enumeration, space: str) -> types.Enum:
    members: dict[str, str] = {}
    for name, _value in declaration.members:
        if name.lower() in members:
            raise StError(declaration.at, f"duplicate name {name}")
        members[name.lower()] = name
    qualified = any("qualified_only" in pragma for pragma in declaration.pragmas)
    return types.Enum(declaration.name, space, members, qualified)
