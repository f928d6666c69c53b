"""What a drawing of a mechanism shows, as data computed from its description. How it looks is a matter of `emit`."""
