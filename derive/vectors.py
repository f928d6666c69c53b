"""Vectors for closures that are not a chain: what a mechanism file imports."""

from derive.geometry.vectors import (
    Vector,
    cross,
    dot,
    minus,
    triple,
    vector,
)

__all__ = [
    "Vector",
    "cross",
    "dot",
    "minus",
    "triple",
    "vector",
]
