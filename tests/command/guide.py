"""docs/OWN_MACHINE.md, taken apart: its machines, its commands, and the refusals that it lists."""

import re

from tests.command.files import ROOT

TEXT = (ROOT / "docs/OWN_MACHINE.md").read_text(encoding="utf-8")
PROGRAMS: dict[str, str] = dict(re.findall(r"```python\n# (\w+)\.py\n(.*?)```", TEXT, re.DOTALL))
"""The programs of the guide, by the names of their files: seven machines, and the plot of a path."""
MACHINES = {name: text for name, text in PROGRAMS.items() if "MECHANISM = " in text}
COMMANDS = [line.split("  #")[0].strip() for line in re.search(r"```sh\n(.*?)```", TEXT, re.DOTALL)[1].splitlines()]  # type: ignore[index]
REFUSALS = tuple(
    re.sub(r"\\`", "`", said)
    for part in TEXT.split("## How to read a refusal")[1].split("### Warnings")[0:1]
    for said in re.findall(r"^\| `((?:[^`\\]|\\.)+)` \|", part, re.MULTILINE)
)


def pattern(refusal: str) -> str:
    """The pattern of a refusal as the guide writes it: … stands for anything."""
    return ".*".join(map(re.escape, refusal.split("…")))
