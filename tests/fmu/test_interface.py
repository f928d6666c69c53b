"""What FMI 3.0 asks of an FMU: a valid description, instances, states, errors, sources. Answers: `tests/languages`."""

from __future__ import annotations

from math import inf, nan
from pathlib import Path
from zipfile import ZipFile

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model
from fmpy.validation import validate_fmu

from derive.emit.fmu import archive, package
from tests.c.programs import COMPILER, STRICT
from tests.corpus.dimensions import DIMENSIONS
from tests.fmu.simulated import Simulated, fmu_of
from tests.mechanisms import kinematics_of, named
from tests.outside import output_of

SCARA = "Kin_Scara4_ZCcoupled_Type1"
LENGTHS = {"link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0}
AXES = {"axes.A1": 10.0, "axes.A2": 20.0, "axes.A3": 5.0, "axes.A4": 30.0}
OUTSIDE = {"target.x": 600.0}


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_the_description_is_valid(name: str) -> None:
    """By the schema of FMI, and by FMPy's rules for names, units, starts and structure."""
    assert validate_fmu(str(fmu_of(name).file)) == []


def test_parameters_have_units_ranges_and_words() -> None:
    """As the description of the machine has them; a length has no default, and the machine refuses 0."""
    found = {one.name: one for one in fmu_of(SCARA).description.modelVariables}
    one = found["parameters.link_length_1"]
    assert (one.unit, one.variability, float(one.start), float(one.max)) == ("u", "fixed", 0.0, 1e9)
    assert float(one.min) > 0.0 and one.description.endswith("it must be given")
    assert found["parameters.check_limits"].type == "Boolean" and found["parameters.check_limits"].start == "true"


def test_instances_do_not_know_each_other() -> None:
    """Each has its own parameters, inputs and outputs."""
    one, other = (Simulated(fmu_of(SCARA), LENGTHS | {"link_length_2": length}) for length in (225.0, 425.0))
    for machine in (one, other):
        machine.set(AXES)
    (first,), (second,) = one.get("pose.x"), other.get("pose.x")
    assert abs(second - first - 200.0 * 0.8660254037844387) < 1e-9
    one.set(OUTSIDE), other.set(OUTSIDE)
    assert one.get("solution.status") == [3] and other.get("solution.status") == [0]
    one.close(), other.close()


def test_outputs_keep_the_last_answer() -> None:
    """A frame out of reach has a status and a reason, and does not move the axes; no input is too odd for that."""
    machine = Simulated(fmu_of(SCARA), LENGTHS)
    machine.set({"target.x": 300.0, "target.y": 200.0})
    before = machine.all_of("solution.axes")
    for value in (600.0, nan, inf, -1e300):
        machine.set({"target.x": value})
        assert machine.status("solution")["status"] in (2, 3) and machine.all_of("solution.axes") == before
    machine.close()


def test_states() -> None:
    """A state brings back inputs, parameters and outputs, also as bytes; a reset brings back the begin."""
    machine = Simulated(fmu_of(SCARA), LENGTHS)
    machine.set(AXES | OUTSIDE)
    known = [machine.all_of("pose"), machine.status("solution")]
    state = machine.slave.getFMUState()
    kept = machine.slave.serializeFMUState(state)
    machine.set({"axes.A1": 50.0, "target.x": 300.0})
    assert [machine.all_of("pose"), machine.status("solution")] != known
    for one in (state, machine.slave.deserializeFMUState(kept)):
        machine.slave.setFMUState(one)
        assert [machine.all_of("pose"), machine.status("solution")] == known
        machine.slave.freeFMUState(one)
    machine.slave.reset()
    assert machine.get("axes.A1", "parameters.link_length_1") == [0.0, 0.0]
    machine.slave.freeInstance()


def test_what_is_refused() -> None:
    """Another token, a missing length, a parameter after the initialization, a type that a variable has not."""
    fmu = fmu_of(SCARA)
    with pytest.raises(Exception, match="instantiate"):
        fmu.begun(token="{00000000-0000-0000-0000-000000000000}")
    with pytest.raises(FMICallException, match="fmi3ExitInitializationMode"):
        Simulated(fmu, LENGTHS | {"link_length_1": 0.0})
    machine = Simulated(fmu, LENGTHS)
    with pytest.raises(FMICallException, match="fmi3SetFloat64"):
        machine.set({"parameters.link_length_1": 300.0})
    for written in ("pose.x", "time"):
        with pytest.raises(FMICallException, match="fmi3SetFloat64"):
            machine.set({written: 1.0})
    with pytest.raises(FMICallException, match="fmi3GetInt8"):
        machine.slave.getInt8([fmu.references["pose.x"]])
    with pytest.raises(FMICallException, match="fmi3GetFloat64"):
        machine.slave.getFloat64([len(fmu.references)])
    machine.close()


def test_model_exchange() -> None:
    """There are no states and no events, so that a solver only asks for the outputs."""
    fmu = fmu_of(SCARA)
    own = fmu.description.modelExchange.modelIdentifier
    model = FMU3Model(
        guid=fmu.description.guid, unzipDirectory=str(fmu.folder), modelIdentifier=own, instanceName="machine"
    )
    model.instantiate()
    model.enterInitializationMode()
    model.setFloat64([fmu.references[f"parameters.{name}"] for name in LENGTHS], list(LENGTHS.values()))
    model.exitInitializationMode()
    model.updateDiscreteStates()
    model.enterContinuousTimeMode()
    model.setTime(0.5)
    assert model.getFloat64([fmu.references[name] for name in ("time", "pose.x")]) == [0.5, 550.0]
    model.terminate()
    model.freeInstance()


@pytest.mark.parametrize("options", ((), ("-DFMI3_FUNCTION_PREFIX=arm_",)), ids=("library", "one program of several"))
def test_sources_compile_without_a_warning(options: tuple[str, ...]) -> None:
    """As C99, also with the prefix that FMI has for sources of several FMUs in one program."""
    command = [COMPILER, *STRICT, *options, "-S", "softkin_fmu.c", "-o", "-"]
    assert ("arm_fmi3DoStep" in output_of(command, cwd=fmu_of(SCARA).folder / "sources")) == bool(options)


def test_the_same_machine_is_the_same_archive(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Without a compiler it has the sources alone."""
    part = package.part(kinematics_of(named(SCARA)))
    assert part is not None
    texts = package.files([part])
    monkeypatch.setattr(archive.shutil, "which", lambda name: None)
    one, other = (package.finished(texts) for _ in range(2))
    assert one == other
    (tmp_path / "a.fmu").write_bytes(*one.values())
    with ZipFile(tmp_path / "a.fmu") as found:
        assert not [path for path in found.namelist() if path.startswith("binaries")]
        assert (
            found.read("sources/scara4_zccoupled_type1.c").decode()
            == texts["scara4_zccoupled_type1/sources/scara4_zccoupled_type1.c"]
        )
