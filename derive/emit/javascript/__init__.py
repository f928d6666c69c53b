"""JavaScript: an ES module a mechanism, on the runtime in `templates/javascript`."""
