"""The configuration of docs/LINUXCNC.md: complete, of pins that exist, and its program within the machine's limits."""

from configparser import ConfigParser

import numpy as np

from derive.emit.linuxcnc import package
from derive.emit.linuxcnc.words import words_of
from prove.linuxcnc import documented
from prove.linuxcnc.poses import frames
from prove.linuxcnc.twin import Twin
from tests.mechanisms import kinematics_of, named


def test_it_is_that_of_the_machine() -> None:
    """Joints, letters and the module are those that the compiler writes; each joint and each letter has its section."""
    texts, kin = documented.files(), kinematics_of(named("Kin_Scara4_ZCcoupled_Type1"))
    words = words_of(kin)
    assert words is not None and list(texts) == ["scara.ini", "scara.hal", "scara.ngc"]
    ini = ConfigParser()
    ini.read_string(texts["scara.ini"])
    assert ini["KINS"]["KINEMATICS"] == package.module_name("scara4_zccoupled_type1")
    assert int(ini["KINS"]["JOINTS"]) == len(kin.mechanism.joints)
    assert ini["TRAJ"]["COORDINATES"] == "".join(words.letters)
    assert {f"AXIS_{letter}" for letter in words.letters} == {name for name in ini.sections() if name[:5] == "AXIS_"}
    for k, joint in enumerate(kin.mechanism.joints):
        assert ini[f"JOINT_{k}"]["TYPE"] == ("LINEAR" if not joint.in_degrees else "ANGULAR")
        assert f"joint.{k}.motor-pos-cmd => joint.{k}.motor-pos-fb" in texts["scara.hal"]
    pins = set(package.pin_names(kin).values())
    assert {name.replace("_", "-") for name in documented.machine(texts).sizes} <= pins


def test_its_program_ends_where_the_joints_can_be() -> None:
    """Its end is reached, in the configuration of the home that it has, and within its limits."""
    texts = documented.files()
    twin = Twin(documented.machine(texts))
    ini = ConfigParser()
    ini.read_string(texts["scara.ini"])
    home = [float(ini[f"JOINT_{k}"]["HOME"]) for k in range(4)]
    there = documented.end(texts)
    pose = np.array([[there["X"], there["Y"], there["Z"], 0.0, 0.0, there["C"]]])
    positions, rotations = frames(twin.machine, pose)
    branches = twin.robot.forward(home)[1][: twin.robot.BRANCHES]
    axes = twin.robot.inverse((positions[0], rotations[0]), (*branches, 0, 0, 0), home)
    for k, value in enumerate(axes):
        assert float(ini[f"JOINT_{k}"]["MIN_LIMIT"]) < value < float(ini[f"JOINT_{k}"]["MAX_LIMIT"])
