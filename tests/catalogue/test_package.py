"""The package as a whole: its names, the time of its import, and the properties of its classes."""

import subprocess
import sys
from pathlib import Path

import pytest
import softkin

from derive.description.mechanism import Kind, Mechanism
from tests.catalogue.machines import Machine
from tests.mechanisms import catalogue

PACKAGE = Path(softkin.__file__).resolve().parents[1]
IMPORT = """
import sys, time
start = time.process_time()
import softkin
seconds = time.process_time() - start
assert "numpy" not in sys.modules, "numpy"
robot = softkin.Gantry2()
assert robot.inverse(robot.forward((1.0, 2.0))[0]) == (1.0, 2.0)
assert robot.inverse_all(((1.0, 2.0, 0.0), None))[0].axes == (1.0, 2.0)
robot.jacobian((1.0, 2.0)); robot.singularity((1.0, 2.0)); robot.orientation_image(); repr(robot)
assert len(softkin.catalogue()) >= 21
assert "numpy" not in sys.modules, "numpy"
foreign = [n for n in sys.modules if n.split(".")[0] in ("sympy", "casadi", "jinja2", "derive")]
assert not foreign, foreign
robot.forward_batch([(1.0, 2.0)])
assert "numpy" in sys.modules
print(seconds)
"""


def test_import_is_cheap_and_needs_no_numpy() -> None:
    """Scalar calls run on the standard library; NumPy comes with the first batch.

    What counts is the processor time of `import softkin` alone, in a process whose interpreter has started: the best of
    three, since the first may still have to compile the modules.
    """
    seconds = []
    for _ in range(3):
        done = subprocess.run(
            [sys.executable, "-c", IMPORT],
            env={"PYTHONPATH": str(PACKAGE)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        seconds.append(float(done.stdout))
    assert min(seconds) < 0.1


def test_the_catalogue_is_the_descriptions() -> None:
    assert set(softkin.catalogue()) == {m.name for _, m in catalogue()}
    assert "Kin_Scara4_ZCCC" in softkin.catalogue()
    assert len(softkin.catalogue()) == 75


def test_everything_that_is_offered_is_there() -> None:
    """Every public name of the package exists and has a docstring."""
    for name in softkin.__all__:
        assert getattr(softkin, name).__doc__
    classes = {c.__name__: c for c in softkin.catalogue().values()}
    assert len(classes) == len(softkin.catalogue())
    assert set(classes) <= set(softkin.__all__) <= set(dir(softkin))
    assert all(getattr(softkin, name) is found for name, found in classes.items())
    with pytest.raises(AttributeError, match="Scara5"):
        softkin.Scara5  # noqa: B018


def test_an_alias_is_a_class_of_its_own_with_the_same_kinematics() -> None:
    given = {"link_length_1": 300.0, "link_length_2": 250.0, "link_length_3": 80.0}
    alias, original = (softkin.catalogue()[n](**given) for n in ("Kin_Scara4_ZCCC", "Kin_Scara3_ZCCC"))
    assert type(alias) is not type(original)
    assert (alias.NAME, original.NAME) == ("Kin_Scara4_ZCCC", "Kin_Scara3_ZCCC")
    axes = (100.0, 10.0, -20.0, 400.0)
    assert alias.forward(axes) == original.forward(axes)


def test_the_example_of_the_documentation() -> None:
    robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0)
    frame, configuration = robot.forward((10.0, 20.0, 5.0, 30.0))
    axes = robot.inverse(frame, configuration, reference=(0, 0, 0, 0))
    assert axes == pytest.approx((10.0, 20.0, 5.0, 30.0), abs=1e-12)
    slots = robot.inverse_all(frame)
    assert [s.configuration[0] for s in slots] == [1, 2]
    assert set(robot.singularity(axes).margins) == {"elbow"}
    assert not robot.singularity(axes).is_singular
    assert softkin.catalogue()["Kin_Scara4_ZCcoupled_Type1"] is softkin.Scara4ZCcoupledType1


def test_axes_are_those_of_the_description(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    robot = machines[0].robot
    assert mechanism.name == robot.NAME
    described = [
        (j.name, j.kind.value, "deg" if j.kind is not Kind.LINEAR else "u", j.multi_turn) for j in mechanism.joints
    ]
    assert [(a.name, a.kind, a.unit, a.multi_turn) for a in robot.AXES] == described
    assert all(a.meaning for a in robot.AXES)


def test_configuration_bytes_are_those_of_the_description(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """Branches first, then every axis that turns more than once: A4, A1, A2 where a quill is carried along."""
    robot = machines[0].robot
    names = [b.name for b in mechanism.branches]
    turning = [j.name for j in mechanism.joints if j.multi_turn]
    if any(j.kind is Kind.HELICAL for j in mechanism.joints):
        assert turning == ["A1", "A2", "A4"]
        turning = ["A4", "A1", "A2"]
    assert [b.name for b in robot.CONFIGURATION] == names + turning
    assert [b.kind for b in robot.CONFIGURATION] == ["branch"] * len(names) + ["period"] * len(turning)
    assert [b.branches for b in robot.CONFIGURATION] == [b.names for b in mechanism.branches] + [()] * len(turning)


def test_parameters_are_those_of_the_description(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """The class lists the parameters of the description, then offsets and limits."""
    expected = [p.name for p in mechanism.parameters]
    expected += [f"offset_{j.key}" for j in mechanism.joints]
    keys = [j.key for j in mechanism.joints] + [q.name for q in mechanism.limited]
    expected += [f"{word}_{key}" for key in keys for word in ("lower", "upper")]
    if mechanism.assembly is not None:
        expected += [f"{mechanism.assembly.name}_{mechanism.assembly.names[1]}", "min_type2_margin"]
    if mechanism.is_platform:
        expected += [*(f"home_{b.name}_{b.names[1]}" for b in mechanism.branches), "min_type2_margin", "check_forward"]
    assert [p.name for p in machines[0].robot.PARAMETERS] == [*expected, "check_limits", "warning_distance"]
    assert all(p.meaning and p.range for p in machines[0].robot.PARAMETERS)


def test_every_public_thing_is_documented(machines: tuple[Machine, ...]) -> None:
    robot_class = type(machines[0].robot)
    public = [n for n in dir(robot_class) if not n.startswith("_")]
    methods = [getattr(robot_class, n) for n in public if callable(getattr(robot_class, n))]
    assert {"forward", "inverse", "inverse_all", "jacobian", "singularity", "forward_batch", "inverse_batch"} <= set(
        public
    )
    assert all(m.__doc__ for m in (robot_class, *methods))
