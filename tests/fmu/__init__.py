"""FMUs, validated and run by FMPy: whether they answer as Python is asked in `tests/languages`."""
