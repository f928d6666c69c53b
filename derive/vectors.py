"""Vectors for closures that are not a chain, for mechanism files to import."""

from derive.geometry.vectors import Vector, cross, dot, minus, triple, vector

__all__ = ["Vector", "cross", "dot", "minus", "triple", "vector"]
