"""The emitted Structured Text of the serial machines, executed: every method of every unit against its Python twin.

Closed loops are executed in `tests/text/loops`.
"""
