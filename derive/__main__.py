"""`python -m derive`: the same as `softkin`."""

from __future__ import annotations

import sys

from derive.command.catalogue import OUTPUT
from derive.command.line import main

__all__ = ["OUTPUT", "main"]

if __name__ == "__main__":
    sys.exit(main())
