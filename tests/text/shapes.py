"""The shapes of a text for a grammar: it is taken apart phrase by phrase, each shape stands once, `n` for a name.

To a context-free grammar an operand, an argument, a statement is the same wherever it stands: one that is known gives
way to a name, or to an empty statement. What is wrong is no phrase, gives way to nothing, and is left for the grammar.
"""

import re
from functools import cache

_TOKENS = re.compile(r"'[^'\n]*'|\d[\d.]*(?:E-?\d+)?|[A-Za-z_]\w*|:=|=>|<=|>=|<>|\S")
_WORDS = r"(?!(?:IF|THEN|ELSIF|ELSE|END_\w+|FOR|TO|BY|DO|CASE|OF|RETURN|EXIT|NOT|AND|OR|XOR|MOD)\b)"
_BEHIND, _WHOLE = r"(?! :=)", r"(?! [(\[.^]| :=)"
"""Nothing is assigned to the operand; it has no field, index or arguments, either."""
_ARGUMENT = r"(?:n (?::=|=>) )?n"
_CALL = rf"(?<!\S){_WORDS}\w+ \( (?:{_ARGUMENT}(?: , {_ARGUMENT})* )?\)"
_OPERATORS = (r"\*|/|MOD", r"\+|-", "<|<=|>|>=", "=|<>", "AND", "XOR", "OR")
_EXPRESSIONS = tuple(map(re.compile, (
    rf"(?<!\S)(?:''|0[0.]*(?:E-?0)?)(?!\S| :(?!\S)){_BEHIND}",
    rf"(?<!\S){_WORDS}[A-Z_][A-Z_\d]+(?!\S| \(){_BEHIND}",
    r"\bn \. n\b",
    r"\bn \^",
    r"\bn \[ n(?: , n)* \]",
    rf"{_CALL}{_BEHIND}",
    rf"(?<!\bn )\( n \){_BEHIND}",
    rf"(?<!n )(?<![)\]] )- n\b{_WHOLE}",
    rf"\bNOT n\b{_WHOLE}",
    *(rf"(?<!^)(?<! : )\bn (?:{operators}) n\b{_WHOLE}" for operators in _OPERATORS),
)))  # fmt: skip
_STATEMENTS = tuple(map(re.compile, (
    r"(?<!\S)(?:n := n|RETURN|EXIT) ;",
    r"(?<!\S)IF n THEN ; (?:ELSIF n THEN ; )?(?:ELSE ; )?END_IF(?: ;)?",
    r"(?<!\S)FOR n := n TO n (?:BY n )?DO ; END_FOR(?: ;)?",
    r"(?<!\S)CASE n OF (?:\w+ : ; )+(?:ELSE ; )?END_CASE(?: ;)?",
)))  # fmt: skip
_CALLED = re.compile(rf"(?:^|(?<= : )){_CALL} ;")
_BETWEEN = re.compile(
    r"(?<= ;) |(?<=\bTHEN) |(?<=\bELSE) |(?<=\bDO) |(?<=\bOF) |(?:(?<=\bEND_IF)|(?<=\bEND_FOR)|(?<=\bEND_CASE)) (?!;)"
)
_REPEATED = re.compile(r"(?<!\S)(; |ELSIF n THEN ; |0 : ; )\1+")
_ALIKE = re.compile(r"((?:- )?[\w.]+(?: :=| =>)?(?: n)?)(?: , \1){3,}")
"""Arguments, variables or values of one kind: three stand for all."""
_VALUES = re.compile(r"(?<=:= \[ )[^\[\]]*(?= \])")
_SECTION = re.compile(r"^[ ]*(VAR(?:_[A-Z_]+)?(?: CONSTANT)?)\b(.*?)^[ ]*END_VAR", re.MULTILINE | re.DOTALL)
_FRAME = re.compile(r"METHOD|FUNCTION|PROGRAM|PROPERTY|GET|END_(?!IF|FOR|CASE)|\{|TRAFO\.")


def shapes(text: str) -> tuple[str, set[str]]:
    """A method, a property, a function or a block without what gives way; and that, as methods."""
    known, frame, body = set[str](), list[str](), list[str]()
    code = re.sub(r"//[^\n]*|\(\*.*?\*\)", "", text, flags=re.DOTALL)
    for section, variables in _SECTION.findall(code):
        for variable in filter(None, map(_same, variables.split(";"))):
            known.add(method(f"{section}\n{_VALUES.sub(_different, _few(variable))} ;\nEND_VAR"))
    for line in [*filter(None, map(str.strip, _SECTION.sub(r"\1\nEND_VAR", code).split("\n"))), "END_"]:
        if line.startswith("VAR") or _FRAME.match(line):
            left, statements = _statements(_same(" ".join(body)))
            known |= {method(statement) for statement in statements}
            frame, body = [*frame, left, _same(line)], []
        else:
            body.append(line)
    return "\n".join(filter(None, frame[:-1])).replace(" . ", "."), known


def method(code: str) -> str:
    return f"METHOD n : BOOL\n{code}\nEND_METHOD".replace(" . ", ".")


def names(text: str) -> set[str]:
    code = re.sub(r"//[^\n]*|'[^'\n]*'", "", text)
    return {word for word in re.findall(r"\b[A-Za-z_]\w*", code) if _same(word) == "n"}


def _same(text: str) -> str:
    """The text with every name, number and string made the same, and blanks around them; keywords and types stay."""
    same = (
        "''" if token[0] == "'" else re.sub(r"\d+", "0", token) if token[0].isdigit() else
        "n" if re.match(r"[A-Za-z_]", token) and not (token.isupper() and len(token) > 1) else token
        for token in _TOKENS.findall(text)
    )  # fmt: skip
    return " ".join(same)


def _few(text: str) -> str:
    return _ALIKE.sub(r"\1 , \1 , \1", text)


def _different(values: re.Match[str]) -> str:
    return " , ".join(dict.fromkeys(values[0].split(" , ")))


def _statements(text: str) -> tuple[str, set[str]]:
    """What is left of statements, an empty one where all is right; and the shapes of the others."""
    parts = [_expressions(part) for part in _BETWEEN.split(text)]
    left, before = "".join(f"{part} " for part, _ in parts), ""
    known = set[str]().union(*(found for _, found in parts))
    while left != before:
        before = left
        for pattern in _STATEMENTS:
            known.update(pattern.findall(left))
            left = _REPEATED.sub(r"\1", pattern.sub(";", left))
    return left.strip(), known


@cache
def _expressions(statement: str) -> tuple[str, frozenset[str]]:
    """A statement with names for its expressions; and these, each as an assignment."""
    known, count = set[str](), 1
    while count:
        statement, count = _few(statement), 0
        if call := _CALLED.search(statement):
            known.add(call[0])
            statement = _CALLED.sub(";", statement)
        for pattern in _EXPRESSIONS:
            known.update(f"n := {phrase} ;" for phrase in pattern.findall(statement))
            statement, count = pattern.subn("n", statement)
            if count:
                break
    return statement, frozenset(known)
