"""The guide for CODESYS, and the programs that stand in it."""

import re

from derive.command.catalogue import OUTPUT

GUIDE = (OUTPUT.parent / "docs" / "CODESYS.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```iecst\n(.*?)```", GUIDE, re.DOTALL)


def closed(program: str) -> str:
    """A program as a text: an editor of CODESYS has no closing line."""
    return program if "END_FUNCTION_BLOCK" in program else f"{program}END_PROGRAM\n"


def renamed(texts: dict[str, str]) -> dict[str, str]:
    """The texts with another name for the output `Error` of the library's blocks, which ours never declare."""
    return {name: re.sub(r"\bError\b", "ErrorOut", text) for name, text in texts.items()}
