"""The generated package answers as it did when the corpus was recorded, and a package that does not is found out."""

from collections.abc import Callable
from typing import Any

import pytest

from tests.corpus.answers import Answer, Question, answer
from tests.corpus.comparison import differences
from tests.corpus.recording import NAMES, RECORDED, compared, read
from tests.corpus.robots import Robot, robot

pytestmark = pytest.mark.broad

SHOWN = 5
KINDS = {"regular", "singular", "garbage", "rotation", "bytes", "reach", "limits", "parameters", "facts"}
"""What every mechanism with axes and branches is asked about."""


@pytest.mark.parametrize("name", NAMES)
def test_answers_are_those_recorded(name: str) -> None:
    """The package gives the recorded answer to every recorded question."""
    recording = read(name)
    found = list(compared(recording))
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])


def test_every_recording_is_asked() -> None:
    """And nothing is recorded in vain: every mechanism of the package has a file, with every kind of question."""
    import softkin

    assert {path.name.removesuffix(".json.xz") for path in RECORDED.iterdir()} == set(NAMES)
    assert set(softkin.catalogue()) <= set(NAMES)
    for name in ("Kin_ArticulatedRobot_6DOF", "Kin_Delta_P3C_Type3", "Kin_Scara4_ZCcoupled_Type1"):
        assert {question["kind"] for part in read(name) for question in part["asked"]} >= KINDS


def mirrored(found: Answer) -> None:
    """The sign of the last axis of the last slot that answers."""
    slots = [slot for slot in found.get("slots", []) if slot.get("axes")]
    if slots:
        slots[-1]["axes"][-1] = -slots[-1]["axes"][-1]


def moved(found: Answer) -> None:
    """An axis of the configuration that is named first, by little more than is allowed."""
    for named in found.get("named", [])[:1]:
        if "axes" in named and named["margin"] > 0.05:
            named["axes"][0] += 1e-5


def dropped(found: Answer) -> None:
    """A slot that answers no more."""
    for slot in found.get("slots", [])[:1]:
        if "axes" in slot:
            slot |= {"status": 3}
            del slot["axes"], slot["margin"]


def reworded(found: Answer) -> None:
    for named in found.get("named", []):
        if named["why"].get("reason"):
            named["why"]["reason"] = named["why"]["reason"].upper()


def turned(found: Answer) -> None:
    for named in found.get("named", []):
        if named["why"].get("turn"):
            named["why"]["turn"] += 1


def short(found: Answer) -> None:
    """Another amount that is missing."""
    for slot in found.get("slots", []):
        if slot.get("why", {}).get("missing"):
            slot["why"]["missing"] *= 1.0 + 1e-6


def permitted(found: Answer) -> None:
    """Another status of what is refused."""
    for named in found.get("named", []):
        if named.get("status") == 2:
            named["status"] = 3


def untrusted(found: Answer) -> None:
    """A slot for inner loops that is lost."""
    if any(axes is not None for axes in found.get("trusted", [])):
        found["trusted"] = [None for _ in found["trusted"]]


def bent(found: Answer) -> None:
    """An entry of a Jacobian."""
    if "jacobian" in found:
        found["jacobian"][0][0] += 1e-3


def displaced(found: Answer) -> None:
    """A frame."""
    if "position" in found:
        found["position"][0] += 1e-3


FAULTS: tuple[Callable[[Answer], None], ...] = (
    mirrored, moved, dropped, reworded, turned, short, permitted, untrusted, bent, displaced,
)  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", ["Kin_Scara4_ZCcoupled_Type1", "Coupled_Scara3_CCZ_CAxis_Tool"])
def test_a_planted_fault_is_found(name: str, fault: Callable[[Answer], None]) -> None:
    """The comparison finds each kind of wrong answer."""

    def wrong(one: Robot, question: Question) -> Answer:
        found = answer(one, question)
        fault(found)
        return found

    recording = read(name)
    if name.startswith("Coupled"):
        recording = recording[:1] + recording[-8:]
    parts: list[dict[str, Any]] = recording[:2] + recording[-12:]
    found = [t for part in parts for t in differences(robot(part["recipe"]), part["asked"], part["answers"], wrong)]
    is_asked = name.startswith("Kin") or fault not in (
        permitted,
        turned,
    )  # garbage and turns of pairs are asked of parts
    assert bool(found) or not is_asked, f"{fault.__name__} is not found"


def test_a_mirrored_axis_of_the_batch_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The texts on arrays are compared, too."""
    recording = read("Kin_Scara4_ZCcoupled_Type1")[:1]
    one = type(robot(recording[0]["recipe"]).made)
    original = one.inverse_batch

    def wrong(self: Any, *given: Any) -> Any:
        axes, statuses = original(self, *given)
        return -axes, statuses

    monkeypatch.setattr(one, "inverse_batch", wrong)
    assert any("inverse_batch" in text for text in compared(recording))
