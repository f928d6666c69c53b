"""Readers of robot files: URDF, MJCF, tables of Denavit-Hartenberg parameters."""
