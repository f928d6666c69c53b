"""The process of a command: what Python does beside it takes as little time as may be.

What a derivation makes lives as long as its process. To look for garbage among it finds nothing and takes a tenth of
the time; at the end Python would look once more.
"""

from __future__ import annotations

import gc


def run() -> int:
    """Run the command that was typed: its status."""
    gc.disable()
    from derive.command.line import main  # loaded here: loading, too, makes what lives as long as the process

    status = main()
    gc.freeze()
    return status
