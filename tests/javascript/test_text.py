"""What is written: its width, its imports, what it says of a machine; the program of docs/JAVASCRIPT.md."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin
from softkin import Diagnosis, Status

from derive.command.line import main
from derive.emit.javascript import package
from tests.corpus.dimensions import DIMENSIONS
from tests.javascript.modules import files_of, module_of, part_of
from tests.javascript.node import ask, run


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_lines_and_imports(name: str) -> None:
    """No line is wider than a page; what is imported is there, is used, and is a file beside the module."""
    files = files_of(part_of(name))
    runtime = name == "Kin_CAxis"  # the same for all
    for path, text in files.items() if runtime else part_of(name)["files"].items():
        wide = [line for line in text.splitlines() if len(line) > 120]
        assert not wide, (path, wide[0])
        assert "\t" not in text and text.endswith("\n") and " \n" not in text
        for names, source in re.findall(r"^import \{([^}]*)\} from \"(.*)\";$", text, re.MULTILINE):
            assert source.startswith("./") and f"{Path(path).parent / source}" in files
            rest = text.replace(names, "", 1)
            unused = [word for word in re.findall(r"\w+", names) if not re.search(rf"\b{word}\b", rest)]
            assert not unused, (path, unused)
        newer = (
            r"\?\?=|\|\|=|&&=|this\.#|static \{|\.at\(|replaceAll|Object\.hasOwn\b|structuredClone|\.findLast|toSorted"
        )
        assert not re.search(newer, text), path  # than ES2020
        assert not re.search(r"Math\.random|Date|require\(|eval\(|import\(\"[^.]|fetch", text), path


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_the_description_is_that_of_the_class(name: str) -> None:
    """Axes, parameters, bytes, rows, margins, limits: what the class of the package says."""
    told = ask(module_of(name), [])["description"]
    made = softkin.catalogue()[name]
    assert [(a["name"], a["kind"], a["unit"], a["meaning"], a["multiTurn"]) for a in told["axes"]] == [
        (a.name, a.kind, a.unit, a.meaning, a.multi_turn) for a in made.AXES
    ]
    assert [_parameter(p) for p in told["parameters"]] == [
        (p.name, p.kind, p.unit, p.meaning, p.low, p.high, p.low_is_open, p.default) for p in made.PARAMETERS
    ]
    assert [(b["name"], b["kind"], tuple(b["branches"]), b["default"]) for b in told["configuration"]] == [
        (b.name, b.kind, b.branches, b.default) for b in made.CONFIGURATION
    ]
    assert [told[key] for key in ("jacobianRows", "defaultConfiguration", "periodAxes", "distanceAxes")] == [
        list(v) for v in (made.JACOBIAN_ROWS, made.DEFAULT_CONFIGURATION, made.PERIOD_AXES, made.DISTANCE_AXES)
    ]
    assert [m["name"] for m in told["margins"]] == list(made.MARGINS)
    assert {m["kind"] for m in told["margins"]} <= {"type 1", "type 2"}
    assert [told[key] for key in ("freedom", "readsRotation", "role", "branchCount", "module")] == [
        made.FREEDOM, made.READS_ROTATION, made.ROLE, made.BRANCHES, made.__module__.rpartition(".")[2]
    ]  # fmt: skip
    assert [one["key"] for one in told["limits"]] == list(made.LIMIT_KEYS)
    nominal = {p["name"]: p["nominal"] for p in told["parameters"]}
    calls = [["forward", told["drawn"]]]
    answer = ask(module_of(name), [{"parameters": nominal, "calls": calls}])["answers"][0]
    assert answer["made"] == {"status": 0} and answer["found"][0]["status"] == 0


def _parameter(p: dict[str, Any]) -> tuple[Any, ...]:
    keys = ("name", "kind", "unit", "meaning", "low", "high", "lowIsOpen", "default")
    return tuple(p[key] for key in keys)


def test_a_machine_may_be_called_as_a_file() -> None:
    """The files of the runtime have a folder of their own, and no machine takes the place of the list."""
    assert package.module_name("Kin_Index") == "index_machine"
    assert package.module_name("Kin_Numbers") == "numbers"
    assert "softkin/numbers.js" in files_of(part_of("Kin_CAxis"))


def test_the_catalogue_needs_another_folder(capsys: pytest.CaptureFixture[str]) -> None:
    """The output folder of the project holds every language that is committed, and nothing else."""
    assert main(["generate", "--language", "javascript"]) == 1
    assert "--language needs --output" in capsys.readouterr().err


HALVES = [1000.5, 1001.5, 100.25, 100.35, 2.0005, 12345.0, 12355.0, 0.5 + 2.0**-40, 214.05, 9999.5, 99995.0]
EDGES = [214.0, 5.0, 0.1, 1e-4, 9.9999e-5, 1e-5, 2.5e-7, 1e-7, 1e15, 9.9999e15, 1e16, 1.25e22, 5e-324, 1.7e308]


def amounts() -> list[float]:
    """Halves of the last digit that is written, where the spelling changes, and random ones of all sizes."""
    random = np.random.default_rng(11)
    found = 10.0 ** random.uniform(-9.0, 18.0, 400)
    halves = random.integers(1000, 9999, 200) * 10 + 5  # exactly between two numbers of four digits
    return [*HALVES, *EDGES, *found.tolist(), *halves.astype(float).tolist(), *(halves / 16.0).tolist()]


@pytest.mark.parametrize(("unit", "turn"), [("u", 0), ("deg", -2), ("", 0)])
def test_amounts_are_spelled_as_in_python(unit: str, turn: int) -> None:
    """The four digits, the decimal point of a whole number, the exponent of a small one; a half goes to even."""
    asked = [0.0, *(sense * one for one in amounts() for sense in (1.0, -1.0))]
    reason = "A2: out of reach"
    expected = [
        Diagnosis(Status.UNREACHABLE, f"{reason} [{unit}]" if unit else reason, missing, turn).in_words
        for missing in asked
    ]
    told = json.dumps({"asked": asked, "unit": unit, "turn": turn, "reason": reason})
    script = f"""
      const {{ asked, unit, turn, reason }} = {told};
      return asked.map((missing) => module.inWords({{ reason, unit, missing, turn }}));
    """
    found = run(module_of("Kin_CAxis").parent / "softkin" / "softkin.js", script)
    assert found == expected


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
