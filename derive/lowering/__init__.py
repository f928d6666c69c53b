"""Programs with fewer operations, the same for every language: read into a graph, changed, and written again."""
