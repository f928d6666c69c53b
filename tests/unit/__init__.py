"""Folders of the compiler, tested piece by piece and on mechanisms that it was not written for."""
