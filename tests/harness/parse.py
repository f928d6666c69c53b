"""Objects of a text: from the grammar's nodes to declarations."""

from tree_sitter import Node

from . import ast
from .lexical import refuse_words
from .parse_statements import body
from .parse_variables import sections, type_text, variables
from .pieces import Piece, split
from .syntax import NO_RESULT, Tree, field, fields, grow, named


def parse(text: str, file: str) -> list[ast.Declaration]:
    """All declarations of a text in their order."""
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
            ast.Globals(
                piece.kind, name, section.constant, section.variables, piece.pragmas, piece.comment, tree.at(node)
            )
            for section in sections(tree, node)
        ]
    if piece.kind == "FUNCTION":
        return [_routine(tree, node, piece, "FUNCTION")]
    if piece.kind == "INTERFACE":
        return [_interface(tree, node, piece, file)]
    return [_block(tree, node, piece, file)]


def _type(tree: Tree, node: Node, piece: Piece) -> ast.Declaration:
    name, definition = tree.text(field(node, "name")), field(node, "definition")
    if definition.type == "structure_type_inline":
        fields = variables(tree, definition, "structure_field", "default")
        return ast.Structure("STRUCT", name, fields, piece.pragmas, piece.comment, tree.at(node))
    if definition.type != "enumerated_type_inline":
        raise tree.refuse(node, f"{definition.type} is not part of the dialect")
    if node.child_by_field_name("default") is not None:
        raise tree.refuse(node, "a default of an enumeration is not part of the dialect")
    members = tuple(_enumerator(tree, child) for child in named(definition))
    return ast.Enumeration("ENUM", name, members, piece.pragmas, piece.comment, tree.at(node))


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
    return ast.Routine(
        kind,
        tree.text(field(node, "name")),
        _access(tree, node),
        returns,
        sections(tree, node),
        body(tree, node),
        piece.pragmas,
        piece.comment,
        tree.at(node),
    )


def _property(tree: Tree, node: Node, piece: Piece) -> ast.PropertyDeclaration:
    name, access = tree.text(field(node, "name")), _access(tree, node)
    returns = type_text(tree, field(node, "type"))
    accessors = [child for child in named(node) if child.type == "property_accessor"]
    if len(accessors) != 1 or not tree.text(accessors[0]).upper().startswith("GET"):
        raise tree.refuse(node, f"property {name} must have a GET part and nothing else")
    accessor = accessors[0]
    getter = ast.Routine(
        "GET", name, access, returns, sections(tree, accessor), body(tree, accessor), (), "", tree.at(accessor)
    )
    return ast.PropertyDeclaration(name, access, returns, getter, piece.pragmas, piece.comment, tree.at(node))


def _interface(tree: Tree, node: Node, piece: Piece, file: str) -> ast.Interface:
    methods = []
    for member in piece.members:
        method = _routine(*_wrapped(member, file), member, "METHOD")
        if member.kind != "METHOD" or method.body or method.access:
            raise tree.refuse(node, f"{method.name} must be a method without a body and without an access")
        methods.append(method)
    return ast.Interface(
        piece.kind,
        tree.text(field(node, "name")),
        tuple(tree.text(child) for child in fields(node, "extends")),
        tuple(methods),
        piece.pragmas,
        piece.comment,
        tree.at(node),
    )


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
        piece.kind,
        tree.text(field(node, "name")),
        None if extends is None else tree.text(extends),
        tuple(tree.text(child) for child in fields(node, "implements")),
        sections(tree, node),
        tuple(methods),
        tuple(properties),
        body(tree, node),
        piece.pragmas,
        piece.comment,
        tree.at(node),
    )
