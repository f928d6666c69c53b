"""The error of a description that cannot be right, and text of files as a terminal may print it."""

from __future__ import annotations


class DescriptionError(Exception):
    """A mechanism description that cannot be right; the message says what and where."""


def printable(text: str) -> str:
    """A text with a space for every character that is not printed, but line breaks."""
    return "".join(letter if letter.isprintable() or letter == "\n" else " " for letter in text)
