"""Every mechanism of the catalogue through every test, held against its closure equations alone."""
