"""An arm as lines in space, snapped, and brought into the simple form of a chain."""
