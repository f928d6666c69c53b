"""`python -m derive`: the same as `softkin`."""

from __future__ import annotations

import sys

from derive.command.process import run

if __name__ == "__main__":
    sys.exit(run())
