"""`python -m derive`: what it writes, and what it says about a file that is wrong."""

import pickle
import re
import subprocess
import sys
from pathlib import Path

import pytest

from derive.command.catalogue import OUTPUT
from derive.command.line import main
from derive.description.catalogue import MECHANISMS, catalogue, load
from derive.output import differences
from derive.pipeline import derive_one

SCARA = MECHANISMS / "kin_scara4_zccoupled_type1.py"
ROOT = MECHANISMS.parents[1]

BROKEN: dict[str, tuple[str, str, str]] = {
    "no Python": ("MECHANISM = Mechanism(", "MECHANISM = Mechanism((", "SyntaxError: "),
    "a default outside its range": (
        "low=-200.0, high=200.0",
        "low=5.0, high=200.0",
        r"parameter 'pitch_zc': its default 0 is outside its range \[5 \.\. 200\]",
    ),
    "an empty range": (
        "offset_range=(-720.0, 720.0)",
        "offset_range=(720.0, -720.0)",
        r"joint 'A4': its offset_range \(720\.0, -720\.0\) is empty",
    ),
    "a branch of no joint": (
        "sin(A2), right",
        "sin(L1), right",
        r"branch 'elbow': its indicator sin\(link_length_1\) depends on no joint",
    ),
    "a branch that no root has": ("sin(A2), right", "sin(A1), right", "branch 'elbow': "),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    mechanisms = tmp_path / "mechanisms"
    mechanisms.mkdir()
    (mechanisms / "right.py").write_text(SCARA.read_text().replace("Kin_Scara4_ZCcoupled_Type1", "Kin_Right"))
    return mechanisms


def refusal(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """The one message of a command that must fail."""
    assert main([str(a) for a in arguments]) == 1
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert message.startswith("error: ")
    return message


@pytest.mark.slow("no root has")
@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_file_is_one_clear_message(folder: Path, capsys: pytest.CaptureFixture[str], what: str) -> None:
    old, new, expected = BROKEN[what]
    text = SCARA.read_text()
    assert text.count(old) == 1
    (folder / "broken.py").write_text(text.replace(old, new))
    output = folder.parent / "generated"
    (output / "python").mkdir(parents=True)
    (output / "python" / "kept.py").write_text("kept")
    message = refusal(capsys, "generate", "--mechanisms", folder, "--output", output)
    assert re.search(rf"broken\.py:\d+: {expected}", message), message
    assert [p.name for p in output.rglob("*") if p.is_file()] == ["kept.py"]
    assert {p.name for p in folder.parent.iterdir()} <= {"generated", "generated.cache", "mechanisms"}


@pytest.mark.parametrize(
    ("name", "like"),
    [("Kin_Right", ""), ("kin_right", ""), ("Softkin_Right", ", where"), ("Kin_Ri_ght", ", where"),
     ("Kin_Right_Machine", ", where")],
)  # fmt: skip
def test_two_files_with_one_name(folder: Path, capsys: pytest.CaptureFixture[str], name: str, like: str) -> None:
    """Two descriptions with the same name are refused, and with names that would be one file or one class."""
    text = (folder / "right.py").read_text()
    assert text.count('"Kin_Right"') == 1
    (folder / "twin.py").write_text(text.replace('"Kin_Right"', f'"{name}"'))
    message = refusal(capsys, "generate", "--mechanisms", folder, "--output", folder.parent / "out")
    assert f"twin.py: the name {name!r} is taken by {folder / 'right.py'}{like}" in message


def test_two_classes_with_one_name(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A class that is called like another machine would replace it."""
    text = (folder / "right.py").read_text().replace('"Kin_Right"', '"Kin_Other", class_name="Right"')
    (folder / "twin.py").write_text(text)
    message = refusal(capsys, "generate", "--mechanisms", folder, "--output", folder.parent / "out")
    assert "twin.py: the name 'Kin_Other' is taken by" in message and "where it is 'Kin_Right'" in message


def test_no_traceback_and_exit_status_1(folder: Path) -> None:
    (folder / "broken.py").write_text("from derive.mechanism import nothing\n")
    command = [sys.executable, "-m", "derive", "generate", "--mechanisms", str(folder), "--output", str(folder / "out")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("error: ")
    assert "broken.py:1: ImportError: cannot import name 'nothing'" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_generate_replaces_orphans_and_check_finds_them(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = folder.parent / "generated"
    options = ("--mechanisms", str(folder), "--output", str(output))
    assert main(["generate", *options]) == 0
    assert re.search(r"^Kin_Right +\d+ statements .*2 solutions", capsys.readouterr().out)
    assert main(["check", *options]) == 0
    orphan = output / "st" / "Kin_Orphan.st"
    orphan.write_text("")
    assert "Kin_Orphan.st is generated by no mechanism: run `make generate`" in refusal(capsys, "check", *options)
    assert main(["generate", *options]) == 0
    assert not orphan.exists()
    source = next((output / "st").rglob("*.st"))
    source.write_text(source.read_text() + "\n")
    assert f"{source.name} differs from a fresh generation" in refusal(capsys, "check", *options)
    source.unlink()
    assert f"{source.name} is missing" in refusal(capsys, "check", *options)


def test_a_folder_with_other_files_is_never_replaced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    message = refusal(capsys, "generate", "--mechanisms", folder, "--output", folder.parent)
    assert "holds 'mechanisms', which was not generated: it is not replaced" in message
    assert folder.exists()


def test_only_never_shrinks_the_output_of_the_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`--only` needs an output folder of its own, and a known name."""
    assert "--only needs --output" in refusal(capsys, "generate", "--only", "Kin_PCC")
    assert "no mechanism is called 'Kin_No'" in refusal(
        capsys, "generate", "--only", "Kin_No", "--output", tmp_path / "out"
    )


def test_only_writes_the_chosen_mechanisms(folder: Path, tmp_path: Path) -> None:
    text = (folder / "right.py").read_text()
    (folder / "other.py").write_text(text.replace("Kin_Right", "Kin_Other"))
    output = tmp_path / "out"
    assert main(["generate", "--mechanisms", str(folder), "--output", str(output), "--only", "Kin_Other"]) == 0
    names = " ".join(p.name for p in output.rglob("*"))
    assert "Kin_Other" in names
    assert "Kin_Right" not in names


def test_an_alias_is_a_mechanism_of_its_own(folder: Path) -> None:
    path = folder / "right.py"
    path.write_text(path.read_text().replace("    source=", '    aliases=("Kin_Also_Right",),\n    source='))
    (_, first), (_, second) = catalogue(folder)
    assert (first.name, second.name) == ("Kin_Right", "Kin_Also_Right")
    assert second.aliases == ()
    assert second.title is None
    assert second.joints == first.joints


def test_what_was_derived_travels_between_processes_unchanged() -> None:
    """What one process derives is pickled to another one without change."""
    built = derive_one(load(SCARA))
    assert pickle.loads(pickle.dumps(built)) == built


def test_by_products_are_no_orphans(tmp_path: Path) -> None:
    for name in ("a.py", "softkin.egg-info/PKG-INFO", "__pycache__/a.pyc", "build/lib/a.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    assert list(differences(tmp_path, {"a.py": b""})) == []


def test_the_project_generates_into_its_own_folder() -> None:
    assert OUTPUT == ROOT / "generated"
