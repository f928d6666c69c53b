"""All emitted files, and their blocks, compiled together."""

from functools import lru_cache

from derive.emit.st.contract import load
from tests.codesys.parts import FILES
from tests.harness import ast
from tests.harness.library import Library, compile_st

UNITS = [name for name in FILES if not name.startswith(("softkin/", "selftest/"))]
CONTRACT = load()


@lru_cache
def library() -> Library:
    """All units together: parsed, with their types, names, writes and interfaces checked."""
    return compile_st(FILES)


def blocks() -> dict[str, ast.Block]:
    """The function blocks of mechanisms by file."""
    found = {name.split("/")[-1].removesuffix(".st"): name for name in UNITS}
    return {found[d.name]: d for d in library().objects.values() if isinstance(d, ast.Block) and d.name in found}
