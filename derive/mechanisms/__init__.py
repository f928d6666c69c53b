"""The catalogue: one file a mechanism, which states equations and their meaning, and nothing that was derived."""
