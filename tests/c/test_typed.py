"""The calls with the types of a machine are those with any machine, and what is missing is refused."""

import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
import softkin

from tests.c.programs import SANITIZED, compile_in, files_of, part_of, written
from tests.corpus.recording import read
from tests.mechanisms import named

TYPED = Path(__file__).with_name("typed.c")


@pytest.mark.slow("Kin_Ac6")
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("Kin_Scara4_ZCcoupled_Type1", ()),
        ("Softkin_Planar_3RRR", ("-DSTARTS",)),
        ("Kin_Ac6_RZRYRYRXRYRZ_J6Offset", ("-DSEARCHED",)),
    ],
)
def test_typed_calls(name: str, options: tuple[str, ...]) -> None:
    """They answer the same, also where a frame or a reference is an argument and the place of the result."""
    part = part_of(name)
    module = part["index"]["module"]
    folder = written(files_of(part))
    options = (*options, f"-DMODULE={module}", f'-DHEADER="{module}.h"', f"-DPOSE={_possible(name)}", "-I.")
    compile_in(folder, *SANITIZED, *options, str(TYPED), f"{module}.c", "softkin.c", "-lm")
    done = subprocess.run([folder / "a.out"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def _possible(name: str) -> str:
    """Axis values with which the machine of nominal dimensions can stand."""
    made = softkin.catalogue()[name]
    robot = made(**{p.name: p.nominal for p in named(name).parameters if p.fixed is None})
    asked = [question for part in read(name) for question in part["asked"]]
    for question in (q for q in asked if q["call"] == "forward" and q["kind"] == "regular"):
        with suppress(softkin.KinematicsError):
            frame, configuration = robot.forward(question["axes"])
            if robot.inverse(frame, configuration, question["axes"]):
                return ",".join(map(repr, question["axes"]))
    raise LookupError(name)
