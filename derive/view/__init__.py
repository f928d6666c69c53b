"""The viewer: one HTML page with machines in it, made of the modules in JavaScript and of `templates/view`."""
