"""The drawing of a mechanism, as data computed from its description. `emit/picture` decides how it looks."""
