"""Closed loops: assembly modes, two types of singularities, bounds, machines that cannot be assembled."""
