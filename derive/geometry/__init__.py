"""Chains of turns and shifts, the pose that they make, vectors."""
