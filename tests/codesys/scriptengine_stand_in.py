"""A stand-in for the ScriptEngine of CODESYS V3.5: the documented calls, with the documented refusals.

Its compiler is the harness that executes Structured Text: *Check all Pool Objects* composes the objects of the project
to texts and compiles them. Names are as in the reference of the ScriptEngine; what that does not say is chosen so that
a script that relies on it fails: `create_folder` returns nothing, lists are copies, an unknown category is an error.
"""

from __future__ import annotations

import types
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import Any, TypeGuard

from tests.harness.faults import StError
from tests.harness.library import compile_st

BUILD = "{97F48D64-A2A3-4856-B640-75C046E37EA9}"
SCRIPT = "{194b48a9-ab51-43ae-b9a9-51d3edaaddf3}"
PouType = Enum("PouType", {"Program": 1, "FunctionBlock": 2, "Function": 3})
DutType = Enum("DutType", {"Structure": 1, "Enumeration": 2, "Alias": 3, "Union": 4})
Severity = Enum("Severity", {"FatalError": 1, "Error": 2, "Warning": 4, "Information": 8, "Text": 16})


class Refused(Exception):
    """The error of a call that the ScriptEngine would refuse."""


class Document:
    def __init__(self, text: str = "") -> None:
        self.text = text

    def replace(self, new_text: str) -> None:
        self.text = new_text.replace("\r\n", "\n")


class Tree:
    """The calls that projects and objects have in common."""

    def __init__(self) -> None:
        self._children: list[Node] = []

    def get_children(self, recursive: bool = False) -> list[Node]:
        found = list(self._children)
        return found + [inner for one in found for inner in one.get_children(True)] if recursive else found

    def _add(self, node: Node) -> Node:
        if any(one.get_name().lower() == node.get_name().lower() for one in self._children):
            raise Refused(f"an object {node.get_name()} already exists")
        self._children.append(node)
        node.parent = self
        return node


class Container(Tree):
    """Project and folders: they can hold objects of the language."""

    def create_folder(self, foldername: str) -> None:
        self._add(Folder(foldername, "folder"))

    def create_pou(self, name: str, type: PouType = PouType.FunctionBlock, return_type: str | None = None) -> Node:
        if (type is PouType.Function) != (return_type is not None):
            raise Refused(f"{name}: a return type is required for functions, and not allowed for other types")
        return self._add(Pou(name, type.name))

    def create_dut(self, name: str, type: DutType = DutType.Structure) -> Node:
        return self._add(Dut(name, type.name))

    def create_interface(self, name: str, baseInterfaces: str = "__System.IQueryInterface") -> Node:
        made = Interface(name, "INTERFACE")
        made.textual_declaration.text = f"INTERFACE {name} EXTENDS {baseInterfaces}"
        return self._add(made)

    def create_gvl(self, name: str) -> Node:
        made = GlobalVariables(name, "VAR_GLOBAL")
        made.textual_declaration.text = "VAR_GLOBAL\nEND_VAR"
        return self._add(made)


class Node(Tree):
    parent: Tree

    def __init__(self, name: str, kind: str) -> None:
        super().__init__()
        if not name.isidentifier() or not name.isascii():
            raise Refused(f"{name} is no identifier")
        self._name, self.kind = name, kind

    def get_name(self) -> str:
        return self._name

    def remove(self) -> None:
        self.parent._children.remove(self)


class Folder(Node, Container):
    """A folder of the POUs view."""


class Dut(Node):
    """A data type: it has a declaration alone."""

    def __init__(self, name: str, kind: str) -> None:
        super().__init__(name, kind)
        self.textual_declaration = Document()


class GlobalVariables(Dut):
    """A list of global variables: the name of the object is the name of the list."""


class Interface(Dut):
    """An interface: its methods are declarations alone."""

    def create_method(self, name: str, return_type: str | None = None) -> Node:
        return self._add(Dut(name, "METHOD"))


class Code(Dut):
    def __init__(self, name: str, kind: str) -> None:
        super().__init__(name, kind)
        self.textual_implementation = Document()


class Property(Dut):
    """A property comes with two accessors."""

    def __init__(self, name: str, kind: str) -> None:
        super().__init__(name, kind)
        for accessor in ("Get", "Set"):
            self._add(Code(accessor, accessor)).textual_declaration.text = "VAR\nEND_VAR"  # type: ignore[attr-defined]


class Pou(Code):
    """A program, function block or function; a function has no members."""

    def create_method(self, name: str, return_type: str | None = None) -> Node:
        self._refuse_member(name)
        return self._add(Code(name, "METHOD"))

    def create_property(self, name: str, return_type: str = "int") -> Node:
        self._refuse_member(name)
        return self._add(Property(name, "PROPERTY"))

    def _refuse_member(self, name: str) -> None:
        if self.kind == "Function":
            raise Refused(f"{name}: methods cannot be added to functions")


class Message:
    def __init__(self, severity: Severity, text: str, node: Any = None) -> None:
        self.severity, self.text, self._node = severity, text, node
        self.prefix, self.number = "C", 32

    @property
    def object(self) -> Any:
        if self._node is None:
            raise Refused("the object GUID is not valid")
        return self._node


class LibraryManager(Node):
    def __init__(self) -> None:
        super().__init__("Library_Manager", "libman")
        self.placeholders: dict[str, Any] = {}

    def add_placeholder(self, name: str, default_resolution: Any) -> None:
        self.placeholders[name] = default_resolution


class Project(Container):
    def __init__(self, engine: Engine, path: str) -> None:
        super().__init__()
        self._engine, self.path, self.is_saved = engine, path, False
        self.information = types.SimpleNamespace()
        self.external_files: dict[str, bytes] = {}

    def create_external_file_object(self, file_path: str, name: str | None = None) -> None:
        """Embed a file, under its own name where none is given."""
        called = name or Path(file_path).name
        if called in self.external_files:
            raise Refused(f"an external file {called} already exists")
        self.external_files[called] = Path(file_path).read_bytes()

    def get_library_manager(self) -> LibraryManager:
        found = [one for one in self._children if isinstance(one, LibraryManager)]
        return found[0] if found else self._add(LibraryManager())  # type: ignore[return-value]

    def get_project_info(self) -> types.SimpleNamespace:
        return self.information

    def check_all_pool_objects(self) -> None:
        if self._engine.projects.primary is not self:
            raise Refused("this works for primary projects alone")
        self._engine.categories[BUILD] = list(self._compiled())

    def save(self) -> None:
        Path(self.path).write_text("library", encoding="utf-8")
        self.is_saved = True

    def _compiled(self) -> Iterator[Message]:
        wholes = (Pou, Interface, GlobalVariables)
        nodes = [one for one in self.get_children(True) if isinstance(one, wholes) or _is_type(one)]
        try:
            compile_st({one.get_name(): composed(one) for one in nodes})
        except StError as problem:
            yield Message(Severity.Error, str(problem))
        yield from self._engine.further
        yield Message(Severity.Information, "Compile complete", self)

    def get_name(self) -> str:
        return Path(self.path).stem


def _is_type(node: Node) -> TypeGuard[Dut]:
    return type(node) is Dut and node.kind != "METHOD"


def composed(node: Dut) -> str:
    """An object with its members as one text."""
    declared = node.textual_declaration.text
    if isinstance(node, Interface):
        methods = (f"{one.textual_declaration.text}\nEND_METHOD" for one in node.get_children() if isinstance(one, Dut))
        return "\n".join((declared, *methods, "END_INTERFACE"))
    if isinstance(node, Property):
        (getter,) = (one for one in node.get_children() if one.get_name() == "Get")
        assert isinstance(getter, Code)
        return f"{declared}\nGET\n{getter.textual_implementation.text}\nEND_GET\nEND_PROPERTY"
    if not isinstance(node, Code):
        return declared
    inner = "\n".join(composed(one) for one in node.get_children() if isinstance(one, Dut))
    endings = {"METHOD": "METHOD", "Function": "FUNCTION", "FunctionBlock": "FUNCTION_BLOCK", "Program": "PROGRAM"}
    return f"{declared}\n{inner}\n{node.textual_implementation.text}\nEND_{endings[node.kind]}"


class Engine(types.ModuleType):
    """The module `scriptengine`, with the objects it is filled with."""

    PouType, DutType, Severity = PouType, DutType, Severity

    def __init__(self, titles: tuple[str, ...], answer: str | None = None) -> None:
        super().__init__("scriptengine")
        self.categories: dict[str, list[Message]] = {SCRIPT: [Message(Severity.Text, "printed by a script")]}
        self.made: list[Project] = []
        self.further: list[Message] = []
        """What the compiler says besides."""
        self.projects = types.SimpleNamespace(primary=None, create=self._create)
        self.library_manager = types.SimpleNamespace(get_all_libraries=lambda: _libraries(titles))
        dialog = types.SimpleNamespace(save_file_dialog=lambda **_: answer)
        self.system = types.SimpleNamespace(
            ui_present=answer is not None,
            ui=dialog,
            get_message_categories=lambda: list(self.categories)[:1],  # as in a library project: too few
            get_message_objects=self._messages,
            clear_messages=lambda category: self.categories[category].clear(),
        )

    def _create(self, path: str, primary: bool = True) -> Project:
        made = Project(self, path)
        self.made.append(made)
        if primary:
            self.projects.primary = made
        return made

    def _messages(self, category: str) -> list[Message]:
        by_guid = {guid.upper(): messages for guid, messages in self.categories.items()}
        if category.upper() not in by_guid:
            raise Refused("Value cannot be null. Parameter name: category")
        return list(by_guid[category.upper()])


def _libraries(titles: tuple[str, ...]) -> tuple[Any, ...]:
    versions = ((4, 9, 0, 0), (4, 20, 0, 0), (4, 11, 0, 0))
    others = ("Standard", *titles)
    return tuple(types.SimpleNamespace(title=t, version=v, company="CODESYS") for t in others for v in versions)
