"""Letters that several processes draw from one font: a fork shares the places at which open files are read."""

from hashlib import sha256
from multiprocessing import get_context

import pytest

from derive.emit.picture import canvas

TEXTS = [f"A{k} link_{k} ±{k * 7}° tool centre {chr(65 + k % 26)}" for k in range(60)]


def drawn(_: int) -> str:
    """The digest of all texts, each drawn anew."""
    canvas._letters.cache_clear()
    found = [canvas._letters(text, 11.0, is_bold) for text in TEXTS for is_bold in (False, True)]
    return sha256(b"".join(letters.covered.tobytes() for letters in found)).hexdigest()


@pytest.mark.long
def test_processes_do_not_disturb_each_other() -> None:
    """Both have the font that this process has opened, and draw at the same time what it draws alone."""
    alone = drawn(0)
    with get_context("fork").Pool(2) as pool:
        assert set(pool.map_async(drawn, range(8), chunksize=1).get(timeout=120)) == {alone}
