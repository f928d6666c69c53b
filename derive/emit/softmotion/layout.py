"""The text of a method without what its template left empty."""

from __future__ import annotations

import re


def tidy(text: str) -> str:
    """The text without empty sections, and with at most one empty line between paragraphs."""
    text = re.sub(r"\n(VAR\n)\s*\n", r"\n\1", "\n" + text)
    text = re.sub(r"\n\s*\n(END_VAR|END_IF|END_FOR)", r"\n\1", text)
    text = re.sub(r"\nVAR\nEND_VAR(?=\n)", "", text)
    text = re.sub(r"\n{3,}", "\n\n", text)
    return text.strip("\n") if text.lstrip("\n").startswith("VAR") else "\n" + text.strip("\n")
