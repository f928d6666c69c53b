"""The errors that the witness raises."""


class Disagreement(Exception):
    """A derived quantity contradicts the closure equations; the message says which, and where."""


class NoPose(Disagreement):
    """There is nothing to measure: no pose that was tried closes the mechanism."""
