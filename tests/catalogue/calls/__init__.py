"""Calls that every machine has around its inverse: nearest, radians, names, paths, values."""
