"""The process of a command.

What a command loads and derives lives as long as its process, so that Python looks for garbage in vain: while it loads,
while it derives, and at the end.
"""

from __future__ import annotations

import gc


def run() -> int:
    """Run the command that was typed, and return its status."""
    gc.disable()
    from derive.command.line import main  # loaded here, when nothing looks for garbage any more

    status = main()
    gc.freeze()
    return status
