"""A refusal in a sentence: the text is that of the Python package, whatever its amount, its unit and its turn."""

import json

import numpy as np
import pytest
from softkin import Diagnosis, Status

from tests.javascript.modules import module_of
from tests.javascript.node import run

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
