"""A plate that moves with its whole pose on legs: its closure, its singularities, its pose by iteration."""
