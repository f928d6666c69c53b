"""`compile_mechanism`: a description becomes a class of `softkin` at once, the generated one in all but name."""

import importlib.util
import inspect
import pickle
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import softkin

from derive import compile_mechanism
from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import DescriptionError, branch
from derive.solver.unsolved import Unsolved
from tests.command.files import RAIL, ROOT
from tests.outside import output_of

NAMES = {
    "kin_scara4_zccoupled_type1.py": softkin.Scara4ZCcoupledType1,
    "kin_bipod_rotary.py": softkin.BipodRotary,
    "kin_wrist2.py": softkin.Wrist2,
}


@pytest.mark.parametrize("file", NAMES)
def test_the_live_class_is_the_generated_one(file: str) -> None:
    """Every text is the same but for the name of its module; so is everything that a class offers."""
    generated = NAMES[file]
    live = compile_mechanism(load(MECHANISMS / file))
    assert issubclass(live, softkin.Mechanism) and live is not generated
    name = live.__module__.rpartition(".")[2]
    own = generated.__module__.rpartition(".")[2]
    for package in ("softkin", "softkin._array_programs", "softkin._unrolled"):
        if importlib.util.find_spec(f"{package}.{own}") is not None:
            text = inspect.getsource(importlib.import_module(f"{package}.{name}"))
            assert text.replace(name, own) == inspect.getsource(importlib.import_module(f"{package}.{own}"))
    assert set(dir(live)) == set(dir(generated))


def test_scalar_calls_batches_couplings_and_pickles() -> None:
    """A live machine does what others do, beside them."""
    live = compile_mechanism(MECHANISMS / "kin_scara4_zccoupled_type1.py")
    given = {"link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0}
    robot, other = live(**given), softkin.Scara4ZCcoupledType1(**given)
    axes = (10.0, 20.0, 5.0, 30.0)
    assert robot.forward(axes) == other.forward(axes)
    frame, configuration = robot.forward(axes)
    assert robot.inverse(frame, configuration, axes) == other.inverse(frame, configuration, axes)
    poses = np.array([frame.position]), np.array([frame.rotation])
    assert np.array_equal(robot.inverse_all_batch(*poses)[0], other.inverse_all_batch(*poses)[0])
    assert robot.branches(frame) == other.branches(frame)
    coupled = softkin.Coupled(robot, softkin.Tool(tool_z=-50.0))
    assert coupled.forward(axes)[0].position[2] == pytest.approx(frame.position[2] - 50.0)
    assert pickle.loads(pickle.dumps(robot)).forward(axes) == robot.forward(axes)


def test_two_machines_of_one_name_are_two() -> None:
    """A cell of a notebook that is executed again gives the new machine, and leaves the old one as it was."""
    first = compile_mechanism(load(MECHANISMS / "kin_gantry2.py"))
    mechanism = load(MECHANISMS / "kin_gantry3.py")
    second = compile_mechanism(replace(mechanism, name="Kin_Gantry2"))
    assert (first.__name__, second.__name__) == ("Gantry2", "Gantry2")
    assert (len(first.AXES), len(second.AXES), len(softkin.Gantry2.AXES)) == (2, 3, 2)
    assert "Kin_Gantry2" in softkin.catalogue() and softkin.catalogue()["Kin_Gantry2"] is softkin.Gantry2


def test_what_is_wrong_is_said_with_its_remedy(tmp_path: Path) -> None:
    """A file is named with its line; a description of a notebook has none."""
    scara = load(MECHANISMS / "kin_scara3_ccz.py")
    wrong = replace(scara, branches=(branch("elbow", scara.joints[0].symbol, right=+1, left=-1),))
    with pytest.raises(
        DescriptionError, match=r"^branch 'elbow': its indicator agrees with 0 steps, .*softkin explain"
    ):
        compile_mechanism(wrong)
    path = tmp_path / "rail.py"
    path.write_text(RAIL.replace("Ty(A2)", "Tx(A2)"))
    with pytest.raises(Unsolved, match=rf"^{re.escape(str(path))}:9: the closure does not determine a1, a2"):
        compile_mechanism(path)
    path.write_text(RAIL.replace("joints=(A1, A2)", "joints=(A1, A2, A2)"))
    with pytest.raises(DescriptionError, match=rf"^{re.escape(str(path))}:\d+: joint 'A2' is given 2 times; give each"):
        compile_mechanism(path)
    with pytest.raises(TypeError, match="takes a Mechanism, or the path of its file"):
        compile_mechanism(7)  # type: ignore[arg-type]


WITHOUT = """
import sys
from pathlib import Path
from derive import compile_mechanism
assert not {"sympy", "derive.pipeline"} & set(sys.modules), "the compiler is loaded when it is used"
Rail = compile_mechanism(sys.argv[1])
import softkin
assert softkin.catalogue() == {} and issubclass(Rail, softkin.Mechanism)
print(Rail().forward((1.0, 2.0))[0].position, Rail().inverse_batch([[1.0, 2.0, 0.0]], None)[0], softkin.__file__)
"""


@pytest.mark.slow
def test_without_an_installed_softkin_the_compiler_brings_it(tmp_path: Path) -> None:
    """The runtime is a part of the compiler; its folder is gone when the program ends."""
    path = tmp_path / "rail.py"
    path.write_text(RAIL)
    said = output_of([sys.executable, "-c", WITHOUT, str(path)], cwd=tmp_path, env={"PYTHONPATH": str(ROOT)})
    position, batch, file = re.fullmatch(r"(\(.*?\)) (\[\[.*?\]\]) (.*)\n", said).groups()  # type: ignore[union-attr]
    assert (position, batch) == ("(1.0, 2.0, 0.0)", "[[1. 2.]]")
    assert "runtime" in file and not Path(file).exists()


@pytest.mark.slow
def test_an_installed_softkin_of_another_version_is_refused(tmp_path: Path) -> None:
    """Modules are never mixed with a runtime that they were not written for."""
    package = tmp_path / "softkin"
    package.mkdir()
    (package / "__init__.py").write_text("")
    path = tmp_path / "rail.py"
    path.write_text(RAIL)
    code = f"from derive import compile_mechanism; compile_mechanism({str(path)!r})"
    env = {"PYTHONPATH": f"{tmp_path}:{ROOT}"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=env, capture_output=True, text=True, check=False
    )
    assert "GenerationError: the softkin in" in done.stderr
    assert "was written by another version of this compiler" in done.stderr
