"""The table of the proof."""

from __future__ import annotations

from collections.abc import Sequence

from prove.linuxcnc.verdict import Verdict

HEAD = (
    "mechanism", "samples", "joints differ", "poses differ", "speeds differ", "motors off the way", "elbow kept",
    "unreachable refused", "seconds",
)  # fmt: skip


def table(verdicts: Sequence[Verdict]) -> str:
    """The verdicts as a table in Markdown."""
    rows = [HEAD, tuple("---" for _ in HEAD), *(_cells(verdict) for verdict in verdicts)]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def _cells(verdict: Verdict) -> tuple[str, ...]:
    return (
        verdict.says,
        f"{verdict.samples:,}",
        f"{verdict.joints:.1e}",
        f"{verdict.poses:.1e}",
        f"{verdict.speeds:.1e}",
        f"{verdict.off_the_way:.1e}",
        _yes(verdict.elbow_kept),
        _yes(verdict.refused),
        f"{verdict.seconds:.0f}",
    )


def _yes(is_so: bool | None) -> str:
    if is_so is None:
        return "has one"
    return "yes" if is_so else "NO"
