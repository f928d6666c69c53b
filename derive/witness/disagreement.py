"""The error that the witness raises when a derived formula is wrong."""


class Disagreement(Exception):
    """A derived quantity contradicts the closure equations; the message says which, and where."""
