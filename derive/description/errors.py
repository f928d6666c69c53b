"""The error of a description that cannot be right."""

from __future__ import annotations


class DescriptionError(Exception):
    """A mechanism description that cannot be right; the message says what and where."""
