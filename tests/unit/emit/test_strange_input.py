"""The generated package: what is no input, refusals with a reason, room for branches, and the same text every time."""

import os
import pickle
import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from derive.report import branch_stretches
from derive.report.branch_stretches import MOST_KEPT, MOST_SIDES, stretches_of
from tests.catalogue.references import held_at
from tests.mechanisms import catalogue, kinematics_of, named
from tests.outside import output_of

ROOT = Path(__file__).resolve().parents[3]
MECHANISMS = [m for _, m in catalogue()]
STRANGE: dict[str, Callable[[int], object]] = {
    "set": lambda n: set(map(float, range(n))),
    "frozenset": lambda n: frozenset(map(float, range(n))),
    "dict": lambda n: dict.fromkeys(map(float, range(n)), 0.0),
    "keys of a dict": lambda n: dict.fromkeys(map(float, range(n))).keys(),
    "bytes": lambda n: bytes(range(n)),
    "bytearray": lambda n: bytearray(range(n)),
    "complex numbers": lambda n: np.array([1j] * n),
    "array with a mask": lambda n: np.ma.array([1.0] * n, mask=[True] + [False] * (n - 1)),
    "array with an open mask": lambda n: np.ma.array([1.0] * n),
    "text": lambda n: "1" * n,
}


@pytest.mark.parametrize("kind", STRANGE)
def test_strange_axes_are_refused(kind: str) -> None:
    """Everywhere where numbers are expected: alone, in a row of a batch, and as the batch."""
    robot = softkin.ArticulatedRobot6DOF(d1=400.0, a2=455.0, d4=420.0)
    frame, strange = robot.forward((10.0,) * 6)[0], STRANGE[kind](6)
    calls: tuple[Callable[[], object], ...] = (
        lambda: robot.forward(strange),
        lambda: robot.orientation(strange),
        lambda: robot.jacobian(strange),
        lambda: robot.singularity(strange),
        lambda: robot.twist(strange, (0.0,) * 6),
        lambda: robot.axis_velocities((10.0,) * 6, strange),
        lambda: robot.inverse(frame, None, strange),
        lambda: robot.inverse((STRANGE[kind](3), frame.rotation)),
        lambda: robot.inverse((frame.position, [STRANGE[kind](3)] * 3)),
        lambda: robot.forward_batch(strange),
        lambda: robot.forward_batch([strange]),
        lambda: robot.forward_batch([(1.0,) * 6, strange]),
        lambda: robot.jacobian_batch([strange]),
        lambda: robot.singularity_batch([strange]),
        lambda: robot.inverse_batch([frame], None, None, [strange]),
        lambda: robot.inverse_batch([frame], None, None, strange),
    )
    for number, call in enumerate(calls):
        with pytest.raises(KinematicsError) as refusal:
            call()
        assert refusal.value.status is Status.BAD_INPUT, number


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_an_empty_batch_has_empty_arrays(mechanism: Mechanism) -> None:
    """No rows, in a list or an array: arrays of the documented shapes without rows."""
    robot = softkin.catalogue()[mechanism.name](**{p.name: p.nominal for p in mechanism.parameters})
    n, m, slots = len(robot.AXES), len(robot.CONFIGURATION), 2**robot.BRANCHES
    for machine in (robot, robot.with_base(softkin.Frame((1.0, 2.0, 3.0)))):
        for empty in ([], (), np.empty((0, n))):
            shapes = [a.shape for a in machine.forward_batch(empty)]
            assert shapes == [(0, 3), (0, 3, 3), (0, m), (0,)]
            rows = len(machine.JACOBIAN_ROWS)
            assert [a.shape for a in machine.jacobian_batch(empty)] == [(0, rows, n), (0,)]
            assert [a.shape for a in machine.singularity_batch(empty)] == [(0,), (0, len(machine.MARGINS))]
        near = [] if n else None
        for rotations in ([], np.empty((0, 3, 3))):
            assert [a.shape for a in machine.inverse_batch([], rotations, None, near)] == [(0, n), (0,)]
            assert [a.shape for a in machine.inverse_all_batch([], rotations, near)] == [(0, slots, n), (0, slots)]
        assert machine.inverse_batch(np.empty((0, 4, 4)), None, None, near)[0].shape == (0, n)
    if n:
        with pytest.raises(KinematicsError, match="must have shape"):
            robot.forward_batch([[]])


def test_the_package_says_its_version_and_its_licence() -> None:
    """One version; the licence of the project as a file of the wheel; the types of the calls are there to be named."""
    project = tomllib.loads((ROOT / "generated/python/pyproject.toml").read_text())["project"]
    assert softkin.__version__ == project["version"]
    assert project["license-files"] == ["LICENSE"]
    texts = {(ROOT / path).read_text() for path in ("LICENSE", "generated/python/LICENSE", "runtime/python/LICENSE")}
    assert len(texts) == 1
    assert {"Configuration", "Rotation", "FrameLike", "orthonormalize", "Mounted"} <= set(softkin.__all__)
    assert softkin.Rotation and softkin.Configuration and softkin.FrameLike


LENGTHS = {"arm_length_1": 300.0, "arm_length_2": 200.0}
NO_TURN = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
UPSIDE_DOWN = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))


def nominal(mechanism: Mechanism) -> softkin.Mechanism:
    return softkin.catalogue()[mechanism.name](**{p.name: p.nominal for p in mechanism.parameters})


def raised(call: Callable[..., object], *arguments: object) -> KinematicsError | None:
    try:
        call(*arguments)
    except KinematicsError as error:
        return error
    return None


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_the_error_has_the_diagnosis(mechanism: Mechanism) -> None:
    robot = nominal(mechanism)
    rng = np.random.default_rng(7)
    size = sum(abs(p.nominal) for p in mechanism.parameters if p.unit == "u") + 100.0
    refused = 0
    for k in range(40):
        frame = tuple(rng.uniform(-size, size, 3).tolist()), NO_TURN if k % 2 else UPSIDE_DOWN
        near = held_at(robot, np.zeros(len(robot.AXES)))
        error, found = raised(robot.inverse, frame, None, near), robot.diagnose(frame, None, near)
        assert (error is None) == (found.status is Status.OK)
        if error is not None:
            refused += 1
            assert error.refusal == found and error.status is found.status
            assert found.reason and str(error).endswith(found.in_words)
            text, _, unit = found.reason.partition(" [")
            amount = f", missing {float(f'{found.missing:.4g}')} {unit.rstrip(']')}".rstrip() if found.missing else ""
            assert found.in_words == f"{text}{amount}" and "[" not in found.in_words
    assert refused or not any("reach" in text or "planar" in text for text in texts_in_the_inverse(robot))


def texts_in_the_inverse(robot: softkin.Mechanism) -> list[str]:
    """The texts in the code of the inverse of one branch: a machine without a bound has none that speaks of one."""
    return [c for c in type(robot)._branch.__code__.co_consts if isinstance(c, str)]


def test_beyond_a_limit_it_says_which_turn_is_inside() -> None:
    robot = softkin.Scara2Z(**LENGTHS, lower_a1=-10.0, upper_a1=400.0)
    frame, configuration = robot.forward((-30.0, 40.0, 0.0))
    error = raised(robot.inverse, frame, configuration)
    assert error is not None and error.refusal is not None
    assert error.refusal.turn == 2 and "which is turn 2" in str(error)
    assert error.refusal.missing == pytest.approx(20.0)
    assert error.refusal == robot.diagnose(frame, configuration)


def test_a_point_off_the_flange_is_refused_with_a_reason() -> None:
    robot = softkin.Scara2Z(**LENGTHS)
    error = raised(robot.inverse_offset, (620.0, 0.0, 0.0), (100.0, 0.0, 0.0))
    assert error is not None and error.refusal is not None
    assert (error.refusal.reason, error.refusal.missing) == ("A2: out of reach [u]", pytest.approx(20.0))


def test_the_rods_of_a_scissor() -> None:
    """The plate cannot be farther from the rails than the rods are long, on either side."""
    robot = nominal(next(m for m in MECHANISMS if m.name == "Kin_P2X_Type2"))
    rod = robot.parameters["arm_length"]
    for height in (rod + 12.5, -rod - 12.5):
        found = robot.diagnose(((0.0, height, 0.0), NO_TURN))
        assert (found.reason, found.missing) == ("rod 1 (through x) cannot reach [u]", pytest.approx(12.5))


def test_a_coupled_pair_names_the_part() -> None:
    robot = softkin.Coupled(softkin.Scara2Z(**LENGTHS), softkin.CAxis(lower_c=-90.0, upper_c=90.0))
    far = (520.0, 0.0, 0.0), NO_TURN
    error = raised(robot.inverse, far)
    assert error is not None and error.refusal == robot.diagnose(far)
    assert error.refusal is not None and error.refusal.reason == "Kin_Scara2_Z: A2: out of reach [u]"
    assert error.refusal.missing == pytest.approx(20.0)


def test_an_error_travels_whole() -> None:
    error = raised(softkin.Scara2Z(**LENGTHS).inverse, ((600.0, 0.0, 0.0), NO_TURN))
    copy = pickle.loads(pickle.dumps(error))
    assert isinstance(error, softkin.KinematicsError)
    assert (copy.status, str(copy), copy.refusal) == (error.status, str(error), error.refusal)


DELTA = named("Kin_Delta_P3C_Type3")


def taken(mechanism: Mechanism) -> tuple[int, int, int]:
    """Of a fresh copy of the program of a branch: shared stretches, their sides, and the values that are kept."""
    program = replace(kinematics_of(mechanism).branch)
    shared = [s for s in stretches_of(program) if s.is_shared]
    assert all(not s.kept for s in stretches_of(program) if not s.is_shared)
    return len(shared), sum(s.sides for s in shared), sum(s.sides * len(s.kept) for s in shared)


@pytest.mark.slow
def test_there_is_room() -> None:
    """A delta shares each of its legs, and the part that all have in common."""
    stretches, sides, values = taken(DELTA)
    assert stretches >= 4 and sides <= MOST_SIDES and values <= MOST_KEPT


@pytest.mark.slow
@pytest.mark.parametrize("limit", ["MOST_SIDES", "MOST_KEPT"])
def test_what_has_no_room_is_computed_again(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some stretches keep their place, and all statements stay."""
    whole = taken(DELTA)
    statements = [i for s in stretches_of(kinematics_of(DELTA).branch) for i in s.items]
    monkeypatch.setattr(branch_stretches, limit, whole[1] - 1 if limit == "MOST_SIDES" else whole[2] - 1)
    fewer = taken(DELTA)
    assert 0 < fewer[0] < whole[0] and fewer[1] < whole[1] and fewer[2] < whole[2]
    assert [i for s in stretches_of(replace(kinematics_of(DELTA).branch)) for i in s.items] == statements
    monkeypatch.setattr(branch_stretches, limit, 0)
    assert taken(DELTA) == (0, 0, 0)


_TEXT = """
from derive.description.catalogue import MECHANISMS, load
from derive.emit.page.page import page_of
from derive.kinematics.build import build
from derive.pipeline import LANGUAGES, languages
mechanism = load(MECHANISMS / "mc_kin_type_12_xy.py")
kin = build(mechanism)
print(page_of(mechanism, kin, has_pictures=False).text)
for language in languages(wanted=LANGUAGES):
    for name, text in sorted(language.files([language.part(kin)]).items()):
        print(name, text)
"""


def _text(seed: str) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
    return output_of([sys.executable, "-c", _TEXT], env=environment, cwd=ROOT)


@pytest.mark.slow
def test_the_text_does_not_depend_on_the_hash_seed() -> None:
    first = _text("0")
    assert len(first) > 100_000 and "spanUpperX" in first
    assert _text("90210") == first
