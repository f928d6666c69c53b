"""Whatever a call is given, it throws nothing: it ends in a status, and writes results only where that is 0."""

from typing import Any

import pytest

from tests.corpus.dimensions import DIMENSIONS
from tests.javascript.modules import module_of
from tests.javascript.node import UNDEFINED, ask, run

NAN, INFINITY = float("nan"), float("inf")
TURNED = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
FRAME = {"position": [300.0, 100.0, 50.0], "rotation": TURNED}
RESULTS = {"axes", "frame", "configuration", "margins", "rows", "bodies", "values"}
NAMES = (
    "Kin_Scara4_ZCcoupled_Type1", "Kin_Hexapod", "Kin_Delta_P3C_Type3", "Kin_Ac6_RZRYRYRXRYRZ_J6Offset",
    "Softkin_ScaraOnRail", "Kin_Tool",
)  # fmt: skip
NO_NUMBERS: list[Any] = [
    NAN, INFINITY, None, "text", 1.0, True, {}, [], [NAN], ["1", "2", "3", "4"], [None] * 4, [[1.0]] * 4, UNDEFINED,
    {"length": 4}, "1234",
]  # fmt: skip
FRAMES: list[Any] = [
    *NO_NUMBERS,
    {"position": [1.0, 2.0], "rotation": TURNED},
    {"position": [NAN, 2.0, 3.0], "rotation": TURNED},
    {"position": [1e300, 2.0, 3.0], "rotation": TURNED},
    {"position": "abc", "rotation": TURNED},
    {"position": [1.0, 2.0, 3.0]},
    {"position": [1.0, 2.0, 3.0], "rotation": [1.0, 0.0, 0.0]},
    {"position": [1.0, 2.0, 3.0], "rotation": [[1.0, 0.0], [0.0, 1.0]]},
    {"position": [1.0, 2.0, 3.0], "rotation": [[0.0] * 3] * 3},
    {"position": [1.0, 2.0, 3.0], "rotation": [[INFINITY] * 3] * 3},
]
BYTES: list[Any] = [*NO_NUMBERS, [1.5, 0, 0, 0], [300, 0, 0, 0], [9, 0, 0, 0], [-1, 0, 0, 0], [NAN] * 4]


@pytest.mark.parametrize("name", NAMES)
def test_every_call_ends_in_a_status(name: str) -> None:
    """Results are there where the status is 0, and a reason where it is not."""
    axes = len(ask(module_of(name), [])["description"]["axes"])
    near = [0.0] * axes
    calls = [[call, v] for call in ("forward", "jacobian", "singularity", "limited", "scene") for v in NO_NUMBERS]
    calls += [[call, [v] * axes] for call in ("forward", "jacobian", "singularity", "scene") for v in NO_NUMBERS]
    calls += [[call, near, frame] for call in ("forward", "scene") for frame in FRAMES]
    calls += [["inverse", frame, None, near] for frame in FRAMES] + [["inverseAll", frame, near] for frame in FRAMES]
    calls += [["inverse", FRAME, given, near] for given in BYTES]
    calls += [["inverse", FRAME, None, given] for given in NO_NUMBERS]
    calls += [["inverseAll", FRAME, given] for given in NO_NUMBERS] + [["inverse"], ["forward"], ["scene"]]
    found = ask(module_of(name), [{"parameters": DIMENSIONS[name], "calls": calls}])["answers"][0]["found"]
    for call, answer in zip(calls, found, strict=True):
        if answer["status"] == 0:
            slots = answer.get("slots", [answer])
            assert all(_is_sound(slot) for slot in slots), (call, answer)
        else:
            assert answer["status"] in range(1, 6), (call, answer)
            assert answer["reason"] and not RESULTS & answer.keys(), (call, answer)
    refused = [answer["status"] for answer in found if answer["status"]]
    assert len(refused) > (len(calls) / 3 if axes else 20)


def _is_sound(answer: dict[str, Any]) -> bool:
    """Whether results have numbers alone, and a refused slot none."""
    if answer["status"]:
        return "axes" not in answer and bool(answer["reason"])
    return all(number == number for number in _numbers(answer))


def _numbers(value: Any) -> list[float]:
    if isinstance(value, dict | list):
        return [n for part in (value.values() if isinstance(value, dict) else value) for n in _numbers(part)]
    return [value] if isinstance(value, float | int) else []


@pytest.mark.parametrize(
    "given",
    [
        None, "text", [], 4.0, {"link_length_1": 300.0}, {"link_length_1": 300.0, "link_length_2": NAN},
        {"link_length_1": 300.0, "link_length_2": "250"}, {"link_length_1": 300.0, "link_length_2": 0.0},
        {"link_length_1": 300.0, "link_length_2": 2e9}, {"link_length_1": 300.0, "link_length_2": -1.0},
        {"link_length_1": 300.0, "link_length_2": 250.0, "link_length_3": 1.0},
        {"link_length_1": 300.0, "link_length_2": 250.0, "check_limits": 2.0},
        {"link_length_1": 300.0, "link_length_2": 250.0, "lower_a1": 10.0, "upper_a1": -10.0},
        {"link_length_1": INFINITY, "link_length_2": 250.0},
    ],
    ids=str,
)  # fmt: skip
def test_a_machine_that_cannot_be_is_refused(given: Any) -> None:
    """With a reason, and the names of the parameters that are at fault."""
    made = ask(module_of("Kin_Scara4_ZCcoupled_Type1"), [{"parameters": given, "calls": []}])["answers"][0]["made"]
    assert made["status"] == 1 and made["reason"]
    if isinstance(given, dict):
        assert made["parameters"] and made["parameters"][0].startswith(("link_length_", "check_", "lower_"))


def test_objects_that_throw() -> None:
    """What throws when it is read is refused as anything else, and a machine cannot be changed."""
    script = """
      const thrower = new Proxy([], { get() { throw new Error("no"); }, ownKeys() { throw new Error("no"); },
        getOwnPropertyDescriptor() { throw new Error("no"); }, has() { throw new Error("no"); } });
      const holder = { get position() { throw new Error("no"); } };
      const { machine } = module.create({ link_length_1: 325, link_length_2: 225 });
      const before = machine.forward([10, 20, 30, 40]).frame.position[0];
      let changes = 0;
      for (const change of [() => { machine.parameters.link_length_1 = 1; }, () => { machine.limits = []; },
        () => { module.description.axes[0].name = "B"; }]) {
        try { change(); } catch { changes += 1; }
      }
      return {
        statuses: [machine.forward(thrower), machine.inverse(thrower), machine.inverse(holder),
          machine.inverse({ position: thrower, rotation: thrower }), machine.inverseAll(holder, thrower),
          machine.jacobian(new Float32Array(3)), machine.jacobian([1n, 2n, 3n, 4n]), machine.forward(Symbol.iterator),
          machine.inverse({ position: [1, 2, 3], rotation: [[1, 0, 0], thrower, [0, 0, 1]] }),
          module.create(thrower)].map((answer) => answer.status),
        typed: machine.forward(new Float64Array([10, 20, 30, 40])).frame.position[0] === before,
        changes,
      };
    """
    found = run(module_of("Kin_Scara4_ZCcoupled_Type1"), script)
    assert found["statuses"] == [2] * 9 + [1]
    assert found["typed"] and found["changes"] == 3
