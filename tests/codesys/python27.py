"""The parts of a Python 3 source that are not Python 2.7: nodes of the syntax tree that 2.7 did not have."""

import ast
import io
import tokenize

# The nodes of Python 2.7's grammar by the names they have today.
_NODES = set(
    """
    Module FunctionDef ClassDef Return Delete Assign AugAssign For While If With Raise Try ExceptHandler Assert Import
    ImportFrom alias Global Expr Pass Break Continue BoolOp And Or BinOp Add Sub Mult Div Mod Pow LShift RShift BitOr
    BitXor BitAnd FloorDiv UnaryOp Invert Not UAdd USub Lambda IfExp Dict Set ListComp SetComp DictComp GeneratorExp
    comprehension Yield Compare Eq NotEq Lt LtE Gt GtE Is IsNot In NotIn Call keyword Constant Attribute Subscript Name
    List Tuple Load Store Del Slice arguments arg withitem
    """.split()
)
_NEWER_FIELDS = ("returns", "annotation", "cause", "kwonlyargs", "posonlyargs", "type_params", "is_async")


def beyond_python27(source: str) -> list[str]:
    """The places, with lines, that Python 2.7 would refuse or read differently; none for a source that is both."""
    tree = ast.parse(source)
    found = [_problem(node) for node in ast.walk(tree)]
    found += [
        f"line {t.start[0]}: {t.string}" for t in _tokens(source) if t.type == tokenize.NUMBER and "_" in t.string
    ]
    if not source.isascii() and "coding" not in "".join(source.split("\n")[:2]):
        found.append("letters that are not ASCII, without a line that says the coding")
    if not _imports_print(tree):
        found += [f"line {n.lineno}: print without its future import" for n in ast.walk(tree) if _is_call(n, "print")]
    return [problem for problem in found if problem]


def _problem(node: ast.AST) -> str:
    name, line = type(node).__name__, getattr(node, "lineno", 0)
    if name not in _NODES:
        return f"line {line}: {name}"
    newer = [field for field in _NEWER_FIELDS if getattr(node, field, None)]
    if isinstance(node, ast.ClassDef) and node.keywords:
        newer.append("keywords")
    if isinstance(node, ast.Dict) and None in node.keys:
        newer.append("unpacking")
    if isinstance(node, ast.Call) and _is_call(node, "super") and not node.args:
        newer.append("super without arguments")
    return f"line {line}: {name} with {', '.join(newer)}" if newer else ""


def _tokens(source: str) -> list[tokenize.TokenInfo]:
    return list(tokenize.generate_tokens(io.StringIO(source).readline))


def _imports_print(tree: ast.Module) -> bool:
    futures = [n for n in tree.body if isinstance(n, ast.ImportFrom) and n.module == "__future__"]
    return any(a.name == "print_function" for n in futures for a in n.names)


def _is_call(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name
