"""The process of a command.

The objects that a command loads and derives live as long as its process, so that garbage collection finds nothing: not
while it loads, not while it derives, and not at the end.
"""

from __future__ import annotations

import gc


def run() -> int:
    """Run the command that was typed, and return its status."""
    gc.disable()
    from derive.command.line import main  # loaded here, after garbage collection is off

    status = main()
    gc.freeze()
    return status
