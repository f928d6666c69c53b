"""Closed loops: every mechanism with rods, in Python and in Structured Text, against its closure equations."""
