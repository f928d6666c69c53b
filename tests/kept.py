"""What a run of the tests derived, in `build/machines`: the next run of the same compiler reads it, as a sweep does."""

import pickle
from base64 import b64decode, b64encode
from collections.abc import Callable
from functools import cache
from io import BytesIO
from typing import Any, TypeVar

import sympy as sp

from derive.cache import ROOT, Cache, canonical, foundation, key_of
from derive.description.mechanism import Mechanism

Found = TypeVar("Found")
KEPT = Cache(ROOT / "build" / "machines")


def kept(what: str, mechanism: Mechanism, derive: Callable[[Mechanism], Found]) -> Found:
    """What is derived of a mechanism, under the name of what it is; both runs get equal values."""
    key = key_of(what, _foundation(), canonical(mechanism))
    known = KEPT.read(key)
    if known is None:
        found = derive(mechanism)
        stream = BytesIO()
        _Pickler(stream).dump(found)
        assert pickle.loads(stream.getvalue()) == found
        KEPT.write(key, b64encode(stream.getvalue()).decode())
        KEPT.tidy()
        return found
    read: Found = pickle.loads(b64decode(known))
    return read


class _Pickler(pickle.Pickler):
    """SymPy evaluates what pickle restores, (a + b)/2 to a/2 + b/2; here an expression is restored as it stands."""

    def reducer_override(self, value: object) -> Any:
        if isinstance(value, sp.Add | sp.Mul | sp.Pow):
            return _restored, (value.func, value.args)
        return NotImplemented


def _restored(kind: Any, parts: tuple[sp.Basic, ...]) -> sp.Basic:
    return kind._from_args(parts) if issubclass(kind, sp.Add | sp.Mul) else kind(*parts, evaluate=False)


@cache
def _foundation() -> str:
    return foundation(None)
