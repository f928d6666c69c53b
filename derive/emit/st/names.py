"""Names in Structured Text: words are joined, inputs have prefixes, and no two names differ in case alone."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from functools import cache

from derive.emit.language import TEMPLATES
from derive.emit.st.contract import load
from derive.emit.st.reserved import reserved
from derive.equations.windows import limits_of_axis
from derive.ir.types import Type

_LETTERS = {"zc": "ZC"}
"""Words that stand for axes, and so are written in capital letters."""
_NEUTRAL = re.compile(r"[a-z]+(_[a-z0-9]+)+")
_DECLARED = re.compile(r"^ +([A-Za-z]\w*) : ", re.MULTILINE)
_OF_PLATFORMS = frozenset({"within"})
"""Constants of platforms, whose blocks have no search: its method has a variable of the same name."""
_OF_THE_BLOCK = ("initialized", "matrixOrder", "checkLimits", "DEGREE", "NumAxes", "Config", "lastAxes")

TEMPLATE_LOCALS = frozenset(
    """
    apart baseaxis configbytes flange flangeaxis frame identity nothing projected relative rot rotation solution
    space status total
    """.split()
)
"""The variables that the templates of methods declare."""


def joined(name: str) -> str:
    """`link_length_1` → `linkLength1`."""
    first, *rest = name.split("_")
    return first + "".join(capitalized(word) for word in rest)


def parameter_name(name: str) -> str:
    """The parameter of a private method: `link_length_1` → `linkLength1`, and another spelling for a reserved name."""
    return _free(joined(name), reserved())


def _free(spelled: str, used: Collection[str]) -> str:
    """The spelling, with a word behind it while it is used, in whatever case."""
    while spelled.lower() in used:
        spelled += "Value"
    return spelled


def capitalized(name: str) -> str:
    """`link_length_1` → `LinkLength1`."""
    return "".join(_LETTERS.get(word, word[:1].upper() + word[1:]) for word in name.split("_"))


def free(name: str, used: set[str]) -> str:
    """The name, with a word behind it where it is used or reserved; it is used from then on."""
    spelled = _free(name, used | reserved())
    used.add(spelled.lower())
    return spelled


def type_name(kind: Type) -> str:
    """The type of a variable."""
    return {Type.BOOL: "BOOL", Type.INT: "INT"}.get(kind, "LREAL")


@cache
def stored_name(name: str) -> str:
    """The instance variable for a constant: `link_length_1` → `linkLength1`. No variable of the base block has that
    name, nor one of its methods' variables: in a flat block they stand beside it.
    """
    return spellings((name,), of_methods())[name]


@cache
def of_methods() -> frozenset[str]:
    """The names of all methods, and of the variables that these declare whatever the machine is, in small letters:
    another variable of the block with such a name would be hidden.
    """
    signatures = load().signatures.values()
    found = {name for s in signatures for name in (s.name, *(p.name for p in s.parameters))}
    settings = limits_of_axis()
    found |= {
        parameter_name(name) for name in (*(s.name for s in settings.inputs), *(o.name for o in settings.outputs))
    }
    for path in (path for folder in ("methods", "base") for path in (TEMPLATES / "st" / folder).glob("*.st.j2")):
        found |= {path.name.removesuffix(".st.j2"), *_DECLARED.findall(path.read_text(encoding="utf-8"))}
    return frozenset(name.lower() for name in (*found, "LimitsOfAxis", *_OF_THE_BLOCK)) - _OF_PLATFORMS


def respelled(text: str, names: Mapping[str, str]) -> str:
    """A sentence in ASCII, in which every neutral name is replaced by its spelling."""
    return _NEUTRAL.sub(lambda found: names.get(found.group(), found.group()), text).replace("²", "^2")


def spellings(names: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """A spelling for every neutral name, none of which is reserved or taken."""
    used = {t.lower() for t in taken} | reserved() | TEMPLATE_LOCALS
    found: dict[str, str] = {}
    for name in names:
        spelled = _free(joined(name), used)
        used.add(spelled.lower())
        found[name] = spelled
    return found
