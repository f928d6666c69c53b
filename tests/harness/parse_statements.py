"""Statements: from the grammar's nodes to the syntax tree."""

from collections.abc import Callable, Iterable

from tree_sitter import Node

from . import ast
from .parse_expressions import call, expression
from .syntax import Tree, field, fields, named


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


def _assign(tree: Tree, node: Node) -> ast.Statement:
    target = expression(tree, field(node, "left"))
    return ast.Assign(target, expression(tree, field(node, "right")), tree.at(node))


def _call(tree: Tree, node: Node) -> ast.Statement:
    return ast.CallStatement(call(tree, named(node)[0]), tree.at(node))


def _else_of(tree: Tree, node: Node) -> tuple[ast.Statement, ...]:
    for clause in named(node):
        if clause.type == "else_clause":
            return body(tree, clause)
    return ()


def _if(tree: Tree, node: Node) -> ast.Statement:
    branches = [ast.Branch(expression(tree, field(node, "condition")), body(tree, node, "consequence"))]
    for clause in named(node):
        if clause.type == "elsif_clause":
            condition = expression(tree, field(clause, "condition"))
            branches.append(ast.Branch(condition, body(tree, clause)))
    return ast.If(tuple(branches), _else_of(tree, node), tree.at(node))


def _label(tree: Tree, node: Node) -> ast.Label:
    value = named(node)[0]
    if value.type == "subrange":
        lower, upper = expression(tree, field(value, "lower")), expression(tree, field(value, "upper"))
        return ast.Label(lower, upper, tree.at(node))
    return ast.Label(expression(tree, value), None, tree.at(node))


def _case(tree: Tree, node: Node) -> ast.Statement:
    branches = []
    for clause in named(node):
        if clause.type == "case_clause":
            labels = tuple(_label(tree, c) for c in named(clause) if c.type == "case_value")
            branches.append(ast.CaseBranch(labels, body(tree, clause)))
    subject = expression(tree, field(node, "subject"))
    return ast.Case(subject, tuple(branches), _else_of(tree, node), tree.at(node))


def _for(tree: Tree, node: Node) -> ast.Statement:
    step = node.child_by_field_name("step")
    return ast.For(
        expression(tree, field(node, "control")),
        expression(tree, field(node, "start")),
        expression(tree, field(node, "end")),
        None if step is None else expression(tree, step),
        body(tree, node),
        tree.at(node),
    )


def _while(tree: Tree, node: Node) -> ast.Statement:
    return ast.While(expression(tree, field(node, "condition")), body(tree, node), tree.at(node))


_READERS: dict[str, Callable[[Tree, Node], ast.Statement]] = {
    "assignment_statement": _assign,
    "invocation_statement": _call,
    "if_statement": _if,
    "case_statement": _case,
    "for_statement": _for,
    "while_statement": _while,
    "exit_statement": lambda tree, node: ast.Exit(tree.at(node)),
    "return_statement": lambda tree, node: ast.Return(tree.at(node)),
}
