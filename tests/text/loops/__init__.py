"""The emitted Structured Text of the closed loops, executed: every method against its Python twin."""
