"""A mechanism with a root scan: both of its derivations, its trial with slopes, its inverse and its margins."""
