"""Function blocks for SoftMotion: their interfaces, methods, settings, self-tests and their overview."""
