"""The viewer, driven in a real browser; what it shows is held against Python."""
