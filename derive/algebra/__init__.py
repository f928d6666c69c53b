"""The normal form modulo sin² + cos² = 1, and sums of angles."""
