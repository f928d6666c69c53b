"""Every block has its picture: shipped, referred to, small, and with every axis and length in its text, none cut
off."""

import re
import xml.etree.ElementTree as ElementTree
from itertools import combinations

import pytest
from PIL import Image

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Mechanism
from derive.emit.picture.canvas import WIDTH, pictures, text_width
from derive.emit.picture.naming import spelled
from derive.emit.picture.page import page
from tests.unit.drawing.machines import CATALOGUE, drawn

ST = OUTPUT / "st"
PICTURES = ST / "pictures"
_TEXT = "{http://www.w3.org/2000/svg}text"
_INPUT = re.compile(r"\{attribute 'sm_kin_param_unit' := 'u'\}\n  (d\w+) : LREAL")
_SETTINGS = ("dOffset", "dLower", "dUpper")
"""Inputs of axes and limits, which are no lengths of the machine."""


@pytest.fixture(params=CATALOGUE)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return CATALOGUE[request.param]


def _block(mechanism: Mechanism) -> str:
    return (ST / mechanism.family / f"{mechanism.block_name}.st").read_text(encoding="utf-8")


def _texts(mechanism: Mechanism) -> list[ElementTree.Element]:
    return list(ElementTree.parse(PICTURES / f"{mechanism.block_name}.svg").iter(_TEXT))


def test_the_description_refers_to_a_shipped_picture(mechanism: Mechanism) -> None:
    """The description of a block refers to a picture that is shipped, in a proper size."""
    (name,) = re.findall(r"^\.\. image:: @\((.+)\)$", _block(mechanism), re.MULTILINE)
    with Image.open(PICTURES / name) as image:
        assert image.format == "PNG"
        assert image.width == WIDTH and 300 <= image.height <= 750
        assert len(image.convert("RGB").getcolors(1 << 16) or ()) > 10, "not blank"


def test_axes_and_lengths_are_in_the_text(mechanism: Mechanism) -> None:
    """The text of a picture names every axis and every length."""
    text = " ".join(_in_full(element.text or "") for element in _texts(mechanism))
    declaration = _block(mechanism).split("END_VAR")[0]
    lengths = [name for name in _INPUT.findall(declaration) if not name.startswith(_SETTINGS)]
    assert len(lengths) >= sum(p.unit == "u" for p in mechanism.parameters)
    for name in (*(j.name for j in mechanism.joints), *lengths):
        assert re.search(rf"(?<!\w){name}(?!\w)", text), name
    for branch in mechanism.branches:
        assert branch.name in text and all(name in text for name in branch.names)


def _in_full(text: str) -> str:
    """A text with the names that it shortens: (dBase1X, Y, Z) names dBase1X, dBase1Y and dBase1Z."""
    short = re.fullmatch(r"\((\w+)X, Y(, Z)?\)", text)
    return text if short is None else ", ".join(short[1] + letter for letter in "XYZ")


def _extent(element: ElementTree.Element) -> tuple[float, float, float, float]:
    size = float(element.attrib["font-size"])
    wide = text_width(element.text or "", size, element.get("font-weight") == "bold")
    x, y = float(element.attrib["x"]), float(element.attrib["y"])
    left = x - wide / 2 if element.get("text-anchor") == "middle" else x
    return left, y - 0.75 * size, left + wide, y + 0.2 * size


def test_no_text_is_cut_off_or_covers_another(mechanism: Mechanism) -> None:
    """Every text is inside the picture, and no two texts touch."""
    root = ElementTree.parse(PICTURES / f"{mechanism.block_name}.svg").getroot()
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    found = [(element.text, _extent(element)) for element in _texts(mechanism)]
    for text, (left, top, right, bottom) in found:
        assert left > 0 and top > 0 and right < width and bottom < height, text
    for (one, a), (other, b) in combinations(found, 2):
        wide, high = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
        assert wide <= 0 or high <= 0, (one, other)


def test_letters_are_legible_where_a_window_shrinks_the_picture(mechanism: Mechanism) -> None:
    """At two thirds of its width every letter is still more than eight pixels high."""
    sizes = [float(element.attrib["font-size"]) for element in _texts(mechanism)]
    assert min(sizes) * 600 / WIDTH > 8.0


def test_no_picture_without_a_block() -> None:
    """Every picture belongs to a block, and all of them together are small."""
    blocks = {m.block_name for m in CATALOGUE.values()}
    assert {p.name for p in PICTURES.iterdir()} == {f"{b}.{ending}" for b in blocks for ending in ("png", "svg")}
    assert sum(p.stat().st_size for p in PICTURES.iterdir()) < 2_500_000


@pytest.mark.long
def test_the_same_marks_give_the_same_bytes_without_a_date() -> None:
    """Equal marks give equal files, which hold no date."""
    one = drawn("Kin_P2C_Type2")
    drawings = [page(one.drawing, "Title", {"inner_arm": "dInnerArm"}) for _ in range(2)]
    first, second = (pictures(p.marks, p.height) for p in drawings)
    assert first == second
    assert first.png.startswith(b"\x89PNG") and b"dInnerArm" in first.svg
    assert not re.search(rb"date|20\d\d-\d\d|[Mm]atplotlib", first.svg + first.png)


@pytest.mark.parametrize(
    ("label", "text"),
    [
        ("link_length_1", "dLinkLength1"),
        ("A3 - A4*pitch_zc/360", "A3 − A4·dPitchZC/360°"),
        ("A/2 - B/2", "(A − B)/2"),
        ("-A/2 - B/2", "(−A − B)/2"),
        ("tcp_link_distance/2", "tcp_link_distance/2"),
        ("0", "0"),
    ],
)
def test_labels_are_spelled(label: str, text: str) -> None:
    """A label shows parameters as inputs of the block."""
    import sympy as sp

    names = {"link_length_1": "dLinkLength1", "pitch_zc": "dPitchZC"}
    assert spelled(sp.sympify(label), names) == text
