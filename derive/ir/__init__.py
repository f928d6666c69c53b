"""A program as data: symbols, numerical constants, primitives, statements; how it is checked, interpreted and
assembled."""
