"""Objects of a text: from the grammar's nodes to declarations."""

from collections.abc import Callable, Iterable
from typing import Any

from tree_sitter import Node

from . import ast
from .lexical import refuse_words
from .parse_expressions import call, expression, part, reader
from .parse_variables import sections, type_text, variables
from .pieces import Piece, split
from .syntax import NO_RESULT, Tree, field, fields, grow, named


def statements(tree: Tree, nodes: Iterable[Node]) -> tuple[ast.Statement, ...]:
    """Empty statements vanish: `END_IF;` and `END_IF` mean the same."""
    return tuple(_statement(tree, node) for node in nodes if node.type != "empty_statement")


def body(tree: Tree, node: Node, name: str = "body") -> tuple[ast.Statement, ...]:
    return statements(tree, fields(node, name))


def _statement(tree: Tree, node: Node) -> ast.Statement:
    reader = _READERS.get(node.type)
    if reader is None:
        raise tree.refuse(node, f"{node.type} is not part of the dialect")
    return reader(tree, node)


def _call(tree: Tree, node: Node) -> ast.Statement:
    return ast.CallStatement(call(tree, named(node)[0]), at=tree.at(node))


def _else_of(tree: Tree, node: Node) -> tuple[ast.Statement, ...]:
    for clause in named(node):
        if clause.type == "else_clause":
            return body(tree, clause)
    return ()


def _if(tree: Tree, node: Node) -> ast.Statement:
    branches = [ast.Branch(part(tree, node, "condition"), body(tree, node, "consequence"))]
    for clause in named(node):
        if clause.type == "elsif_clause":
            condition = part(tree, clause, "condition")
            branches.append(ast.Branch(condition, body(tree, clause)))
    return ast.If(tuple(branches), _else_of(tree, node), at=tree.at(node))


def _case(tree: Tree, node: Node) -> ast.Statement:
    branches = []
    for clause in named(node):
        if clause.type == "case_clause":
            labels = tuple(expression(tree, named(c)[0]) for c in named(clause) if c.type == "case_value")
            branches.append(ast.CaseBranch(labels, body(tree, clause)))
    subject = part(tree, node, "subject")
    return ast.Case(subject, tuple(branches), _else_of(tree, node), at=tree.at(node))


def _step(tree: Tree, node: Node, name: str) -> ast.Expression | None:
    return None if node.child_by_field_name(name) is None else part(tree, node, name)


_READERS: dict[str, Callable[[Tree, Node], ast.Statement]] = {
    "assignment_statement": reader(ast.Assign, left=part, right=part),
    "invocation_statement": _call,
    "if_statement": _if,
    "case_statement": _case,
    "for_statement": reader(ast.For, control=part, start=part, end=part, step=_step, body=body),
    "exit_statement": reader(ast.Exit),
    "return_statement": reader(ast.Return),
}


def parse(text: str, file: str) -> list[ast.Declaration]:
    refuse_words(text, file)
    return [declaration for piece in split(text, file) for declaration in _object(piece, file)]


def _object(piece: Piece, file: str) -> list[ast.Declaration]:
    tree = grow(piece, file)
    node = named(tree.root)[0]
    if piece.kind == "TYPE":
        return [_type(tree, child, piece) for child in named(node)]
    if piece.kind == "VAR_GLOBAL":
        name = file.rsplit("/", 1)[-1].removesuffix(".st")
        return [
            ast.Globals(*_head(tree, node, piece, piece.kind, name), section.constant, section.variables)
            for section in sections(tree, node)
        ]
    if piece.kind == "FUNCTION":
        return [_routine(tree, node, piece, "FUNCTION")]
    if piece.kind == "INTERFACE":
        return [_interface(tree, node, piece, file)]
    return [_block(tree, node, piece, file)]


def _head(tree: Tree, node: Node, piece: Piece, kind: str, name: str = "") -> tuple[Any, ...]:
    """What every object has: its kind, its name, its pragmas, its comment and its place."""
    return kind, name or tree.text(field(node, "name")), piece.pragmas, piece.comment, tree.at(node)


def _type(tree: Tree, node: Node, piece: Piece) -> ast.Declaration:
    name, definition = tree.text(field(node, "name")), field(node, "definition")
    if definition.type == "structure_type_inline":
        fields = variables(tree, definition, "structure_field", "default")
        return ast.Structure(*_head(tree, node, piece, "STRUCT", name), fields)
    if definition.type != "enumerated_type_inline":
        raise tree.refuse(node, f"{definition.type} is not part of the dialect")
    if node.child_by_field_name("default") is not None:
        raise tree.refuse(node, "a default of an enumeration is not part of the dialect")
    members = tuple(_enumerator(tree, child) for child in named(definition))
    return ast.Enumeration(*_head(tree, node, piece, "ENUM", name), members)


def _enumerator(tree: Tree, node: Node) -> tuple[str, int | None]:
    value = node.child_by_field_name("value")
    return tree.text(field(node, "name")), None if value is None else int(tree.text(value))


def _access(tree: Tree, node: Node) -> str:
    for child in node.children:
        if child.type in ("PUBLIC", "PRIVATE", "PROTECTED"):
            return child.type
    return ""


def _routine(tree: Tree, node: Node, piece: Piece, kind: str) -> ast.Routine:
    written = node.child_by_field_name("return_type")
    returns = None if written is None or tree.text(written) == NO_RESULT else type_text(tree, written)
    head = _head(tree, node, piece, kind)
    return ast.Routine(*head, _access(tree, node), returns, sections(tree, node), body(tree, node))


def _property(tree: Tree, node: Node, piece: Piece) -> ast.PropertyDeclaration:
    name, access = tree.text(field(node, "name")), _access(tree, node)
    returns = type_text(tree, field(node, "type"))
    accessors = [child for child in named(node) if child.type == "property_accessor"]
    if len(accessors) != 1 or not tree.text(accessors[0]).upper().startswith("GET"):
        raise tree.refuse(node, f"property {name} must have a GET part and nothing else")
    accessor = accessors[0]
    head = "GET", name, (), "", tree.at(accessor)
    getter = ast.Routine(*head, access, returns, sections(tree, accessor), body(tree, accessor))
    return ast.PropertyDeclaration(name, access, returns, getter, piece.pragmas, piece.comment, at=tree.at(node))


def _interface(tree: Tree, node: Node, piece: Piece, file: str) -> ast.Interface:
    methods = []
    for member in piece.members:
        method = _routine(*_wrapped(member, file), member, "METHOD")
        if member.kind != "METHOD" or method.body or method.access:
            raise tree.refuse(node, f"{method.name} must be a method without a body and without an access")
        methods.append(method)
    extends = tuple(tree.text(child) for child in fields(node, "extends"))
    return ast.Interface(*_head(tree, node, piece, piece.kind), extends, tuple(methods))


def _wrapped(member: Piece, file: str) -> tuple[Tree, Node]:
    """The tree of a member, and its node: that after the name of the wrapping block."""
    tree = grow(member, file)
    return tree, named(named(tree.root)[0])[1]


def _block(tree: Tree, node: Node, piece: Piece, file: str) -> ast.Block:
    methods: list[ast.Routine] = []
    properties: list[ast.PropertyDeclaration] = []
    for member in piece.members:
        member_tree, member_node = _wrapped(member, file)
        if member.kind == "METHOD":
            methods.append(_routine(member_tree, member_node, member, "METHOD"))
        else:
            properties.append(_property(member_tree, member_node, member))
    extends = node.child_by_field_name("extends")
    return ast.Block(
        *_head(tree, node, piece, piece.kind),
        None if extends is None else tree.text(extends),
        tuple(tree.text(child) for child in fields(node, "implements")),
        sections(tree, node),
        tuple(methods),
        tuple(properties),
        body(tree, node),
    )
