"""The words of branches behind a name, by which names of one branch are used again by the next."""

from derive.ir.symbols import Sign, real, without_words

SIGNS = (Sign(real("sigma_arm"), ("front", "back")), Sign(real("sigma_elbow"), ("down", "up")))


def test_words_behind_a_name() -> None:
    """A name is split into the neutral name and the words of its branches."""
    assert without_words("axis_a1_front_up", SIGNS) == ("axis_a1", ("front", "up"))
    assert without_words("cos_q1_back", SIGNS) == ("cos_q1", ("back",))
    assert without_words("up", SIGNS) == ("up", ())
