"""The emitted Structured Text, executed: every method of every unit against its Python twin."""
