"""Structured Text: expressions, statements, refusals, names, and the contract of SoftMotion as data."""
