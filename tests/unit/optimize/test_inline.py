"""Read once: what is read once, and is short, is written where it is read; words of branches behind a name."""

import sympy as sp

from derive.emit.python.printer import ScalarPrinter
from derive.ir.program import Let
from derive.ir.symbols import Sign, real, without_words
from derive.optimize.inline import inlined

A, B, C, D, E, F, R, X, Y, Z = (real(n) for n in "abcdefrxyz")
REGULAR = sp.Gt(R, 1)


def test_the_order_of_operations_stays() -> None:
    """SymPy would make a cancelled sum and a product of three of these."""
    body = [Let(A, X - Y), Let(B, A + Y), Let(D, X * Y), Let(E, D * Z), Let(F, E + B)]
    items, _ = inlined(body, [F, F * B, B])
    text = {i.name.name: ScalarPrinter().print(i.value) for i in items if isinstance(i, Let)}
    assert text == {"b": "y + (x - y)", "f": "b + (x*y)*z"}


SIGNS = (Sign(real("sigma_arm"), ("front", "back")), Sign(real("sigma_elbow"), ("down", "up")))


def test_words_behind_a_name() -> None:
    """A name is split into the neutral name and the words of its branches."""
    assert without_words("axis_a1_front_up", SIGNS) == ("axis_a1", ("front", "up"))
    assert without_words("cos_q1_back", SIGNS) == ("cos_q1", ("back",))
    assert without_words("up", SIGNS) == ("up", ())
