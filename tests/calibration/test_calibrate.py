"""Planted deviations are found again from noisy samples; what samples do not determine is named, and stays."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from softkin import Calibration, KinematicsError, Mechanism, Status

from derive.command.line import main
from tests.calibration.machines import LOOPS, SERIAL, Planted, Truth, drawn_axes, planted

Array = NDArray[np.float64]
POSITION, TURN = 0.01, 1e-4
"""The noise: 10 micrometres and 0.1 mrad."""
CASES = {
    "Kin_ArticulatedRobot_6DOF": ("pose", ["tilt", "shift"]),
    "Kin_Ac6_ThreeParallel": ("pose", ["tilt", "shift"]),
    "Kin_Scara3_Z": ("point", ["tilt", "shift", "tool_x", "tool_y", "tool_z"]),
    "Softkin_TableTable_AC": ("pose", ["tilt", "shift", "tool"]),
    "Kin_Delta_P3C_Type3": ("point", ["arm", "offset", "base_x", "base_y", "base_z", "base_a", "base_b"]),
}
"""What is measured, and what is looked for; what `arm` stands for are the inner and the outer arms."""
WORDS = {"arm": [f"{side}_arm_{i}" for side in ("inner", "outer") for i in "123"]}


def words_of(name: str) -> list[str]:
    """The parameters that are looked for."""
    return [part for word in CASES[name][1] for part in WORDS.get(word, [word])]


def machine_of(name: str, rng: Generator) -> Planted:
    """A machine with deviations in what is looked for alone."""
    machine, words = planted(name, rng, 0.3), words_of(name)
    own = {n: v for n, v in machine.deviations.items() if any(w == n or f"_{w}" in n or n.startswith(w) for w in words)}
    return Planted(name, machine.given, own)


def samples_of(machine: Planted, count: int, rng: Generator, noise: float = 1.0, what: str = "pose") -> dict[str, Any]:
    """Samples of a machine: of a serial one by its chain multiplied out."""
    robot = machine.nominal
    if machine.name in LOOPS:
        axes = rng.uniform(0.0, 55.0, (count, 3))
        positions, rotations, *_ = machine.true.forward_batch(axes)
    else:
        axes, truth = np.array(drawn_axes(robot, count, rng)), Truth(machine.name, machine.given, machine.deviations)
        frames = np.array([truth.forward(row) for row in axes])
        positions, rotations = frames[:, :3, 3], frames[:, :3, :3]
    found: dict[str, Any] = {axis.name: axes[:, k] for k, axis in enumerate(robot.AXES)}
    seen = positions + rng.normal(0.0, noise * POSITION, positions.shape)
    found |= dict(zip("xyz", seen.T, strict=True))
    found["sigma_x"] = np.full(count, POSITION)
    if what == "pose":
        turned = Rotation.from_rotvec(rng.normal(0.0, noise * TURN, (count, 3))) * Rotation.from_matrix(rotations)
        found |= dict(zip(("qx", "qy", "qz", "qw"), turned.as_quat().T, strict=True))
    return found


def misses(found: Calibration, planted_there: Mapping[str, float]) -> dict[str, float]:
    """By how many standard deviations each one is missed, where what is held moves the samples through others."""
    expected = {
        name: planted_there.get(name, 0.0)
        + sum(planted_there.get(held, 0.0) * shares.get(name, 0.0) for held, shares in found.held.items())
        for name in found.deviations
    }
    return {name: (found.deviations[name] - expected[name]) / found.sigma[name] for name in expected}


def predicted(found: Mechanism, machine: Planted, rng: Generator) -> float:
    """The root mean square of how far the machine that was found is from the true one, at new poses."""
    count = 20
    axes = rng.uniform(5.0, 50.0, (count, 3)) if machine.name in LOOPS else drawn_axes(machine.nominal, count, rng)
    apart = found.forward_batch(axes)[0] - machine.true.forward_batch(axes)[0]
    return float(np.sqrt((apart**2).sum(axis=1).mean()))


@pytest.mark.parametrize("name", CASES)
def test_without_noise_the_machine_is_found(name: str) -> None:
    """All its frames, and each deviation that is determined by itself."""
    rng = np.random.default_rng(1)
    machine = machine_of(name, rng)
    samples = samples_of(machine, 30, rng, 0.0, CASES[name][0])
    found = softkin.calibrate(machine.nominal, samples, parameters=words_of(name))
    assert predicted(found.machine, machine, rng) < 1e-6
    assert found.after.position < 1e-7 and not found.outliers
    if not found.held:
        assert found.deviations == pytest.approx(dict(machine.deviations), abs=1e-6)
    assert not any(found.machine.deviations[name] for name in found.held)


@pytest.mark.parametrize(
    ("draws", "least", "most"), [(3, 0.85, 1.01), pytest.param(25, 0.92, 0.98, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("name", CASES)
def test_with_noise_it_is_found_within_its_standard_deviations(
    name: str, draws: int, least: float, most: float
) -> None:
    """Two standard deviations hold 95 % of the draws; new poses are predicted within the noise."""
    rng, noise = np.random.default_rng(2 if draws == 3 else 3), 1.5 * np.sqrt(3.0) * POSITION
    inside = []
    for number in range(draws):
        machine = machine_of(name, rng)
        samples = samples_of(machine, 40, rng, 1.0, CASES[name][0])
        found = softkin.calibrate(machine.nominal, samples, parameters=words_of(name))
        inside += [abs(miss) < 2.0 for miss in misses(found, machine.deviations).values()]
        if number < 3:
            assert found.after.position < found.left_out.position < noise < found.before.position
            assert draws > 3 or predicted(found.machine, machine, rng) < noise
    assert least < np.mean(inside) < most


def test_what_samples_do_not_determine_is_named_and_held() -> None:
    """The base of a SCARA follows from its lines and its tool; points say nothing of the turn of the tool."""
    rng = np.random.default_rng(4)
    machine = Planted("Kin_Scara3_Z", SERIAL["Kin_Scara3_Z"], {"base_x": 2.0, "tool_a": 0.3, "a2_shift_x": 0.5})
    found = softkin.calibrate(machine.nominal, samples_of(machine, 30, rng, 1.0, "point"))
    assert {"base_x", "base_z", "tool_a", "a3_offset"} <= set(found.held)
    assert not found.held["tool_a"] and found.held["base_z"] == pytest.approx({"tool_z": 1.0}, abs=1e-6)
    assert found.machine.deviations["tool_a"] == 0.0 == found.machine.deviations["base_x"]
    assert max(map(abs, misses(found, machine.deviations).values())) < 4.0
    first = softkin.calibrate(machine.nominal, samples_of(machine, 30, rng, 1.0, "point"), parameters=["base", "shift"])
    assert "base_x" in first.deviations and "a1_shift_y" in first.held


def test_outliers_are_named() -> None:
    """A row that is missed by a millimetre, where no standard deviation is given."""
    rng = np.random.default_rng(5)
    machine = machine_of("Kin_Scara3_Z", rng)
    samples = samples_of(machine, 40, rng, 1.0, "point")
    samples["y"][7] += 1.0
    del samples["sigma_x"]
    found = softkin.calibrate(machine.nominal, samples, parameters=words_of("Kin_Scara3_Z"))
    assert found.outliers == (7,) and "rows 7" in str(found)
    assert found.after.position == pytest.approx(np.sqrt(3.0) * POSITION, rel=0.5)


def test_samples_may_be_mixed() -> None:
    """Poses, points, z alone, distances from the first point, angles of SoftMotion; rows with empty entries."""
    rng = np.random.default_rng(6)
    machine = machine_of("Kin_Scara3_Z", rng)
    columns = samples_of(machine, 45, rng, 0.0)
    rows = []
    for k in range(45):
        row: dict[str, Any] = {name: str(values[k]) for name, values in columns.items()}
        if k % 3:  # no rotation, and z alone, or a distance
            row |= dict.fromkeys(("qx", "qy", "qz", "qw"), "")
        if k % 3 == 2:
            apart = [columns[c][k] - columns[c][0] for c in "xyz"]
            row |= {"x": "", "y": "", "distance": float(np.linalg.norm(apart))}
        rows.append(row)
    found = softkin.calibrate(machine.nominal, rows, parameters=words_of("Kin_Scara3_Z"))
    assert found.after.distance < 1e-7 and found.after.rotation < 1e-7 and predicted(found.machine, machine, rng) < 1e-6
    quaternions = np.stack([columns.pop(q) for q in ("qx", "qy", "qz", "qw")], axis=1)
    angles = np.array([softkin.Frame.from_quaternion(q).euler for q in quaternions])
    columns |= dict(zip("abc", angles.T, strict=True))
    again = softkin.calibrate(machine.nominal, columns, parameters=words_of("Kin_Scara3_Z"))
    assert again.after.rotation < 0.2


def test_samples_may_be_arrays() -> None:
    """As batches have them."""
    rng = np.random.default_rng(10)
    machine = machine_of("Softkin_TableTable_AC", rng)
    axes = drawn_axes(machine.nominal, 30, rng)
    positions, rotations, *_ = machine.true.forward_batch(axes)
    found = softkin.calibrate(machine.nominal, {"axes": axes, "positions": positions, "rotations": rotations})
    assert found.after.position < 1e-7 and predicted(found.machine, machine, rng) < 1e-6
    with pytest.raises(KinematicsError, match=r"axes must have the shape \(N, 5\), not \(2, 2\)"):
        softkin.calibrate(machine.nominal, {"axes": np.zeros((2, 2)), "positions": np.zeros((2, 3))})


def test_a_calibrated_machine_in_radians_is_calibrated_further() -> None:
    """It starts at the deviations that it has; axes are in its unit."""
    rng = np.random.default_rng(7)
    machine = machine_of("Kin_ArticulatedRobot_6DOF", rng)
    samples = samples_of(machine, 30, rng, 0.0)
    samples |= {f"A{k}": np.radians(samples[f"A{k}"]) for k in range(1, 7)}
    before = machine.nominal.calibrated({"base_z": 0.5, "a2_tilt_x": 0.1}).in_radians()
    found = softkin.calibrate(before, samples, parameters=["tilt", "shift", "base"])
    assert found.after.position < 1e-6


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"A2": None}, "there is no column 'A2'"),
        ({"sigma_u": [1.0]}, "the column 'sigma_u' is unknown"),
        ({"x": ["a"]}, "row 0: x must be a number, not 'a'"),
        ({"A1": [""]}, "row 0: every sample needs the values of all axes"),
        ({"qx": [0.0]}, "a rotation needs all of the columns qx, qy, qz, qw"),
        ({"x": [""], "y": [""], "z": [""]}, "nothing was measured"),
        ({"sigma_x": [0.0]}, "row 0: sigma_x must be more than 0"),
    ],
)
def test_samples_are_checked(change: Mapping[str, Sequence[Any] | None], message: str) -> None:
    """One clear message: which column, which row."""
    given = {"A1": [0.0], "A2": [10.0], "A3": [0.0], "Z": [5.0], "x": [1.0], "y": [2.0], "z": [3.0], **change}
    robot = Planted("Kin_Scara3_Z", SERIAL["Kin_Scara3_Z"], {}).nominal
    with pytest.raises(KinematicsError, match=message) as caught:
        softkin.calibrate(robot, {name: values for name, values in given.items() if values is not None})
    assert caught.value.status is Status.BAD_INPUT
    with pytest.raises(KinematicsError, match="no deviation 'a2_tlt_x': did you mean 'a2_tilt_x'"):
        softkin.calibrate(robot, {n: [1.0] for n in ("A1", "A2", "A3", "Z", "x", "y", "z")}, parameters=["a2_tlt_x"])


def test_proposed_poses_are_better_than_random_ones() -> None:
    """Inside the limits, regular, each once; the least determined deviation is known better."""
    rng = np.random.default_rng(8)
    machine = machine_of("Kin_ArticulatedRobot_6DOF", rng)
    robot = machine.nominal.changed(limits={"A2": (-150.0, 20.0), "A3": (-60.0, 150.0)})
    words = words_of(machine.name)
    poses = softkin.propose(robot, 12, parameters=words)
    assert len(set(poses)) == 12 and poses == softkin.propose(robot, 12, parameters=words)
    assert all(-150.0 <= axes[1] <= 20.0 and -60.0 <= axes[2] <= 150.0 for axes in poses)
    assert all(not robot.singularity(axes).is_singular for axes in poses)

    def volume(axes: Sequence[Sequence[float]]) -> float:
        positions, rotations, *_ = machine.true.forward_batch(axes)
        quaternions = Rotation.from_matrix(rotations).as_quat()
        samples = {f"A{k + 1}": column for k, column in enumerate(np.array(axes).T)}
        samples |= dict(zip("xyz", positions.T, strict=True)) | {"sigma_x": np.full(len(positions), POSITION)}
        samples |= dict(zip(("qx", "qy", "qz", "qw"), quaternions.T, strict=True))
        return softkin.calibrate(robot, samples, parameters=words).observability

    assert volume(poses) > 1.1 * volume(drawn_axes(robot, 12, rng))
    with pytest.raises(KinematicsError, match="inside limits: give those of Z"):
        softkin.propose(Planted("Kin_Scara3_Z", SERIAL["Kin_Scara3_Z"], {}).nominal, 3)


def test_the_command_writes_the_machine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """From a CSV file with semicolons to a machine that `softkin.load` reads; and poses to measure."""
    rng = np.random.default_rng(9)
    machine = machine_of("Kin_Scara3_Z", rng)
    columns = samples_of(machine, 30, rng, 0.0, "point")
    lines = [";".join(columns), *(";".join(str(v[k]) for v in columns.values()) for k in range(30))]
    (tmp_path / "samples.csv").write_text("\n".join(lines))
    robot = machine.nominal.changed(limits={"Z": (0.0, 200.0)})
    (tmp_path / "machine.json").write_text(robot.to_json())
    given = [str(tmp_path / "samples.csv"), "--machine", str(tmp_path / "machine.json")]
    words = ["--parameters", "tilt", "shift", "offset", "tool"]
    assert main(["calibrate", *given, "--out", str(tmp_path / "true.json"), *words]) == 0
    assert "deviations found" in capsys.readouterr().out
    assert predicted(softkin.load(tmp_path / "true.json"), machine, rng) < 1e-6
    assert main(["calibrate", *given, "--propose", "3"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0] == "A1,A2,A3,Z" and len(out) == 4
    assert main(["calibrate", *given[:2], str(tmp_path / "samples.csv")]) == 2
    assert "this is no JSON" in capsys.readouterr().err
    assert main(["calibrate", "--machine", "x.json"]) == 2
    assert "which samples?" in capsys.readouterr().err
