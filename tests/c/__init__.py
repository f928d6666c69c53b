"""C, compiled with sanitizers and executed: what it answers is what the Python package answers."""
