"""The text of a mechanism is the same whatever Python's hash seed is: no set decides an order."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]
_TEXT = """
from derive.description.catalogue import MECHANISMS, load
from derive.emit.page.page import page_of
from derive.kinematics.build import build
from derive.pipeline import LANGUAGES, languages
mechanism = load(MECHANISMS / "mc_kin_type_12_xy.py")
kin = build(mechanism)
print(page_of(mechanism, kin, has_pictures=False).text)
for language in languages(wanted=LANGUAGES):
    for name, text in sorted(language.files([language.part(kin)]).items()):
        print(name, text)
"""


def _text(seed: str) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", _TEXT], env=environment, cwd=ROOT, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_the_text_does_not_depend_on_the_hash_seed() -> None:
    """Generated text and pages are the same for two hash seeds of Python."""
    first = _text("0")
    assert len(first) > 100_000 and "spanUpperX" in first
    assert _text("90210") == first
