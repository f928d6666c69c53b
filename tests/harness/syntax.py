"""Run the first grammar over one piece and report the first place it cannot read."""

import re
from dataclasses import dataclass

import tree_sitter_iec61131_3_st as structured_text
from tree_sitter import Language, Node, Parser

from .faults import Place, StError
from .pieces import Piece

_PARSER = Parser(Language(structured_text.language()))

# The grammar knows no length of a STRING as return type and no FUNCTION without one; both are
# rewritten to a name of its own. It wants a semicolon after END_STRUCT, where CODESYS has none.
NO_RESULT = "Softkin_NoResult"
_STRING_RESULT = re.compile(r"\A((?:METHOD|FUNCTION)\b[^\n;]*:\s*)STRING\((\d+)\)", re.IGNORECASE)
_BARE_FUNCTION = re.compile(r"\AFUNCTION\s+(\w+)[ \t]*(?=\n|\(\*|//|VAR)", re.IGNORECASE)
_END_STRUCT = re.compile(r"\bEND_STRUCT\b(?!\s*;)", re.IGNORECASE)


def normalised(text: str) -> str:
    """The text in the words of the grammar, line by line as before."""
    text = _END_STRUCT.sub("END_STRUCT;", text) if text[:4].upper() == "TYPE" else text
    text = _STRING_RESULT.sub(r"\1STRING_\2_", text)
    return _BARE_FUNCTION.sub(lambda m: f"{m.group().rstrip()} : {NO_RESULT} ", text)


@dataclass(frozen=True, slots=True)
class Tree:
    """A parsed piece: how to get the text and the place of a node."""

    source: bytes
    file: str
    first_line: int
    root: Node

    def text(self, node: Node) -> str:
        return self.source[node.start_byte : node.end_byte].decode()

    def at(self, node: Node) -> Place:
        return Place(self.file, self.first_line + node.start_point[0])

    def refuse(self, node: Node, message: str) -> StError:
        return StError(self.at(node), message)


def grow(piece: Piece, file: str) -> Tree:
    """The tree of a piece; a member is wrapped into a block, for the grammar has no bare members."""
    text, first_line = normalised(piece.text), piece.line
    if piece.kind in ("METHOD", "PROPERTY"):
        text = f"FUNCTION_BLOCK Wrapped\n{text}\nEND_FUNCTION_BLOCK"
        first_line -= 1
    source = text.encode()
    tree = Tree(source, file, first_line, _PARSER.parse(source).root_node)
    if tree.root.has_error:
        raise _syntax_error(tree, tree.root)
    return tree


def _syntax_error(tree: Tree, node: Node) -> StError:
    if node.is_missing:
        return tree.refuse(node, f"missing {node.type!r}")
    inner = [child for child in node.children if child.has_error or child.is_missing]
    if node.type == "ERROR" and not inner:
        # What the grammar gives up on can be long; the mistake is often near its end.
        last = Place(tree.file, tree.first_line + node.end_point[0]).line
        return tree.refuse(node, f"syntax error at {tree.text(node)[:40]!r}, up to line {last}")
    return _syntax_error(tree, inner[0])


def named(node: Node) -> list[Node]:
    return [child for child in node.named_children if child.type not in ("comment", "pragma")]


def field(node: Node, name: str) -> Node:
    child = node.child_by_field_name(name)
    if child is None:
        raise ValueError(f"{node.type} has no {name}")
    return child


def fields(node: Node, name: str) -> list[Node]:
    """All children of a repeated field, without the commas and comments between them."""
    return [c for c in node.children_by_field_name(name) if c.is_named and c.type not in ("comment", "pragma")]
