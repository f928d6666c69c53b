"""Every block has its picture, whose letters are drawn by any process; what would be drawn wrong is refused."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from hashlib import sha256
from itertools import combinations
from multiprocessing import get_context

import numpy as np
import pytest
import sympy as sp
from PIL import Image

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import DescriptionError, Mechanism, X, Y, rod
from derive.description.validate import validate
from derive.drawing.drawing import drawing_of
from derive.drawing.pose import drawn_pose, nominal_machine
from derive.emit.picture import canvas
from derive.emit.picture.canvas import pictures, text_width
from derive.emit.picture.naming import spelled
from derive.emit.picture.page import page
from derive.emit.st.names import capitalized
from derive.ir.program import Require, Status
from derive.kinematics.build import build
from derive.report.reference_calls import margins
from tests.mechanisms import limit_names
from tests.unit.drawing.machines import CATALOGUE, drawn

ST = OUTPUT / "st"
PICTURES = ST / "pictures"
_TEXT = "{http://www.w3.org/2000/svg}text"
_INPUT = re.compile(r"\{attribute 'sm_kin_param_unit' := 'u'\}\n  (d\w+) : LREAL")


@pytest.fixture(params=CATALOGUE)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return CATALOGUE[request.param]


def _block(mechanism: Mechanism) -> str:
    return (ST / mechanism.family / f"{mechanism.block_name}.st").read_text(encoding="utf-8")


def _drawn(mechanism: Mechanism) -> list[ElementTree.Element]:
    """The machine, and the choices of its configuration if they are drawn."""
    paths = (PICTURES / f"{mechanism.block_name}{end}.svg" for end in ("", "_Configuration"))
    return [ElementTree.parse(path).getroot() for path in paths if path.exists()]


def _texts(mechanism: Mechanism) -> list[ElementTree.Element]:
    return [element for root in _drawn(mechanism) for element in root.iter(_TEXT)]


def _size(root: ElementTree.Element) -> tuple[float, float]:
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    return width, height


def test_the_description_refers_to_the_shipped_pictures(mechanism: Mechanism) -> None:
    """Shown 400 pixels wide, each has two pixels for one of the window, and is hardly higher than wide."""
    found = re.findall(r"^\.\. image:: @\((.+)\)\n  :width: 400$", _block(mechanism), re.MULTILINE)
    names = (f"{mechanism.block_name}{end}.png" for end in ("", "_Configuration"))
    assert found == [name for name in names if (PICTURES / name).exists()]
    assert len(found) == 2 or not mechanism.branches
    for name in found:
        with Image.open(PICTURES / name) as image:
            assert image.format == "PNG"
            assert image.width == 800 and 220 <= image.height <= 900
            assert len(image.convert("RGB").getcolors(1 << 16) or ()) > 10, "not blank"


def test_the_machine_fills_its_picture(mechanism: Mechanism) -> None:
    """The rectangle of its shapes covers a good part of the page, in both directions."""
    root, *_ = _drawn(mechanism)
    shapes = [e for e in root.iter() if e.get("points")]
    spots = np.array([spot.split(",") for e in shapes for spot in e.attrib["points"].split()], dtype=float)
    share = np.ptp(spots, axis=0) / _size(root)
    assert np.min(share) > 0.34 and np.prod(share) > 0.16, share


def test_no_length_is_told_as_a_number(mechanism: Mechanism) -> None:
    """A value of a length would hold for the drawn dimensions alone; angles have a degree sign."""
    text = " ".join(element.text or "" for element in _texts(mechanism))
    assert not re.search(r"= [-−]?\d+(\.\d+)?(?![\d.°])", text)


def test_axes_and_lengths_are_in_the_text(mechanism: Mechanism) -> None:
    text = " ".join(_in_full(element.text or "") for element in _texts(mechanism))
    text = " ".join([text, *_series(text)])
    declaration = _block(mechanism).split("END_VAR")[0]
    settings = limit_names(mechanism) | {joint.offset.name for joint in mechanism.joints}
    lengths = set(_INPUT.findall(declaration)) - {f"d{capitalized(name)}" for name in settings}
    assert len(lengths) >= sum(p.unit == "u" for p in mechanism.parameters)
    for name in (*(j.name for j in mechanism.joints), *lengths):
        assert re.search(rf"(?<!\w){name}(?!\w)", text), name
    for branch in mechanism.branches:
        assert branch.name in text and all(name in text for name in branch.names)


def _in_full(text: str) -> str:
    """A text with the names that it shortens: (dBase1X, Y, Z) names dBase1X, dBase1Y and dBase1Z."""
    short = re.fullmatch(r"\((\w+)X, Y(, Z)?\)", text)
    return text if short is None else ", ".join(short[1] + letter for letter in "XYZ")


def _series(text: str) -> list[str]:
    """The names of a series: dRod2 to dRod4, dBase2X to dBase4Z, dRailX2 to dRailY4, dRing2Radius to dRing5Radius."""
    found = re.findall(r"\b(d[A-Za-z]+?)([XYZ]?)(\d)([A-Z]?[a-z]*) to \1([XYZ]?)(\d)([A-Z]?[a-z]*)\b", text)
    return [
        f"{stem}{before}{number}{after}"
        for stem, _, first, _, one, last, other in found
        for number in range(int(first), int(last) + 1)
        for before in ("XYZ"[: "XYZ".index(one) + 1] if one else ("",))
        for after in ("XYZ"[: "XYZ".index(other) + 1] if other in {*"XYZ"} else (other,))
    ]


def _extent(element: ElementTree.Element) -> tuple[float, float, float, float]:
    size = float(element.attrib["font-size"])
    wide = text_width(element.text or "", size, element.get("font-weight") == "bold")
    x, y = float(element.attrib["x"]), float(element.attrib["y"])
    left = x - wide / 2 if element.get("text-anchor") == "middle" else x
    return left, y - 0.75 * size, left + wide, y + 0.2 * size


def test_no_text_is_cut_off_or_covers_another(mechanism: Mechanism) -> None:
    for root in _drawn(mechanism):
        width, height = _size(root)
        found = [(element.text, _extent(element)) for element in root.iter(_TEXT)]
        for text, (left, top, right, bottom) in found:
            assert left > 0 and top > 0 and right < width and bottom < height, text
        for (one, a), (other, b) in combinations(found, 2):
            wide, high = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
            assert wide <= 0 or high <= 0, (one, other)


def test_letters_are_legible_where_a_window_shrinks_the_picture(mechanism: Mechanism) -> None:
    """At a width of 320 pixels the smallest letters still have a size of nine pixels."""
    for root in _drawn(mechanism):
        sizes = [float(element.attrib["font-size"]) for element in root.iter(_TEXT)]
        assert min(sizes) * 320 / _size(root)[0] >= 8.96


def test_no_picture_without_a_block() -> None:
    """Every picture belongs to a block, and all of them together are small."""
    blocks = {m.block_name for m in CATALOGUE.values()}
    names = {p.name for p in PICTURES.iterdir()}
    assert {n.replace("_Configuration.", ".") for n in names} == {f"{b}.{e}" for b in blocks for e in ("png", "svg")}
    assert sum(p.stat().st_size for p in PICTURES.iterdir()) < 50_000 * len(blocks)


@pytest.mark.long
def test_the_same_marks_give_the_same_bytes_without_a_date() -> None:
    one = drawn("Kin_P2C_Type2")
    drawings = [page(one.drawing, "Title", {"inner_arm": "dInnerArm"}) for _ in range(2)]
    first, second = (pictures(p.marks, p.width, p.height) for p in drawings)
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
    import sympy as sp

    names = {"link_length_1": "dLinkLength1", "pitch_zc": "dPitchZC"}
    assert spelled(sp.sympify(label), names) == text


TEXTS = [f"A{k} link_{k} ±{k * 7}° tool centre {chr(65 + k % 26)}" for k in range(60)]


def drawn_letters(_: int) -> str:
    """The digest of all texts, each drawn anew."""
    canvas._letters.cache_clear()
    found = [canvas._letters(text, 11.0, is_bold, 1.6) for text in TEXTS for is_bold in (False, True)]
    return sha256(b"".join(letters.covered.tobytes() for letters in found)).hexdigest()


@pytest.mark.long
def test_processes_do_not_disturb_each_other() -> None:
    """Both have the font that this process has opened, and draw at the same time what it draws alone."""
    alone = drawn_letters(0)
    with get_context("fork").Pool(2) as pool:
        assert set(pool.map_async(drawn_letters, range(8), chunksize=1).get(timeout=120)) == {alone}


SCISSOR = CATALOGUE["Kin_P2X_Type2"]
CRANE = CATALOGUE["Kin_Crane"]
LENGTH, _ = SCISSOR.parameters
A1, A2 = SCISSOR.joints
R, THETA, _ = CRANE.joints


def _scissor(*bars: object) -> Mechanism:
    return replace(SCISSOR, bars=tuple(bars))


WRONG = {
    "a bar that is not as long as stated": (
        _scissor(rod("1", (A1, 0), (X, Y), LENGTH), rod("2", (A2, 0), (X, Y), LENGTH)),
        r"bar '1' is 400 long, but its ends are \d+(\.\d+)? apart in the drawn pose",
    ),
    "a joint that moves nothing": (
        _scissor(rod("1", *(SCISSOR.bars[0].base, SCISSOR.bars[0].plate), LENGTH)),
        "nothing that is drawn moves with joint 'A2': name its bars",
    ),
    "an end that goes on no circle": (
        replace(
            CRANE, bars=(rod("reach", (0, 0, 0), (0, 0, R), R), rod("boom", (0, 0, THETA), (X, Y, THETA + 100), 200))
        ),
        "joint 'Theta' does not move the end of its bar on a circle",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("case", WRONG)
def test_refused(case: str) -> None:
    mechanism, message = WRONG[case]
    kinematics = build(validate(mechanism))
    with pytest.raises(DescriptionError, match=message):
        drawing_of(kinematics)


FAR = replace(SCISSOR, joints=tuple(replace(j, nominal=2.0 * j.nominal) for j in SCISSOR.joints))


@pytest.mark.long
def test_nominal_joints_that_fit_no_pose() -> None:
    """Another pose is drawn, away from singular ones."""
    machine = nominal_machine(build(validate(FAR)))
    pose = drawn_pose(machine)
    assert pose.axes != tuple(j.nominal for j in FAR.joints)
    assert np.min(np.abs(margins(machine, [pose.axes]))) > 0.05


@pytest.mark.long
def test_no_pose_can_be_drawn() -> None:
    """Where no sampled pose is possible either, the nominal values are named."""
    kinematics = build(validate(FAR))
    nowhere = replace(kinematics.singularity, body=(Require(sp.false, Status.IMPOSSIBLE), *kinematics.singularity.body))
    refused = replace(kinematics.forward, body=(Require(sp.false, Status.IMPOSSIBLE), *kinematics.forward.body))
    machine = nominal_machine(replace(kinematics, singularity=nowhere, forward=refused))
    with pytest.raises(DescriptionError, match="no pose can be drawn: the nominal values of its joints fit no pose"):
        drawn_pose(machine)


def test_a_bar_of_something_unknown_is_refused_before() -> None:
    strange = CATALOGUE["Kin_PCC"].parameters[0]
    with pytest.raises(DescriptionError, match="bar '1' reads 'link_length_1', which is not a joint or a parameter"):
        validate(_scissor(rod("1", (A1, 0), (X, Y), strange)))
