"""The second, independent grammar: blark's, written for another dialect of the same language.

It knows blocks, methods and properties only as separate sources, so a text is cut into those pieces.
One gap is bridged: inside a property it knows no GET … END_GET, so these two words are blanked.
Everything else, pragmas and comments included, goes in as it is written.
"""

import re
from functools import lru_cache

import lark
from blark.parse import new_parser  # type: ignore[import-untyped]

from .faults import Place, StError
from .pieces import Piece, split

_RULES = {
    "FUNCTION_BLOCK": "function_block_type_declaration",
    "FUNCTION": "function_declaration",
    "PROGRAM": "program_declaration",
    "TYPE": "data_type_declaration",
    "VAR_GLOBAL": "global_var_declarations",
    "INTERFACE": "interface_declaration",
    "METHOD": "function_block_method_declaration",
    "PROPERTY": "function_block_property_declaration",
}
Parsed = lark.Tree[lark.Token]
_GETTER_WORDS = re.compile(r"^(\s*)(?:GET|END_GET)[ ]*(?://.*)?$", re.IGNORECASE | re.MULTILINE)


@lru_cache
def _parser() -> lark.Lark:
    """The parser, which predicts for a name the rules of that name alone.

    Lark's has all rules that these lead to as well, which are predicted again when it is their turn: the trees are the
    same, in half the time.
    """
    parser: lark.Lark = new_parser(list(_RULES.values()))
    earley = parser.parser.parser
    earley.predictions = {
        name: [rule for rule in rules if rule.origin == name] for name, rules in earley.predictions.items()
    }
    return parser


def parse_with_blark(object_text: str, kind: str) -> Parsed:
    """Parse one piece: an object without its members, or one member. Raises lark.LarkError."""
    if kind == "PROPERTY":
        object_text = _GETTER_WORDS.sub(r"\1", object_text)
    return _parser().parse(object_text, start=_RULES[kind])


def parse_text_with_blark(text: str, file: str) -> dict[str, Parsed]:
    """Parse a whole text; the trees by the first line of each piece. Raises StError."""
    trees = {}
    for piece in split(text, file):
        for part in (piece, *piece.members):
            trees[part.text.split("\n", 1)[0]] = _parse_piece(part, file)
    return trees


def _parse_piece(piece: Piece, file: str) -> Parsed:
    try:
        return parse_with_blark(piece.text, piece.kind)
    except lark.UnexpectedInput as error:
        line = piece.line + max(error.line, 1) - 1
        raise StError(Place(file, line), "blark cannot parse this") from error
