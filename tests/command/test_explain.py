"""`softkin explain` and `softkin like`: the steps of a derivation, and vendors' names with their parameters."""

import re

import pytest

from derive.command.explain import explanation
from derive.command.like import known, table
from derive.description.catalogue import MECHANISMS, load
from derive.five_axes import ORDERS
from tests.command.files import RAIL, ROOT, SCARA, Folder
from tests.command.wrong import changed
from tests.mechanisms import catalogue
from tests.unit.kinematics.test_search_choice import SIDEWAYS, arm


def explained(file: str) -> str:
    return "\n".join(explanation(load(MECHANISMS / file)))


def test_the_steps_of_a_scara(folder: Folder) -> None:
    """Unknown <- rule <- equations; determinant, branch, and where an angle is free."""
    folder.write("my_scara.py", SCARA)
    said = folder.run("explain", "my_scara.py")
    assert (said.status, said.err) == (0, "")
    for line in (
        "  equation z: a3 + height - z = 0",
        "A3 <- affine <- z",
        "A2 <- trigonometric <- x² + y²",
        "determinant: 2*link_length_1*link_length_2*sin_a2, over 2*link_length_1*link_length_2; where it is 0",
        "branch elbow: 1 right, 2 left; the sign of the determinant is 1",
        "A1 <- pair <- x and y",
        "A1 is free where reach = 0: there it is that of the reference",
        "A4 <- pair <- cos heading and sin heading",
        '  branch("elbow", sin(A2), right=+1, left=-1)',
        "the product of the chain",
    ):
        assert line in said.out, said.out
    assert "to be named" not in said.out


def test_branches_that_nobody_named_stand_there_to_be_named(folder: Folder) -> None:
    """The line that is printed can be put into the description, and then names the same branch."""
    named = '    branches=(branch("elbow", sin(A2), right=+1, left=-1),),\n'
    assert SCARA.count(named) == 1
    folder.write("my_scara.py", SCARA.replace(named, ""))
    said = folder.run("explain", "my_scara.py")
    (line,) = re.findall(r'^  (branch\("elbow_1".*\))$', said.out, re.MULTILINE)
    assert line == 'branch("elbow_1", sin(A2), positive=+1, negative=-1)'
    assert (
        "derived, to be named: 1 positive where A2 is between 0 and 180 degrees, 2 negative where A2 is between -180"
    ) in said.out
    folder.write("my_scara.py", SCARA.replace(named, f"    branches=({line},),\n"))
    said = folder.run("explain", "my_scara.py")
    assert line in said.out and "to be named" not in said.out


POLAR = """
from derive.frames import Rz, Tx
from derive.mechanism import Mechanism, Task, branch, distance, linear, rotary

OFFSET = distance("offset_of_slide", "Axis A1 to the slide at zero", nominal=400.0)
TURN_OF_ARM = rotary("A1", "Arm about Z")
SLIDE = linear("R", "Slide", nominal=100.0)
MECHANISM = Mechanism(
    name="MyPolar",
    parameters=(OFFSET,),
    joints=(TURN_OF_ARM, SLIDE),
    chain=Rz(TURN_OF_ARM) * Tx(OFFSET + SLIDE),
    task=Task("xy"),
)
"""


def test_the_line_to_be_named_is_in_the_variables_of_the_file(folder: Folder) -> None:
    """Where they differ from the names of lengths and axes; so the line can be put into the file as it stands."""
    folder.write("my_polar.py", POLAR)
    said = folder.run("explain", "my_polar.py")
    (line,) = re.findall(r'^  (branch\(".*\))$', said.out, re.MULTILINE)
    assert line.endswith(", OFFSET + SLIDE, positive=+1, negative=-1)")
    assert "positive=(its expression,)" in said.out
    folder.write("my_polar.py", POLAR.replace('Task("xy"),', f'Task("xy"),\n    branches=({line},),'))
    said = folder.run("explain", "my_polar.py")
    assert said.status == 0 and line in said.out and "to be named" not in said.out
    folder.write("my_polar.py", POLAR.replace('Task("xy"),', 'Task("xy"),\n    positive=(OFFSET + SLIDE,),'))
    assert "every pose has one solution" in folder.run("explain", "my_polar.py").out


def test_a_parameter_has_the_name_of_the_file_in_equations(folder: Folder) -> None:
    """Inside the derivation it has another one: a name that the languages of controllers do not take."""
    folder.write("my_polar.py", POLAR.replace("offset_of_slide", "OffsetOfSlide"))
    said = folder.run("explain", "my_polar.py").out
    assert "equation x: cos_a1*OffsetOfSlide + cos_a1*r - x = 0" in said and "given" not in said


@pytest.mark.parametrize(
    ("file", "lines"),
    [
        (
            "kin_articulatedrobot_6dof.py",
            [
                r"A1 <- lateral <- y_from_q1",
                r"A3 <- trigonometric <- x_from_q1² \+ z_from_q1²",
                r"A4 <- polar <- r21 and r31",
                r"A4 is free where radius_q4 = 0",
                r"branch hand: 1 \w+, 2 \w+; the (opposite )?sign of the determinant is 1",
                r"A6 <- pair <- r22 and r23",
            ],
        ),
        (
            "kin_bipod_rotary.py",
            [
                r"A1 <- trigonometric <- rod 1",
                r"branch knee_2: 1 outward, 2 inward",
                r"x, y <- spheres <- ",
                r"assembly tcp: tcp_above chooses the second mode",
            ],
        ),
        ("softkin_planar_3rrr.py", [r"A3 <- trigonometric <- rod 3", r"Newton's method from the home pose"]),
        ("kin_ac6_rzryryrxryrz_j6offset.py", [r"^Where \w+ is not 0, A6 is searched for roots"]),
        ("kin_gantry2.py", [r"A1 <- affine <- x|X <- affine <- x", r"Branches: none, every pose has one solution"]),
    ],
)
def test_every_kind_of_machine_is_explained(file: str, lines: list[str]) -> None:
    text = explained(file)
    for line in lines:
        assert re.search(line, text, re.MULTILINE), (line, text)


def test_a_searched_arm_without_named_branches_is_explained_to_its_end() -> None:
    """What is left of a trial, the branches that the derivation names, and the meaning of the crossing."""
    text = "\n".join(explanation(arm(SIDEWAYS)))
    assert re.search(r"^  residual, which vanishes at a root: ", text, re.MULTILINE)
    assert re.search(r'^  branch\("elbow_1", cos\(A3\), positive=\+1, negative=-1\)', text, re.MULTILINE)
    assert "whether the residual rises (1 rising) or falls (2 falling) with A6 at the root" in text
    assert text.endswith("Forward kinematics\n  the product of the chain") and ", nan," not in text


def test_no_step_is_without_its_equations() -> None:
    """Every step of these machines is found again from the equations that are named."""
    for file in (
        "kin_articulatedrobot_6dof.py",
        "kin_ac6_threeparallel.py",
        "kin_polar.py",
        "softkin_tabletable_ac.py",
    ):
        steps = re.findall(r"^  \d+\. (.*)$", explained(file), re.MULTILINE)
        assert steps
        assert not [s for s in steps if s.endswith("the equations above")], steps


def test_a_machine_that_cannot_be_derived_is_one_message(folder: Folder) -> None:
    folder.write("rail.py", RAIL)
    folder.write("wrong.py", RAIL.replace("Ty(A2)", "Tx(A2)"))
    said = folder.run("explain", "wrong.py", "rail.py")
    assert said.status == 2 and said.err.count("\n") == 1
    assert said.err.startswith("error: wrong.py:9: the closure does not determine a1, a2")
    assert "A2 <- affine <- y" in said.out


def test_the_steps_before_a_refusal_are_shown(folder: Folder) -> None:
    """Where no rule fits what is left, the author sees how far it went."""
    cubic = changed(
        RAIL, ("chain=Tx(A1) * Ty(A2)", "closure=(X - A1, Y - A2 - A2**3)"), ("Task, linear", "Task, X, Y, linear")
    )
    folder.write("cubic.py", cubic)
    said = folder.run("explain", "cubic.py")
    assert said.status == 2 and "no subproblem determines a2: 1 unknown in 1 equation" in said.err
    assert "Inverse kinematics, as far as it goes\n  1. A1 <- affine <- x\n" in said.out, said.out


TABLE = {m.name: m for _, m in catalogue()}


def test_it_finds_by_vendor_and_name(folder: Folder) -> None:
    said = folder.run("like", "linuxcnc", "XYZAC-trt")
    assert said.status == 0 and said.out.startswith("LinuxCNC xyzac-trt-kins: Softkin_TableTable_AC\n")
    assert "y-offset = -pivot_y" in said.out and "published in: 5-Axis Kinematics, and the source" in said.out
    assert folder.run("like", "klipper").out.count("Klipper") == sum(k.vendor == "Klipper" for k in known())
    said = folder.run("like", "perpetuum", "mobile")
    assert (
        said.status == 2 and "no kinematics with 'perpetuum mobile' is known: name one of CODESYS, Beckhoff" in said.err
    )


@pytest.mark.parametrize("name", [name for k in known() for name in k.names])
def test_every_block_and_parameter_is_there(name: str) -> None:
    """What stands behind an equals sign is a parameter of the block, or of one of its numbered kind."""
    for entry in (k for k in known() if name in k.names):
        blocks = re.findall(r"(?:Kin|Softkin)_\w*[a-z0-9A-Z]", entry.block)
        orders = re.findall(r"(?<!Softkin_)\b\w+Table_[ABC]{2}", entry.block)
        assert set(blocks) <= set(TABLE) and {o for o in orders if not o.startswith("Softkin")} <= set(ORDERS)
        named = {p.name for block in blocks for p in TABLE[block].parameters}
        named |= {f"offset_{j.key}" for block in blocks for j in TABLE[block].joints}
        words = {
            w for w in re.findall(r"\b[a-z]+(?:_[a-z0-9]+)+\b", entry.meaning) if not w.startswith(("stepper", "delta"))
        }
        assert all(w in named or w.replace("_i", "_1") in named for w in words), words - named


def test_the_documentation_has_the_table() -> None:
    assert table() in (ROOT / "docs/MECHANISMS.md").read_text(encoding="utf-8")
