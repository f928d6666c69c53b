"""Types as written, variable sections and structure fields."""

import re

from tree_sitter import Node

from . import ast
from .parse_expressions import expression, part
from .pieces import comment_text
from .syntax import Tree, field, fields, named

_STRING_RESULT = re.compile(r"STRING_(\d+)_\Z")
_DEFAULT_STRING_LENGTH = 80  # what STRING without a length means


def type_text(tree: Tree, node: Node) -> ast.TypeText:
    text, at = tree.text(node), tree.at(node)
    if node.type == "string_type":
        length = node.child_by_field_name("length")
        known = _DEFAULT_STRING_LENGTH if length is None else int(tree.text(length))
        return ast.StringText(text, known, at=at)
    if match := _STRING_RESULT.match(text):
        return ast.StringText(f"STRING({match.group(1)})", int(match.group(1)), at=at)
    if node.type == "array_type":
        bounds = tuple((part(tree, one, "lower"), part(tree, one, "upper")) for one in fields(node, "range"))
        return ast.ArrayText(text, bounds, type_text(tree, field(node, "element_type")), at=at)
    if node.type == "pointer_type":
        return ast.PointerText(text, type_text(tree, field(node, "target")), at=at)
    if node.type in ("identifier", "qualified_identifier", "elementary_type"):
        return ast.NamedType(text, at=at)
    raise tree.refuse(node, f"type {text!r} is not part of the dialect")


def _initial(tree: Tree, nodes: list[Node]) -> ast.Expression | None:
    if not nodes:
        return None
    if len(nodes) == 1 and nodes[0].type not in ("array_repetition", "array_literal"):
        return expression(tree, nodes[0])
    values: list[ast.Expression] = []
    for node in nodes:
        if node.type == "array_repetition":
            count_node = field(node, "count")
            value = next(child for child in named(node) if child != count_node)
            values.extend([expression(tree, value)] * int(tree.text(count_node)))
        else:
            values.append(expression(tree, node))
    return ast.ArrayValues(tuple(values), at=tree.at(nodes[0]))


def variables(tree: Tree, parent: Node, kind: str, initial: str) -> tuple[ast.VariableDeclaration, ...]:
    """The declarations of a section or structure, each with the pragmas and comments at it.

    A comment belongs to the declaration it follows on the same line, otherwise to the next one.
    """
    found: list[tuple[Node, list[str], list[str]]] = []
    pragmas: list[str] = []
    comments: list[str] = []
    for child in parent.named_children:
        if child.type == "pragma":
            pragmas.append(tree.text(child))
        elif child.type == "comment":
            same_line = found and found[-1][0].end_point[0] == child.start_point[0]
            (found[-1][2] if same_line else comments).append(tree.text(child))
        elif child.type == kind:
            # In a structure the grammar puts the pragmas into the field itself.
            pragmas += [tree.text(part) for part in child.named_children if part.type == "pragma"]
            found.append((child, pragmas, comments))
            pragmas, comments = [], []
    return tuple(
        declaration
        for child, its_pragmas, its_comments in found
        for declaration in _declared(tree, child, initial, tuple(its_pragmas), comment_text(its_comments))
    )


def _declared(
    tree: Tree, node: Node, initial: str, pragmas: tuple[str, ...], comment: str
) -> list[ast.VariableDeclaration]:
    if node.child_by_field_name("address") is not None:
        raise tree.refuse(node, "AT addresses are not part of the dialect")
    names = fields(node, "names") or fields(node, "name")
    declared_type = type_text(tree, field(node, "type"))
    value = _initial(tree, fields(node, initial))
    return [
        ast.VariableDeclaration(tree.text(name), declared_type, value, pragmas, comment, at=tree.at(name))
        for name in names
    ]


_SECTIONS = {
    "var_block": "VAR",
    "var_input": "VAR_INPUT",
    "var_output": "VAR_OUTPUT",
    "var_in_out": "VAR_IN_OUT",
    "var_global": "VAR_GLOBAL",
}


def sections(tree: Tree, node: Node) -> tuple[ast.Section, ...]:
    return tuple(
        ast.Section(
            _SECTIONS[child.type],
            _is_constant(tree, child),
            variables(tree, child, "variable_declaration", "initial_value"),
        )
        for child in named(node)
        if child.type in _SECTIONS
    )


def _is_constant(tree: Tree, section: Node) -> bool:
    for child in named(section):
        if child.type == "var_qualifier_list":
            if tree.text(child).strip().upper() != "CONSTANT":
                raise tree.refuse(child, f"{tree.text(child)} is not part of the dialect")
            return True
    return False
