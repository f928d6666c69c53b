"""The two errors of Structured Text: a text that is refused, and a fault that stops it while it runs."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """Where a construct stands: a name of a text and its line, counted from 1."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


class StError(Exception):
    """The text is refused: it does not parse, or a rule of the dialect is broken."""

    def __init__(self, place: Place | str, message: str) -> None:
        super().__init__(f"{place}: {message}")
        self.place = place
        self.reason = message


class StFault(Exception):
    """A fault that would stop a PLC while the text runs."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        super().__init__(message if place is None else f"{place}: {message}")
        self.reason = message
        self.place = place
