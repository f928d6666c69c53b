"""An extension of Klipper for the proof, which runs in batch mode.

There Klipper ends as soon as the program does, whatever its thread that writes has still to write: it waits at the end.
And it makes no steps before it has read 4 kB, or before a command like G28 needs all of them; then all at once, which
it cannot where they last longer than 16 s (see docs/KLIPPER.md): the command SOFTKIN_STEPS_MADE makes those until here.
And an error ends it: SOFTKIN_REFUSED goes so far from here, and is one if that is not refused.
"""

from __future__ import annotations

import time
from typing import Any

SECONDS = 1.5
UNTIL = "All steps are made until {}"


def load_config(config: Any) -> None:
    """What Klipper calls for the section."""
    printer = config.get_printer()
    reactor = printer.get_reactor()
    end: list[float] = []

    def is_written() -> bool:
        end[:] = end or [time.monotonic() + SECONDS]
        return time.monotonic() > end[0]

    def make_steps(command: Any) -> None:
        toolhead = printer.lookup_object("toolhead")
        toolhead.wait_moves()
        reactor.pause(reactor.monotonic())
        command.respond_info(UNTIL.format(toolhead.get_last_move_time()))

    def is_refused(command: Any) -> None:
        toolhead = printer.lookup_object("toolhead")
        to = [at + command.get_float(word, 0.0) for word, at in zip("XYZE", toolhead.get_position(), strict=True)]
        try:
            toolhead.move(to, 10.0)
        except printer.command_error:
            return
        raise command.error(f"{command.get_commandline()} is not refused")

    printer.register_event_handler("gcode:debuginput_exit", is_written)
    for name, does in (("SOFTKIN_STEPS_MADE", make_steps), ("SOFTKIN_REFUSED", is_refused)):
        printer.lookup_object("gcode").register_command(name, does)
