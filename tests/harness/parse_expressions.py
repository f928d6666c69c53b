"""Expressions: from the grammar's nodes to the syntax tree."""

from collections.abc import Callable
from typing import TypeVar

from tree_sitter import Node

from . import ast
from .syntax import Tree, field, fields, named

N = TypeVar("N")


def expression(tree: Tree, node: Node) -> ast.Expression:
    reader = _READERS.get(node.type)
    if reader is None:
        raise tree.refuse(node, f"{node.type} is not part of the dialect: {tree.text(node)[:40]!r}")
    return reader(tree, node)


def part(tree: Tree, node: Node, name: str) -> ast.Expression:
    return expression(tree, field(node, name))


def _parts(tree: Tree, node: Node, name: str) -> tuple[ast.Expression, ...]:
    return tuple(expression(tree, child) for child in fields(node, name))


def _word(tree: Tree, node: Node, name: str) -> str:
    return tree.text(field(node, name))


def _operator(tree: Tree, node: Node, name: str) -> str:
    written = _word(tree, node, name).upper()
    return "AND" if written == "&" else written


def reader(make: Callable[..., N], **read: Callable[[Tree, Node, str], object]) -> Callable[[Tree, Node], N]:
    """A reader of nodes whose parts are named fields of the grammar. read: how each is read, in the order of `make`."""
    return lambda tree, node: make(*(how(tree, node, name) for name, how in read.items()), at=tree.at(node))


def _parenthesized(tree: Tree, node: Node) -> ast.Expression:
    return expression(tree, named(node)[0])


def _integer(tree: Tree, node: Node) -> ast.Expression:
    digits = tree.text(node).replace("_", "").replace(" ", "")
    if "#" in digits:
        raise tree.refuse(node, f"the literal {digits} is not part of the dialect")
    return ast.Literal(int(digits), at=tree.at(node))


def _real(tree: Tree, node: Node) -> ast.Expression:
    digits = tree.text(node).replace("_", "").replace(" ", "")
    if "." not in digits:
        raise tree.refuse(node, f"the real literal {digits} needs a decimal point")
    if float(digits) in (float("inf"), float("-inf")):
        raise tree.refuse(node, f"the real literal {digits} is too large")
    return ast.Literal(float(digits), at=tree.at(node))


def _boolean(tree: Tree, node: Node) -> ast.Expression:
    return ast.Literal(tree.text(node).upper() == "TRUE", at=tree.at(node))


def _string(tree: Tree, node: Node) -> ast.Expression:
    text = tree.text(node)
    if not text.startswith("'"):
        raise tree.refuse(node, "only strings in single quotes are part of the dialect")
    return ast.Literal(text[1:-1].replace("$'", "'").replace("$$", "$"), at=tree.at(node))


def _name(tree: Tree, node: Node) -> ast.Name:
    return ast.Name(tree.text(node), at=tree.at(node))


def _qualified(tree: Tree, node: Node) -> ast.Expression:
    first, *rest = named(node)
    found: ast.Expression = _name(tree, first)
    for name in rest:
        found = ast.Member(found, tree.text(name), at=tree.at(node))
    return found


def _dereference(tree: Tree, node: Node) -> ast.Expression:
    pointer = field(node, "pointer")
    if pointer.type == "this_expression":
        return ast.This(at=tree.at(node))
    if pointer.type == "super_expression":
        return ast.Super(at=tree.at(node))
    return ast.Dereference(expression(tree, pointer), at=tree.at(node))


def call(tree: Tree, node: Node) -> ast.Call:
    function = expression(tree, field(node, "function"))
    arguments = node.child_by_field_name("arguments")
    given = () if arguments is None else tuple(_argument(tree, child) for child in named(arguments))
    return ast.Call(function, given, at=tree.at(node))


def _argument(tree: Tree, node: Node) -> ast.Argument:
    if node.type != "named_argument":
        return ast.Argument(None, expression(tree, node), False, at=tree.at(node))
    is_output = any(child.type == "=>" for child in node.children)
    value = expression(tree, field(node, "value"))
    return ast.Argument(tree.text(field(node, "name")), value, is_output, at=tree.at(node))


_READERS: dict[str, Callable[[Tree, Node], ast.Expression]] = {
    "parenthesized_expression": _parenthesized, "integer_literal": _integer, "real_literal": _real,
    "boolean_literal": _boolean, "string_literal": _string, "identifier": _name, "qualified_identifier": _qualified,
    "member_access_expression": reader(ast.Member, object=part, member=_word),
    "index_expression": reader(ast.Index, object=part, index=_parts), "dereference_expression": _dereference,
    "address_of_expression": reader(ast.AddressOf, operand=part), "call_expression": call,
    "unary_expression": reader(ast.Unary, operator=_operator, operand=part),
    "binary_expression": reader(ast.Binary, operator=_operator, left=part, right=part),
}  # fmt: skip
