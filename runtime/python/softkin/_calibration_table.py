"""A calibration as a table of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from softkin._calibrate import Calibration

CORRELATED = 0.95
"""Pairs with at least this correlation are told."""
_MOST = 6
"""The most pairs, and the most parts of a combination, that are told."""


def table(found: Calibration) -> str:
    """The table: errors, deviations, what is held and why, outliers."""
    return "\n".join(_lines(found))


def _lines(found: Calibration) -> Iterator[str]:
    counts = f"{len(found.deviations)} deviations found, {len(found.held)} held"
    yield f"{found.machine.NAME}: {found.samples} samples, {counts}"
    yield f"condition {found.condition:.3g}, observability {found.observability:.3g}"
    yield f"{'root mean square':22}{'before':>12}{'after':>12}{'left out':>12}"
    rows = (("position", "position"), ("rotation (deg)", "rotation"), ("distance", "distance"))
    for title, name in rows:
        values = [getattr(errors, name) for errors in (found.before, found.after, found.left_out)]
        if isfinite(values[0]):
            yield f"{title:22}" + "".join(f"{value:12.4g}" for value in values)
    yield f"{'deviation':22}{'value':>12}{'sigma':>12}"
    for name, value in found.deviations.items():
        yield f"{name:22}{value:12.5f}{found.sigma[name]:12.5f}"
    yield from _held(found.held)
    strong = sorted((-abs(r), pair, r) for pair, r in found.correlation.items() if abs(r) >= CORRELATED)
    if strong:
        yield "correlated: " + "; ".join(f"{a} with {b} {r:.2f}" for _, (a, b), r in strong[:_MOST])
    if found.outliers:
        yield f"left out as outliers: rows {', '.join(map(str, found.outliers))} (the first is 0)"


def _held(held: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    """What the samples do not determine, and why."""
    if held:
        yield "held, because the samples do not tell it from what stands behind it"
    for name, shares in held.items():
        parts = sorted(shares.items(), key=lambda part: -abs(part[1]))
        text = " ".join(f"{share:+.3g} {other}" for other, share in parts[:_MOST])
        yield f"{name:22}{(text + (' ...' if len(parts) > _MOST else '')) if parts else 'moves no sample'}"
