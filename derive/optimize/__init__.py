"""Programs rewritten for speed and size, for every language."""
