"""The closure equations: what they are, how a mechanism states them, and how what is commanded enters them."""
