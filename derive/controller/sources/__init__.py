"""Where axis values come from. Each source reads, and writes nothing to a controller."""
