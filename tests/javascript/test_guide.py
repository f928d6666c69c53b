"""The program in docs/JAVASCRIPT.md does what its comments say."""

import re
from pathlib import Path

import pytest

from tests.javascript.modules import module_of
from tests.javascript.node import run

PAGE = Path(__file__).parents[2] / "docs/JAVASCRIPT.md"


def test_the_program_of_the_guide() -> None:
    """Each line gives what stands behind it."""
    (shown,) = re.findall(r"```js\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    head, _, body = shown.partition("\n\n")
    assert head == 'import { create, description } from "./build/javascript/scara4_zccoupled_type1.js";'
    lines = [re.sub(r"^machine\.(.*?); // .*$", r"found.push(machine.\1);", line) for line in body.splitlines()]
    script = "\n".join(["const { create, description } = module; const found = [];", *lines, "return found;"])
    axes, slots, refused = run(module_of("Kin_Scara4_ZCcoupled_Type1"), script)
    assert axes == pytest.approx([30.0, 40.0, -50.0, 60.0])
    assert [slot["status"] for slot in slots] == [0, 0]
    assert refused["missing"] == pytest.approx(350.0)
    assert refused["status"] == 3 and refused["reason"] == "A2: out of reach"
