"""The messages that the page gets, each an object of JSON: first the machine, then its axes, up to 50 times a second.

    {"type": "machine", "protocol": 1, "machine": {"mechanism": "Kin_Gantry2"},
     "name": "Kin_Gantry2", "axes": [{"name": "X", "unit": "u", "node": "ns=2;s=X", "scale": 1.0}, ...],
     "source": {"kind": "OPC UA", "address": "opc.tcp://..."}, "rate": 50.0, "stale_after": 1.0}

    {"type": "axes", "machine": "Kin_Gantry2", "number": 7, "time": 1795392000.25, "recorded": null,
     "status": "live", "message": "", "retry_in": null, "complete": false,
     "axes": [12.5, null], "quality": ["good", "bad"], "reasons": ["", "not finite: nan"], "ages": [0.003, 0.003]}

A bad or a missing value is null, and `complete` is then false: the page moves its machine only where `complete` is
true, so that no picture mixes a new value with an old one. A stale value is the last good one. docs/LIVE.md describes
the messages for authors of pages.
"""

from __future__ import annotations

import json

from derive.controller.feed import Feed
from derive.controller.reading import Quality, Reading
from derive.controller.settings import Settings

PROTOCOL = 1


def about_the_machine(settings: Settings) -> str:
    """The first message."""
    units = {axis.name: axis.unit for axis in settings.machine.axes}
    axes = [{"name": c.axis, "unit": units[c.axis], "node": c.node, "scale": c.scale} for c in settings.channels]
    source = {"kind": settings.address.kind.value, "address": settings.address.text}
    return _written(
        {
            "type": "machine",
            "protocol": PROTOCOL,
            "machine": dict(settings.machine.given),
            "name": settings.machine.name,
            "axes": axes,
            "source": source,
            "rate": settings.rate,
            "stale_after": settings.stale_after,
        }
    )


def about_the_axes(feed: Feed, machine: str, stale_after: float, number: int, now: float) -> str:
    """The message about the present state. number: that of the message; now: seconds since 1970."""
    at = feed.clock()
    readings = [feed.readings.get(channel.axis) for channel in feed.channels]
    qualities = [quality_of(reading, at, stale_after) for reading in readings]
    condition = feed.condition
    return _written(
        {
            "type": "axes",
            "machine": machine,
            "number": number,
            "time": round(now, 4),
            "recorded": feed.recorded,
            "status": condition.status.value,
            "message": condition.message,
            "retry_in": None if condition.retry_at is None else round(max(condition.retry_at - at, 0.0), 1),
            "complete": all(quality in (Quality.GOOD, Quality.STALE) for quality in qualities),
            "axes": [reading.value if reading else None for reading in readings],
            "quality": [quality.value for quality in qualities],
            "reasons": [reading.reason if reading else "no answer yet" for reading in readings],
            "ages": [round(at - reading.at, 3) if reading else None for reading in readings],
        }
    )


def quality_of(reading: Reading | None, at: float, stale_after: float) -> Quality:
    """The quality of a reading at a time."""
    if reading is None:
        return Quality.MISSING
    if reading.value is None:
        return Quality.BAD
    return Quality.STALE if at - reading.at > stale_after else Quality.GOOD


def _written(message: dict[str, object]) -> str:
    """A message as JSON, which has no NaN."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"))
