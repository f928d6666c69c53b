"""C99: a header and a source a mechanism, on the one source that all share in `templates/c`."""
