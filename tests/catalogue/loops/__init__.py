"""What closed loops alone have: assembly modes, two types of singularities, bounds, machines that cannot be assembled."""
