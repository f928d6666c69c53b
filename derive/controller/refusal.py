"""What ends a live connection: for good, or until it is tried again."""

from __future__ import annotations


class Refused(Exception):
    """What is asked for cannot be right, or is not allowed: it is said in one sentence, and not tried again."""


class Lost(Exception):
    """The controller does not answer: the connection is tried again."""
