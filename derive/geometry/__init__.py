"""Chains of turns and shifts, the pose that they make, vectors.

It may import `ir`.

frames: chains of elementary frames, and chains from tables of Denavit-Hartenberg parameters
pose: the pose of a chain, with parallel rotations merged, and its screws
vectors: vectors of expressions, for closed loops
"""
