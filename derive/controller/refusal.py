"""The errors that end a live connection: for good, or until it is tried again."""

from __future__ import annotations


class Refused(Exception):
    """A request that cannot be right, or is not allowed; one sentence says why, and it is not tried again."""


class Lost(Exception):
    """The controller does not answer: the connection is tried again."""
