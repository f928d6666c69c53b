"""The programs of every mechanism on arrays: the same statements as in its class, for all rows at once."""
