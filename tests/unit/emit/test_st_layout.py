"""Lines of Structured Text that carry a sentence: they fit, and nothing of the sentence is lost."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.emit.st.layout import INSIDE, WIDTH, beside, case

SENTENCES = st.lists(st.text("abcdefgh", min_size=1, max_size=12), max_size=30).map(" ".join)


@given(st.integers(1, 60), SENTENCES)
def test_a_comment_beside_a_declaration_is_whole_and_fits(length: int, comment: str) -> None:
    declaration = "d" * length
    lines = beside(declaration, comment)
    assert lines[0].startswith(declaration)
    assert " ".join(line.partition("// ")[2] for line in lines) == comment
    assert max(map(len, lines)) <= WIDTH - INSIDE
    assert all((len(line) - len(line.lstrip())) % 2 == 0 for line in lines)


def test_a_long_declaration_still_has_its_comment() -> None:
    lines = beside("d" * 200, "a length that no machine can be without")
    assert " ".join(line.partition("// ")[2] for line in lines) == "a length that no machine can be without"


@pytest.mark.parametrize(("length", "lines"), [(10, 1), (90, 2), (98, 3)])
def test_a_text_of_a_case_stands_where_there_is_room(length: int, lines: int) -> None:
    found = case(12, "Diagnose", "x" * length)
    assert len(found) == lines
    assert "".join(line.strip() for line in found).replace(" ", "") == f"12:Diagnose:='{'x' * length}';"
    assert max(map(len, found)) <= WIDTH - INSIDE
