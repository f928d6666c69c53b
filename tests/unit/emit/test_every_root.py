"""All roots of a search: the next one ahead, and with it the other solution that stands there, too."""

from math import pi

from softkin._root import Values, every_root

ROOTS = ((-1.0, (-1.0, 5.0), (-1.0, 6.0)), (0.5, (0.5, 7.0), None))


def find(given: Values) -> Values:
    """The next root ahead of the first argument: whether there is one, how far it is, the joints, those of its twin."""
    start, is_onward = given
    assert is_onward
    away, (_, joints, twin) = min(((one[0] - start - 1e-6) % (2.0 * pi) + 1e-6, one) for one in ROOTS)
    return True, away, *joints, twin is not None, *(twin or (0.0, 0.0))


def test_a_twin_follows_its_root() -> None:
    assert every_root(find, (0.0, False), 0, 1, 2) == [(0.5, 7.0), (-1.0, 5.0), (-1.0, 6.0)]


def test_a_search_without_twins() -> None:
    assert every_root(lambda given: find(given)[:4], (0.0, False), 0, 1, 2) == [(0.5, 7.0), (-1.0, 5.0)]
