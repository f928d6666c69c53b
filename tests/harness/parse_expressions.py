"""Expressions: from the grammar's nodes to the syntax tree."""

from collections.abc import Callable

from tree_sitter import Node

from . import ast
from .syntax import Tree, field, fields, named


def expression(tree: Tree, node: Node) -> ast.Expression:
    reader = _READERS.get(node.type)
    if reader is None:
        raise tree.refuse(node, f"{node.type} is not part of the dialect: {tree.text(node)[:40]!r}")
    return reader(tree, node)


def _parenthesized(tree: Tree, node: Node) -> ast.Expression:
    return expression(tree, named(node)[0])


def _integer(tree: Tree, node: Node) -> ast.Expression:
    digits = tree.text(node).replace("_", "").replace(" ", "")
    if "#" in digits:
        base, digits = digits.split("#")
        return ast.Literal(int(digits, int(base)), tree.at(node))
    return ast.Literal(int(digits), tree.at(node))


def _real(tree: Tree, node: Node) -> ast.Expression:
    digits = tree.text(node).replace("_", "").replace(" ", "")
    if "." not in digits:
        raise tree.refuse(node, f"the real literal {digits} needs a decimal point")
    if float(digits) in (float("inf"), float("-inf")):
        raise tree.refuse(node, f"the real literal {digits} is too large")
    return ast.Literal(float(digits), tree.at(node))


def _boolean(tree: Tree, node: Node) -> ast.Expression:
    return ast.Literal(tree.text(node).upper() == "TRUE", tree.at(node))


def _string(tree: Tree, node: Node) -> ast.Expression:
    text = tree.text(node)
    if not text.startswith("'"):
        raise tree.refuse(node, "only strings in single quotes are part of the dialect")
    return ast.Literal(text[1:-1].replace("$'", "'").replace("$$", "$"), tree.at(node))


def _name(tree: Tree, node: Node) -> ast.Expression:
    return ast.Name(tree.text(node), tree.at(node))


def _member(tree: Tree, node: Node) -> ast.Expression:
    owner = expression(tree, field(node, "object"))
    return ast.Member(owner, tree.text(field(node, "member")), tree.at(node))


def _qualified(tree: Tree, node: Node) -> ast.Expression:
    first, *rest = named(node)
    found = _name(tree, first)
    for part in rest:
        found = ast.Member(found, tree.text(part), tree.at(node))
    return found


def _index(tree: Tree, node: Node) -> ast.Expression:
    indices = tuple(expression(tree, child) for child in fields(node, "index"))
    return ast.Index(expression(tree, field(node, "object")), indices, tree.at(node))


def _dereference(tree: Tree, node: Node) -> ast.Expression:
    pointer = field(node, "pointer")
    if pointer.type == "this_expression":
        return ast.This(tree.at(node))
    if pointer.type == "super_expression":
        return ast.Super(tree.at(node))
    return ast.Dereference(expression(tree, pointer), tree.at(node))


def _address(tree: Tree, node: Node) -> ast.Expression:
    return ast.AddressOf(expression(tree, field(node, "operand")), tree.at(node))


def _unary(tree: Tree, node: Node) -> ast.Expression:
    operator = tree.text(field(node, "operator")).upper()
    return ast.Unary(operator, expression(tree, field(node, "operand")), tree.at(node))


def _binary(tree: Tree, node: Node) -> ast.Expression:
    operator = tree.text(field(node, "operator")).upper()
    left = expression(tree, field(node, "left"))
    right = expression(tree, field(node, "right"))
    return ast.Binary("AND" if operator == "&" else operator, left, right, tree.at(node))


def call(tree: Tree, node: Node) -> ast.Call:
    function = expression(tree, field(node, "function"))
    arguments = node.child_by_field_name("arguments")
    given = () if arguments is None else tuple(_argument(tree, child) for child in named(arguments))
    return ast.Call(function, given, tree.at(node))


def _argument(tree: Tree, node: Node) -> ast.Argument:
    if node.type != "named_argument":
        return ast.Argument(None, expression(tree, node), False, tree.at(node))
    is_output = any(child.type == "=>" for child in node.children)
    value = expression(tree, field(node, "value"))
    return ast.Argument(tree.text(field(node, "name")), value, is_output, tree.at(node))


_READERS: dict[str, Callable[[Tree, Node], ast.Expression]] = {
    "parenthesized_expression": _parenthesized, "integer_literal": _integer, "real_literal": _real,
    "boolean_literal": _boolean, "string_literal": _string, "identifier": _name, "qualified_identifier": _qualified,
    "member_access_expression": _member, "index_expression": _index, "dereference_expression": _dereference,
    "address_of_expression": _address, "unary_expression": _unary, "binary_expression": _binary,
    "call_expression": call,
}  # fmt: skip
