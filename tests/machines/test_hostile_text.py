"""Text of a description is data: whatever it holds, every output is the same program as with a plain text."""

import ast
import dataclasses
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from html.parser import HTMLParser
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from derive.description.errors import DescriptionError
from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.emit.c.printer import text as c_text
from derive.emit.fmu import package as fmu
from derive.emit.language import markdown
from derive.emit.page.page import index_of, page_of
from derive.emit.softmotion.description import literal
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import Built, files_of, languages
from tests.c.machine import described
from tests.c.programs import compiled
from tests.harness.lexical import tokens
from tests.javascript.modules import written
from tests.javascript.node import ask, run
from tests.linuxcnc import module
from tests.machines.hostile import MADE, MARKS, UNPRINTED, hostile, plain
from tests.machines.made import imported_class
from tests.text.units import compiled_text

pytestmark = pytest.mark.slow("loop")

EVERY = pytest.mark.parametrize("name", MADE)
FREE = {"source", "summary", "title", "notes", "meaning", "meanings", "message"}
"""The fields that hold a text for people; every other text is a name, or a word of a list."""


@dataclass(frozen=True)
class Pair:
    """One machine with hostile texts and with plain ones: what was derived, and all files."""

    kinematics: tuple[Kinematics, Kinematics]
    built: tuple[Built, Built]
    files: tuple[dict[str, str], dict[str, str]]


@cache
def pair(name: str) -> Pair:
    kinematics = tuple(build(validate(MADE[name](texts()))) for texts in (hostile, plain))
    every = languages(wanted=("python", "st", "javascript", "c", "linuxcnc", "klipper", "br"))
    built = tuple(
        Built("", "", None, {one.name: part for one in every if (part := one.part(kin)) is not None}, {}, None)
        for kin in kinematics
    )
    files = tuple({path: data.decode() for path, data in files_of([one], every).items()} for one in built)
    return Pair(kinematics, built, files)  # type: ignore[arg-type]


def both(name: str, ending: str) -> Iterator[tuple[str, str]]:
    """The files with this ending, each with that of the twin."""
    odd, usual = pair(name).files
    assert odd.keys() == usual.keys()
    found = [(odd[path], usual[path]) for path in odd if path.endswith(ending)]
    assert found
    return iter(found)


@EVERY
def test_python(name: str) -> None:
    """The same statements; docstrings and texts hold every mark as it is."""

    def shape(text: str) -> str:
        class Blank(ast.NodeTransformer):
            def visit_Constant(self, node: ast.Constant) -> ast.Constant:
                return ast.Constant("") if isinstance(node.value, str) else node

        return ast.dump(Blank().visit(ast.parse(text)))

    for odd, usual in both(name, ".py"):
        assert shape(odd) == shape(usual)
    kinematics = pair(name).kinematics[0]
    made = imported_class(kinematics.mechanism, pair(name).built[0])
    assert [axis.meaning for axis in made.AXES] == [joint.meaning for joint in kinematics.mechanism.joints]
    meanings = {p.name: p.meaning for p in made.PARAMETERS}
    assert all(meanings[p.name] == p.meaning for p in kinematics.mechanism.parameters)
    assert "".join(kinematics.mechanism.summary.split()) in "".join(str(made.__doc__).split())


@EVERY
def test_javascript(name: str) -> None:
    """The same functions, and the description holds every text as it is; nothing else has run."""
    mechanism = pair(name).kinematics[0].mechanism
    scripts = [written(one.parts["javascript"]) for one in pair(name).built]
    told = ask(scripts[0], [])["description"]
    assert (told["summary"], told["source"]) == (mechanism.summary, mechanism.source)
    assert [axis["meaning"] for axis in told["axes"]] == [joint.meaning for joint in mechanism.joints]
    assert all(note in told["notes"] for note in mechanism.notes)
    assert run(scripts[0], "return globalThis.HIT === undefined;")
    for odd, usual in both(name, ".js"):
        assert functions(odd) == functions(usual)


def functions(text: str) -> list[str]:
    """The heads of the functions of a module, and its imports."""
    return re.findall(r"^(?:export )?(?:function .*|import .*|const .*)$", text, re.MULTILINE)


@EVERY
def test_c_and_linuxcnc(name: str) -> None:
    """The same tokens, compiled without a warning; the program tells every text as it is."""

    def shape(text: str) -> str:
        given = re.sub(r"^#.*$", "", text, flags=re.MULTILINE)
        command = ["gcc", "-std=c99", "-fpreprocessed", "-E", "-P", "-x", "c", "-"]
        found = subprocess.run(command, input=given, capture_output=True, text=True, check=True).stdout
        return " ".join(re.sub(r'(\s*"(?:[^"\\]|\\.)*")+', '""', found).split())

    for ending in (".c", ".h"):
        for odd, usual in both(name, ending):
            assert odd == usual or shape(odd) == shape(usual)
    kinematics, built = pair(name).kinematics[0], pair(name).built[0]
    told = described(compiled(built.parts["c"]))
    assert [axis["meaning"] for axis in told.axes] == [joint.meaning for joint in kinematics.mechanism.joints]
    assert [p["meaning"] for p in told.parameters] == [p.meaning for p in kinematics.parameters]
    assert module.compiled(built.parts["linuxcnc"], "2_9").is_file()


@EVERY
def test_structured_text(name: str) -> None:
    """The same tokens and the same objects, read by the second compiler; PLCopenXML has the same elements."""

    def shape(text: str) -> list[str]:
        kinds = ((one.kind, one.text) for one in tokens(text))
        return [text if kind != "string" else "''" for kind, text in kinds if kind != "comment"]

    for odd, usual in both(name, ".st"):
        assert shape(odd) == shape(usual)
    for odd, usual in both(name, ".xml"):
        elements = [[(one.tag, one.keys()) for one in ET.fromstring(text).iter()] for text in (odd, usual)]
        assert elements[0] == elements[1]
    mechanism, text = pair(name).kinematics[0].mechanism, pair(name).built[0].parts["st"]["text"]
    block = compiled_text(f"{mechanism.name}.st", text).new(mechanism.block_name)
    assert block.call("Initialize") != "SMC_NO_ERROR"  # for its lengths are not given
    if mechanism.title is not None:
        assert "'" + mechanism.title[:255].replace("$", "$$").replace("'", "$'") + "'" in text


class Elements(HTMLParser):
    """The elements of a page with the names of their attributes, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[Any] = []
        self.text = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, [name for name, _ in attrs]))

    def handle_endtag(self, tag: str) -> None:
        self.found.append(tag)

    def handle_comment(self, data: str) -> None:
        self.found.append("comment")

    def handle_data(self, data: str) -> None:
        self.text += data


@EVERY
def test_pages(name: str) -> None:
    """The page of the derivation and the index have the same elements, and are well-formed."""
    found = pair(name).kinematics
    pages = [page_of(kin.mechanism, kin, has_pictures=name == "chain") for kin in found]
    for odd, usual in ((pages[0].text, pages[1].text), (index_of(pages[:1]), index_of(pages[1:]))):
        ET.fromstring(odd.replace("<!DOCTYPE html>", ""))
        assert Elements(odd).found == Elements(usual).found
        assert " ".join(found[0].mechanism.summary.split()) in " ".join(Elements(odd).text.split())


@EVERY
def test_tables_of_markdown(name: str) -> None:
    """A row has as many cells as with a plain text, and neither an element nor markup from it."""
    for odd, usual in both(name, "README.md"):
        rows = [[re.sub(r"\\.", "", line) for line in text.splitlines()] for text in (odd, usual)]
        marks = [[re.findall(r"[|<*`\[\]]", line) for line in lines] for lines in rows]
        assert marks[0] == marks[1]


@pytest.mark.parametrize("mark", MARKS)
def test_escapes(mark: str) -> None:
    """Of reStructuredText: no mark of it is left; of C: no trigraph; of Markdown: no markup."""
    bare = re.sub(r"\\(.)", lambda found: "" if found[1] == " " else "x", literal(mark))
    assert not re.search(r"[*`|]|_(?!\w)|(?<!\w)_|::|(?<!\S)([^\w\s])\1{3,}(?!\S)", bare)
    assert not re.match(r"\.\.|[-+>] ", bare)
    assert "*)" not in literal(mark) and "(*" not in literal(mark)
    assert not re.search(r"\?\?[=/'()!<>-]", c_text(mark))
    assert not re.search(r"[*`|<\[]", re.sub(r"\\.", "", markdown(mark)))


def stated(one: Any, *path: Any) -> Iterator[tuple[tuple[Any, ...], str]]:
    """Every text in a description, with the fields that lead to it."""
    if isinstance(one, str):
        yield path, one
    elif isinstance(one, tuple):
        for k, part in enumerate(one):
            yield from stated(part, *path, k)
    elif dataclasses.is_dataclass(one) and type(one).__module__.startswith("derive.description"):
        for field in dataclasses.fields(one):
            yield from stated(getattr(one, field.name), *path, field.name)


def with_text(one: Any, path: tuple[Any, ...], text: str) -> Any:
    """The description with another text at a place."""
    if not path:
        return text
    head, *rest = path
    if isinstance(one, tuple):
        return (*one[:head], with_text(one[head], tuple(rest), text), *one[head + 1 :])
    return replace(one, **{head: with_text(getattr(one, head), tuple(rest), text)})


@EVERY
def test_fmu(name: str) -> None:
    """The same elements; the description of the FMU holds the texts for people as they are."""
    parts = [fmu.part(one) for one in pair(name).kinematics]
    path = next(path for path in parts[0]["files"] if path.endswith("modelDescription.xml"))  # type: ignore[index]
    odd, usual = (list(ET.fromstring(part["files"][path].encode()).iter()) for part in parts)  # type: ignore[index]
    assert [one.tag for one in odd] == [one.tag for one in usual]
    mechanism, found = pair(name).kinematics[0].mechanism, " ".join(one.get("description", "") for one in odd)
    for text in (mechanism.summary, *(joint.meaning for joint in mechanism.joints)):
        assert " ".join(text.split()) in " ".join(found.split())


@EVERY
def test_every_field(name: str) -> None:
    """A text for people may hold whatever is printed; a name, nothing but a name; and no text a control character."""
    mechanism: Mechanism = MADE[name](plain())
    for path, _ in stated(mechanism):
        is_free = any(part in FREE for part in path)
        for mark in MARKS if not is_free else ():
            with pytest.raises(DescriptionError):
                validate(with_text(mechanism, path, f"a{mark}"))
        if is_free:
            validate(with_text(mechanism, path, hostile()()))
            for odd in UNPRINTED:
                with pytest.raises(DescriptionError, match="not printed"):
                    validate(with_text(mechanism, path, f"a{odd}b"))
