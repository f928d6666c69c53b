"""Every branch of the inverse of each mechanism in one straight line, loaded with its class."""
