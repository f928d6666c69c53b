"""Every mechanism of the catalogue in every test, checked against its closure equations alone."""
