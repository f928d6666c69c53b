"""JavaScript, executed under Node.js: what it answers is what the Python package answers."""
