"""Solved subproblems: one rule a file, each knows one shape of equation and no mechanism."""
