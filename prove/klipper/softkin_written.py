"""An extension of Klipper for the proof: at the end of a program it waits until the steps are in the file.

In batch mode Klipper ends as soon as the program does, whatever its thread that writes has still to write.
"""

from __future__ import annotations

import time
from typing import Any

SECONDS = 1.5


def load_config(config: Any) -> None:
    """What Klipper calls for the section."""
    end: list[float] = []

    def is_written() -> bool:
        end[:] = end or [time.monotonic() + SECONDS]
        return time.monotonic() > end[0]

    config.get_printer().register_event_handler("gcode:debuginput_exit", is_written)
