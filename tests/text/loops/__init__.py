"""The Structured Text of the closed loops, executed: every method answers as its Python counterpart does."""
