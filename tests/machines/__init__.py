"""Machines that are in no catalogue: derived in the tests, and executed in Python and in Structured Text."""
