"""A text on others that are translated already is what it is with all of them at once."""

import pytest

from tests.harness.layers import Texts, _at_once, layer_of
from tests.harness.library import StError, compile_st

FIRST = """
FUNCTION First : INT
VAR_INPUT n : INT; END_VAR
First := n + 1;
END_FUNCTION
"""
LAST = """
FUNCTION Last : INT
VAR_INPUT n : INT; END_VAR
Last := First(n := n) * 2;
END_FUNCTION
"""
KIND = "TYPE Kind : (Rotary, Skew); END_TYPE"
KINDS = """
FUNCTION IsRotary : BOOL
VAR_INPUT given : Axis_Type; END_VAR
IsRotary := given = Rotary;
END_FUNCTION
"""


@pytest.mark.parametrize("texts", [(("first", FIRST), ("last", LAST)), (("last", LAST), ("first", FIRST))])
def test_whichever_comes_last_the_translation_is_that_of_all_at_once(texts: Texts) -> None:
    assert layer_of(texts, 72, 31).whole() == _at_once(texts, 72, 31).whole()
    assert compile_st(dict(texts)).function("Last")(n=3) == 8


@pytest.mark.parametrize("last", [FIRST.replace("First", "FIRST"), "VAR_GLOBAL first : INT; END_VAR"])
def test_a_name_that_the_others_have_is_refused(last: str) -> None:
    with pytest.raises(StError, match="duplicate name"):
        compile_st({"first": FIRST, "last": last})


def test_a_name_that_hides_another_is_seen_by_all() -> None:
    """The member of a list in the last text is what the first text means by that name."""
    texts = (("kinds", KINDS), ("kind", KIND))
    with pytest.raises(StError) as at_once:
        _at_once(texts, 72, 31)
    with pytest.raises(StError) as found:
        layer_of(texts, 72, 31)
    assert str(found.value) == str(at_once.value)
