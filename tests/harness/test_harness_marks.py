"""Which statements ran is known: one by one, and only while somebody watches."""

import pytest

from .library import compile_st

TEXT = """FUNCTION Walk : INT
VAR_INPUT
  count : INT;
END_VAR
VAR
  i : INT;
END_VAR
IF count < 0 THEN
  Walk := -1;
  RETURN;
ELSIF count = 0 THEN
  Walk := 0;
ELSE
  FOR i := 1 TO count DO
    Walk := Walk + i;
  END_FOR
  WHILE i > 100 DO
    i := i - 1;
  END_WHILE
END_IF
CASE Walk OF
  1:
    Walk := 10;
  2, 3:
    Walk := 30;
ELSE
  ;
END_CASE
END_FUNCTION
"""
RAN = {
    -1: {8, 9, 10},
    0: {8, 11, 12, 21, 22, 24},
    1: {8, 11, 14, 15, 17, 21, 22, 23},
    2: {8, 11, 14, 15, 17, 21, 22, 24, 25},
}
"""The lines of the statements that run and of the labels that are tried, by what is given."""


@pytest.mark.parametrize("count", RAN)
def test_the_statements_that_ran(count: int) -> None:
    """The watched lines are exactly those of the statements that ran, and watching changes no result."""
    library = compile_st({"Walk.st": TEXT})
    walk = library.function("Walk")
    ran = library.flags()
    before = walk(count)
    with library.watched(ran):
        assert walk(count) == before
    places = [place for place, flag in zip(library.origin.places, ran[1:], strict=True) if flag]
    lines = {place.line for place in places if place is not None and place.file == "Walk.st"}
    assert lines - {1} == RAN[count]
    seen = sum(ran)
    ran[:] = library.flags()
    walk(count)
    assert seen and not any(ran)
