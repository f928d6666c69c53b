"""docs/PYTHON.md: every listing about frames, tools and derivatives runs, and prints what the page shows."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[3] / "docs/PYTHON.md"
SECTIONS = ("Frames", "Tools and bases", "Derivatives")


def test_the_listings_print_what_the_page_shows() -> None:
    """The sections one after the other, in one session."""
    text = PAGE.read_text(encoding="utf-8")
    parts = dict(zip(*[iter(re.split(r"^## (.*)\n", text, flags=re.MULTILINE)[1:])] * 2, strict=True))
    listings = [code for name in SECTIONS for code in re.findall(r"```python\n(.*?)```", parts[name], re.DOTALL)]
    session = "\n".join(code for code in listings if ">>>" in code)
    parsed = doctest.DocTestParser().get_doctest(session, {}, "PYTHON.md", str(PAGE), 0)
    said: list[str] = []
    found = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(parsed, out=said.append)
    assert not found.failed, "".join(said)
    assert found.attempted > 25
