"""`make docs`: the guides as they are, a page for each machine, and an API reference.

    python docs/site/build.py build/docs

The pages stand in a copy of the folders, where their links lead to the same files as in the repository.
"""

from __future__ import annotations

import ast
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import softkin
from sphinx.cmd.build import build_main

import derive.mechanism as vocabulary
from derive.description.catalogue import catalogue
from derive.description.mechanism import Mechanism

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
BLOCKS = Path("generated/st")
GUIDES = {
    "Use a robot": (
        "PYTHON",
        "GALLERY",
        "CALIBRATION",
        "CODESYS",
        "FIRST_PROJECT",
        "LINUXCNC",
        "C",
        "JAVASCRIPT",
        "FMI",
        "BR",
        "KLIPPER",
        "PACDRIVE",
    ),
    "Describe your own": ("OWN_MACHINE", "IMPORT", "VIEWER", "LIVE"),
    "Read on": ("MECHANISMS", "PROOF", "SPEED", "COMPARE", "COMPILER"),
}
HEADING = re.compile(r"^(\w[^:\n]*):\n((?:    .*\n?)+)", re.MULTILINE)
"""A heading of the docstring of a module, and the lines that stand below it."""


def build(folder: Path) -> int:
    """Write the site into `folder/html`; a broken link, or any other warning, is a failure: the result is not 0."""
    pages = folder / "pages"
    for name in ("pages", "trees", "html"):
        shutil.rmtree(folder / name, ignore_errors=True)
    shutil.copytree(ROOT / "docs", pages / "docs", ignore=shutil.ignore_patterns("site"))
    shutil.copytree(ROOT / BLOCKS, pages / BLOCKS)
    shutil.copytree(ROOT / "generated/python/softkin", pages / "generated/python/softkin")
    shutil.copy(ROOT / "ARCHITECTURE.md", pages)
    for guide in (pages / "docs").glob("*.md"):  # the README is the first page
        guide.write_text(guide.read_text(encoding="utf-8").replace("](../README.md", "](../index.md"), encoding="utf-8")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    machines = {mechanism.name: mechanism for _, mechanism in catalogue()}
    texts = {
        "index": "\n".join([readme, *contents()]),
        "api": "\n".join(api()),
        "machines/index": "\n".join(overview(machines)),
        **{f"machines/{name}": "\n".join(page(machine)) for name, machine in machines.items()},
    }
    for name, text in texts.items():
        target = pages / f"{name}.md"
        target.parent.mkdir(exist_ok=True)
        target.write_text(text, encoding="utf-8")
    options = ["-q", "-W", "--keep-going", "-j", "2", "-c", str(HERE), "-d", str(folder / "trees")]
    return build_main([*options, str(pages), str(folder / "html")])


def contents() -> Iterator[str]:
    """The list of all pages, for the side of the site."""
    lists = {title: [f"docs/{name}" for name in names] for title, names in GUIDES.items()}
    lists["Use a robot"] = ["machines/index", *lists["Use a robot"], "api", "generated/st/README"]
    lists["Read on"].append("ARCHITECTURE")
    for title, names in lists.items():
        yield from ("", "```{toctree}", ":hidden:", f":caption: {title}", "", *names, "```")


def api() -> Iterator[str]:
    """The reference of the package, without the classes of machines, and of what a description is written with."""
    yield from ("# API reference", "", "From the docstrings. Each machine has a page: [Machines](machines/index.md).")
    machines = {cls.__name__ for cls in softkin.catalogue().values()}
    yield from ("", "## softkin", "")
    for name in sorted(set(softkin.__all__) - machines, key=str.lower):
        value = getattr(softkin, name)
        if isinstance(value, type):
            yield from directive("autoclass", f"softkin.{name}")
        elif callable(value):
            yield from directive("autofunction", f"softkin.{name}")
    yield from ("", "## The vocabulary of a description", "")
    for name in sorted(vocabulary.__all__, key=str.lower):
        value = getattr(vocabulary, name)
        if isinstance(value, type) or callable(value):
            yield from directive("autoclass" if isinstance(value, type) else "autofunction", f"derive.mechanism.{name}")


def directive(kind: str, name: str) -> Iterator[str]:
    """The reference of one class or function."""
    yield from ("```{eval-rst}", f".. {kind}:: {name}", *(["   :members:"] if kind == "autoclass" else []), "```", "")


def overview(machines: dict[str, Mechanism]) -> Iterator[str]:
    """The machines by family, each with a small picture."""
    yield from ("# Machines", "", f"{len(machines)} machines, each with drawing, parameters, singularities and files.")
    families: dict[str, list[Mechanism]] = {}
    for machine in machines.values():
        families.setdefault(family_of(machine), []).append(machine)
    for family, members in sorted(families.items()):
        yield from ("", f"## {family.replace('_', ' ').capitalize()}", "", "| | |", "|---|---|")
        for one in members:
            picture = f"![]({picture_of(one)}){{width=160px}}" if picture_of(one) else ""
            yield f"| [{picture}]({one.name}.md) | [{one.name}]({one.name}.md): {one.summary} |"
    yield from ("", "```{toctree}", ":hidden:", "", *machines, "```")


def page(machine: Mechanism) -> Iterator[str]:
    """Drawing, call in Python, parameters, what the docstring says, and the files of a machine."""
    cls = softkin.catalogue()[machine.name]
    nominal = {p.name: p.nominal for p in machine.parameters}
    differing = (p for p in cls.PARAMETERS if nominal.get(p.name, p.default) != p.default)
    needed = ", ".join(f"{p.name}={nominal[p.name]}" for p in differing)
    yield from (f"# {machine.name}", "", str(cls.__doc__).split("\n")[0], "")
    for of, what in (("", "drawn"), ("_Configuration", "its configurations")):
        if picture_of(machine, of):
            yield from (f"![{machine.name}, {what}]({picture_of(machine, of)})", "")
    yield from ("```python", "import softkin", "", f"robot = softkin.{cls.__name__}({needed})", "```", "")
    yield from ("## Parameters", "", "| parameter | meaning | unit | nominal |", "|---|---|---|---|")
    for p in cls.PARAMETERS:
        shown = nominal.get(p.name, p.default)
        yield f"| `{p.name}` | {cell(p.meaning)} | {p.unit} | {'' if shown is None else format(shown, 'g')} |"
    docstring = ast.get_docstring(ast.parse((ROOT / module_of(cls)).read_text(encoding="utf-8"))) or ""
    for title, lines in HEADING.findall(docstring):
        yield from ("", f"## {title.split('(')[0].strip()}", "", *(f"- {line.strip()}" for line in lines.splitlines()))
    yield from ("", "## Files", "", f"- [Python](../{module_of(cls)})")
    for path in sorted((ROOT / BLOCKS).glob(f"*/{machine.block_name}.*")):
        what = {".st": "Structured Text", ".xml": "PLCopenXML", ".png": "picture", ".svg": "picture, to scale"}
        yield f"- [{what[path.suffix]}](../{path.relative_to(ROOT).as_posix()})"


def module_of(cls: type) -> str:
    """The file of a class, below the root."""
    return f"generated/python/{cls.__module__.replace('.', '/')}.py"


def picture_of(machine: Mechanism, of: str = "") -> str:
    """The picture of a machine, or of its configurations, from its page; nothing if it has none."""
    path = BLOCKS / "pictures" / f"{machine.block_name}{of}.svg"
    return f"../{path.as_posix()}" if (ROOT / path).is_file() else ""


def family_of(machine: Mechanism) -> str:
    """The folder of its block."""
    found = next((ROOT / BLOCKS).glob(f"*/{machine.block_name}.st"), None)
    return found.parent.name if found else "other"


def cell(text: str) -> str:
    """A text in a cell of a table."""
    return text.replace("|", "\\|")


if __name__ == "__main__":
    sys.exit(build(Path(sys.argv[1]).resolve()))
