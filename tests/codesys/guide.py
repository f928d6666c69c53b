"""The guide for CODESYS, and the programs that stand in it."""

import re

from derive.command.catalogue import OUTPUT
from tests.codesys.parts import FILES
from tests.harness.library import Library, compile_st

GUIDE = (OUTPUT.parent / "docs" / "CODESYS.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```iecst\n(.*?)```", GUIDE, re.DOTALL)


def closed(program: str) -> str:
    """A program as a text: an editor of CODESYS has no closing line."""
    return program if "END_FUNCTION_BLOCK" in program else f"{program}END_PROGRAM\n"


def renamed(texts: dict[str, str]) -> dict[str, str]:
    """The texts with another name for the output `Error` of the library's blocks, which ours never declare."""
    return {name: re.sub(r"\bError\b", "ErrorOut", text) for name, text in texts.items()}


def program_of(head: str) -> str:
    """The one program of the guide with this first line."""
    (found,) = (closed(program) for program in PROGRAMS if program.split("\n")[0] == head)
    return found


def library_of(*blocks: str, **texts: str) -> Library:
    """These blocks with what all share, and further texts."""
    names = {f"{block}.st" for block in blocks}
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or n.split("/")[-1] in names}
    return compile_st({**needed, **renamed(texts)})
