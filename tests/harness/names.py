"""Names that no text may declare: words of the language, and macros of the C code of a controller.

They are those of the compiler: one list, which a test compares with the standard and with what dialects add.
"""

import tomllib

from derive.emit.language import TEMPLATES

from .faults import Place, StError

_LISTS = tomllib.loads((TEMPLATES / "st" / "reserved.toml").read_text(encoding="utf-8"))
KEYWORDS = set(_LISTS["keywords"]["names"].upper().split())
_BEGINNINGS = tuple(_LISTS["keywords"]["prefixes"])
C_MACROS = set(_LISTS["macros"]["names"].upper().split())


def check_name(name: str, at: Place) -> None:
    upper = name.upper()
    if upper in KEYWORDS or upper.startswith(_BEGINNINGS):
        raise StError(at, f"{name} is a word of the language and cannot be declared")
    if upper in C_MACROS:
        raise StError(at, f"{name} is a macro of the C library and cannot be declared")
    if "__" in name:
        raise StError(at, f"double underscore in the name {name}")
    if not name.isascii():
        raise StError(at, f"the name {name} is not ASCII")
